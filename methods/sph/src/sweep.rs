//! A rate stage of SPH: for every particle gather its neighbours once, then let every term of
//! the scene run over them.

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::CellBlock;
use finegrain_framework::{
    ColumnId, Domain, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real,
};

use crate::fields::Fields;
use crate::kernel::adaptive::Kernels;
use crate::neighbourhood::{Candidates, Gathered, Neighbours, Particle};
use crate::quantity::{Quantity, Values};
use crate::term::{AnyTerm, Term, Work};
use crate::wall::{Extrapolation, NoSlip};

/// One sweep over all pairs, in `D` dimensions.
#[derive(Clone, Debug)]
pub(crate) struct Sweep<T, const D: usize> {
    name: String,
    kernels: Kernels<T, D>,
    terms: Vec<AnyTerm<T>>,
    gathered: Gathered<T>,
    outputs: Vec<(Quantity, Rate<T>)>,
    /// Acceleration of the fluid by a body force, m/s^2.
    body_acceleration: [T; D],
    /// Only if a term sees velocities in bodies.
    no_slip: Option<NoSlip<T>>,
}

impl<T: Real, const D: usize> Sweep<T, D> {
    /// A sweep of `terms`, with the columns that they need.
    pub fn new(
        kernels: Kernels<T, D>,
        terms: Vec<AnyTerm<T>>,
        fields: &Fields<T>,
        body_acceleration: [T; D],
        no_slip: Option<&NoSlip<T>>,
    ) -> Self {
        let reads = terms.iter().flat_map(|term| term.reads(D)).chain([Quantity::WallDepth]);
        let mut writes: Vec<_> = terms.iter().flat_map(|term| term.writes(D)).collect();
        writes.sort_unstable();
        writes.dedup();
        let outputs = writes.into_iter().filter_map(|q| Some((q, fields.rate(q)?))).collect();
        // Named after what it sums up, for error messages.
        let names: Vec<_> = terms.iter().map(AnyTerm::name).collect();
        let uses_kernel = terms.iter().any(Term::uses_kernel);
        let extrapolates = terms.iter().any(Term::sees_velocity_in_bodies);
        Self {
            name: format!("sph {}", names.join(", ")),
            kernels,
            gathered: Gathered::new(fields, reads.collect(), uses_kernel),
            terms,
            outputs,
            body_acceleration,
            no_slip: no_slip.filter(|_| extrapolates).cloned(),
        }
    }

    /// Rates of all particles of a sub-domain.
    #[inline(always)]
    fn run(
        &self,
        near: &Near<'_, Cells<T>>,
        block: &CellBlock<'_, T>,
        written: &mut Written<'_, T>,
        scratch: &mut Scratch<T, D>,
    ) {
        let Scratch { candidates, neighbours, work } = scratch;
        let first = near.spans()[0].start;
        for cell in block.cells() {
            candidates.collect(&self.gathered, near, block, cell, self.kernels.range());
            let longest = match self.kernels {
                Kernels::Uniform(_) => T::zero(),
                Kernels::Adaptive(_) => {
                    candidates.largest(&self.gathered, Quantity::SmoothingLength)
                }
            };
            for k in 0..cell.span.len() {
                let mut particle = candidates.particle(&self.gathered, k);
                particle.no_slip = self.no_slip(&particle);
                neighbours.gather(&self.gathered, candidates, &particle, &self.kernels, longest);
                let sums = self.sum(&particle, neighbours, work);
                for (column, &(quantity, _)) in written.iter_mut().zip(&self.outputs) {
                    column[cell.span.start - first + k] = sums[quantity];
                }
            }
        }
    }

    #[inline(always)]
    fn no_slip(&self, i: &Particle<T, D>) -> Extrapolation<T> {
        match &self.no_slip {
            Some(no_slip) if !i.is_wall() => no_slip.at(i.position),
            _ => Extrapolation::none(),
        }
    }

    /// All terms for one particle.
    #[inline(always)]
    fn sum(&self, i: &Particle<T, D>, near: &Neighbours<T, D>, work: &mut Work<T>) -> Values<T> {
        let mut sums = Values::zero();
        sums.add(Quantity::Acceleration, self.body_acceleration);
        for term in &self.terms {
            term.add(i, near, work, &mut sums);
        }
        if i.is_wall() {
            for a in 0..D {
                sums[Quantity::Acceleration(a)] = T::zero();
            }
        }
        sums
    }
}

/// Working memory of one worker.
pub(crate) struct Scratch<T, const D: usize> {
    candidates: Candidates<T, D>,
    neighbours: Neighbours<T, D>,
    work: Work<T>,
}

impl<T: Real, const D: usize> Default for Scratch<T, D> {
    fn default() -> Self {
        Self {
            candidates: Candidates::default(),
            neighbours: Neighbours::default(),
            work: Work::default(),
        }
    }
}

/// A sub-domain's own part of the rates that a sweep writes, in the order of its outputs.
type Written<'a, T> = [&'a mut [T]; Quantity::COUNT];

/// A sub-domain's share of a sweep, to be compiled for every instruction set.
struct Task<'s, 'n, T: Real, const D: usize> {
    sweep: &'s Sweep<T, D>,
    near: &'s Near<'n, Cells<T>>,
    block: &'s CellBlock<'n, T>,
    written: &'s mut Written<'n, T>,
    scratch: &'s mut Scratch<T, D>,
}

impl<T: Real, const D: usize> pulp::WithSimd for Task<'_, '_, T, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.sweep.run(self.near, self.block, self.written, self.scratch);
    }
}

impl<T: Real, const D: usize> RateStage<Cells<T>> for Sweep<T, D> {
    type Scratch = Scratch<T, D>;

    fn name(&self) -> &str {
        &self.name
    }

    fn writes(&self) -> Vec<ColumnId> {
        self.outputs.iter().map(|(_, rate)| rate.id()).collect()
    }

    fn rate(
        &self,
        near: &Near<'_, Cells<T>>,
        rates: &mut Rates<'_, Cells<T>>,
        scratch: &mut Self::Scratch,
        _: &Moment,
    ) -> Result<(), Fault> {
        let block = near.domain().sub_domain(near.id());
        let mut written: Written<'_, T> = std::array::from_fn(|_| &mut [][..]);
        for (column, &(_, rate)) in written.iter_mut().zip(&self.outputs) {
            *column = rates.column(rate).whole();
        }
        pulp::Arch::new().dispatch(Task {
            sweep: self,
            near,
            block: &block,
            written: &mut written,
            scratch,
        });
        Ok(())
    }
}
