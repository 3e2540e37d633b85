//! A rate stage of SPH: for every particle gather its neighbours once, then let every term of
//! the scene run over them.

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::CellBlock;
use finegrain_framework::{
    ColumnId, Domain, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real,
};

use crate::acceleration::AccelerationField;
use crate::candidates::{Candidates, Gathered};
use crate::fields::Fields;
use crate::kernel::adaptive::Kernels;
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};
use crate::term::{AnyTerm, Term, Work};
use crate::wall::{Extrapolation, Friction};

/// One sweep over all pairs, in `D` dimensions.
#[derive(Clone, Debug)]
pub(crate) struct Sweep<T, const D: usize> {
    name: String,
    kernels: Kernels<T, D>,
    /// The sums for particles of the fluid.
    of_fluid: Vec<AnyTerm<T>>,
    /// The sums for particles of bodies.
    of_bodies: Vec<AnyTerm<T>>,
    /// The forces between fluid and bodies, where those on bodies are asked for.
    on_bodies: Vec<AnyTerm<T>>,
    gathered: Gathered<T>,
    outputs: Vec<(Quantity, Rate<T>)>,
    /// Acceleration of the fluid by a body force, m/s^2.
    body_acceleration: [T; D],
    /// The part of it that varies; only if accelerations are summed up.
    acceleration_field: Option<AccelerationField>,
    friction: Friction<T>,
}

impl<T: Real, const D: usize> Sweep<T, D> {
    /// A sweep of `terms`, with the columns that they need. If `bodies_evolve`, the sums for the
    /// fluid are for the particles of bodies, too.
    pub fn new(
        kernels: Kernels<T, D>,
        terms: Vec<AnyTerm<T>>,
        fields: &Fields<T>,
        body_acceleration: [T; D],
        acceleration_field: Option<&AccelerationField>,
        bodies_evolve: bool,
        friction: &Friction<T>,
    ) -> Self {
        let reads = terms.iter().flat_map(|term| term.reads(D)).chain([Quantity::WallDepth]);
        let mut writes: Vec<_> = terms.iter().flat_map(|term| term.writes(D)).collect();
        writes.sort_unstable();
        writes.dedup();
        let accelerates = writes.contains(&Quantity::Acceleration(0));
        if accelerates {
            writes.extend(Quantity::vector(Quantity::Reaction, fields.reaction.len()));
        }
        let outputs = writes.into_iter().filter_map(|q| Some((q, fields.rate(q)?))).collect();
        // Named after what it sums up, for error messages.
        let names: Vec<_> = terms.iter().map(AnyTerm::name).collect();
        let uses_kernel = terms.iter().any(Term::uses_kernel);
        let sees_velocity = terms.iter().any(Term::sees_velocity_in_bodies);
        // Particles of bodies do not move, and stress in them is not looked at.
        let evolves = |term: &AnyTerm<T>| {
            let of_fluid =
                |q: &Quantity| matches!(q, Quantity::Acceleration(_) | Quantity::StressTerm(_));
            !term.writes(D).iter().all(of_fluid)
        };
        let of_bodies =
            |term: &&AnyTerm<T>| term.acts_on_bodies() || (bodies_evolve && evolves(term));
        let slips = matches!(friction, Friction::None);
        let on_bodies =
            |term: &&AnyTerm<T>| term.pushes_bodies() && !(slips && term.sees_velocity_in_bodies());
        let reacts = accelerates && !fields.reaction.is_empty();
        Self {
            name: format!("sph {}", names.join(", ")),
            kernels,
            gathered: Gathered::new(fields, reads.collect(), uses_kernel),
            of_fluid: terms.iter().filter(|term| !term.acts_on_bodies()).copied().collect(),
            of_bodies: terms.iter().filter(of_bodies).copied().collect(),
            on_bodies: terms.iter().filter(on_bodies).filter(|_| reacts).copied().collect(),
            outputs,
            body_acceleration,
            acceleration_field: acceleration_field.filter(|_| accelerates).cloned(),
            friction: if sees_velocity { friction.clone() } else { Friction::AsGiven },
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
        time: f64,
    ) {
        let Scratch { candidates, neighbours, work } = scratch;
        let first = near.spans()[0].start;
        let own_depth = self.gathered.wall_depth().map(|depth| near.state(depth).own().whole());
        for cell in block.cells() {
            let place = cell.span.start - first;
            if let Some(depth) = own_depth
                && !depth[place..place + cell.span.len()].iter().any(|&d| self.acts_at(d))
            {
                for column in &mut written[..self.outputs.len()] {
                    column[place..place + cell.span.len()].fill(T::zero());
                }
                continue;
            }
            candidates.collect(&self.gathered, near, block, cell, self.kernels.range());
            let longest = match self.kernels {
                Kernels::Uniform(_) => T::zero(),
                Kernels::Adaptive(_) => {
                    candidates.largest(&self.gathered, Quantity::SmoothingLength)
                }
            };
            for k in 0..cell.span.len() {
                let mut particle = candidates.particle(&self.gathered, k);
                if !self.acts_at(particle[Quantity::WallDepth]) {
                    for column in &mut written[..self.outputs.len()] {
                        column[place + k] = T::zero();
                    }
                    continue;
                }
                particle.no_slip = self.no_slip(&particle);
                neighbours.gather(&self.gathered, candidates, &particle, &self.kernels, longest);
                let mut sums = self.sum(&particle, neighbours, work);
                if let Some(field) = &self.acceleration_field
                    && !particle.is_wall()
                {
                    sums.add(Quantity::Acceleration, field.at(particle.position, time));
                }
                for (column, &(quantity, _)) in written.iter_mut().zip(&self.outputs) {
                    column[place + k] = sums[quantity];
                }
            }
        }
    }

    #[inline(always)]
    fn no_slip(&self, i: &Particle<T, D>) -> Extrapolation<T> {
        if i.is_wall() { Extrapolation::none() } else { self.friction.at(i.position) }
    }

    /// Whether there are sums for a particle at this depth in a body.
    #[inline(always)]
    fn acts_at(&self, wall_depth: T) -> bool {
        if wall_depth > T::zero() {
            !(self.of_bodies.is_empty() && self.on_bodies.is_empty())
        } else {
            !self.of_fluid.is_empty()
        }
    }

    /// All terms for one particle.
    #[inline(always)]
    fn sum(&self, i: &Particle<T, D>, near: &Neighbours<T, D>, work: &mut Work<T>) -> Values<T> {
        let mut sums = Values::zero();
        let accelerating = if i.is_wall() {
            &self.on_bodies
        } else {
            sums.add(Quantity::Acceleration, self.body_acceleration);
            &self.of_fluid
        };
        for term in accelerating {
            term.add(i, near, work, &mut sums);
        }
        if i.is_wall() {
            for a in 0..D {
                sums[Quantity::Reaction(a)] = sums[Quantity::Acceleration(a)];
                sums[Quantity::Acceleration(a)] = T::zero();
            }
            for term in &self.of_bodies {
                term.add(i, near, work, &mut sums);
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
    time: f64,
}

impl<T: Real, const D: usize> pulp::WithSimd for Task<'_, '_, T, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.sweep.run(self.near, self.block, self.written, self.scratch, self.time);
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
        moment: &Moment,
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
            time: moment.stage_time,
        });
        Ok(())
    }
}
