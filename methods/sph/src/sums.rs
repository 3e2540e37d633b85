//! The sums of a sweep over what was gathered: nothing here knows columns, or how precise positions
//! are, so that it is compiled once for a scalar type.

use finegrain_framework::{Activity, Real, instructions};

use crate::gathered::Layout;
use crate::imposed::Imposed;
use crate::kernel::adaptive::Kernels;
use crate::neighbourhood::{Neighbours, Particle};
use crate::pairs::{List, Listed};
use crate::quantity::{Quantity, Values};
use crate::surroundings::Surroundings;
use crate::sweep_part::SweepPart;
use crate::term::{AnyTerm, Term, Work};
use crate::wall::{Extrapolation, Friction};

/// The sums of one sweep over all pairs, in `D` dimensions.
#[derive(Clone, Debug)]
pub(crate) struct Sums<T, const D: usize> {
    pub kernels: Kernels<T, D>,
    /// The sums for particles of the fluid.
    pub of_fluid: Vec<AnyTerm<T>>,
    /// The sums for particles of bodies.
    pub of_bodies: Vec<AnyTerm<T>>,
    /// The forces between fluid and bodies, where those on bodies are asked for.
    pub on_bodies: Vec<AnyTerm<T>>,
    pub layout: Layout,
    /// What is summed up.
    pub outputs: Vec<Quantity>,
    /// Only if accelerations are summed up.
    pub imposed: Option<Imposed<T, D>>,
    pub friction: Friction<T>,
}

/// A sub-domain's own part of the rates that a sweep writes, in the order of its outputs.
pub(crate) type Written<'a, T> = [&'a mut [T]; Quantity::COUNT];

impl<T: Real, const D: usize> Sums<T, D> {
    /// Sums of the particles of the sub-domain whose surroundings are in the scratch, by the best
    /// instructions of this processor.
    ///
    /// Not inlined, so that it is compiled once, and not again for every type of positions.
    #[inline(never)]
    pub fn write(
        &self,
        written: &mut Written<'_, T>,
        scratch: &mut Scratch<T, D>,
        listed: Listed<'_>,
        time: f64,
        activity: &Activity,
    ) {
        instructions::dispatch(Task { sums: self, written, scratch, listed, time, activity });
    }

    #[inline(always)]
    fn run(
        &self,
        written: &mut Written<'_, T>,
        scratch: &mut Scratch<T, D>,
        mut listed: Listed<'_>,
        time: f64,
        activity: &Activity,
    ) {
        let Scratch { surroundings, neighbours, work, .. } = scratch;
        let mut particle = Particle::default();
        neighbours.prepare(&self.layout, surroundings.sees_bodies);
        for cell in 0..surroundings.cells.len() {
            let own = surroundings.cells[cell].clone();
            let mut is_selected = false;
            let mut longest = T::zero();
            for k in own.clone() {
                surroundings.look_up(&self.layout, k, &mut particle);
                if !self.acts_at(particle[Quantity::WallDepth]) {
                    for column in &mut written[..self.outputs.len()] {
                        column[k] = T::zero();
                    }
                    listed.pass();
                    continue;
                }
                particle.no_slip = self.no_slip(&particle, surroundings);
                SweepPart::Search.begin(activity);
                let known = listed.read();
                if known.is_none() && !is_selected {
                    surroundings.select(own.clone());
                    if let Kernels::Adaptive(_) = self.kernels {
                        longest = surroundings.largest(&self.layout, Quantity::SmoothingLength);
                    }
                    is_selected = true;
                }
                let kernels = &self.kernels;
                neighbours.gather(surroundings, &particle, kernels, longest, known, activity);
                listed.write(neighbours.found());
                SweepPart::Terms.begin(activity);
                let mut sums = Values::zero();
                self.sum(&particle, neighbours, work, &mut sums);
                if let Some(imposed) = &self.imposed
                    && imposed.varies()
                    && !particle.is_wall()
                {
                    imposed.add_varying(
                        &particle,
                        surroundings.position(&particle),
                        time,
                        &mut sums,
                    );
                }
                for (column, &quantity) in written.iter_mut().zip(&self.outputs) {
                    column[k] = sums[quantity];
                }
            }
        }
    }

    #[inline(always)]
    fn no_slip(&self, i: &Particle<T, D>, around: &Surroundings<T, D>) -> Extrapolation<T> {
        if i.is_wall() || !around.sees_bodies {
            Extrapolation::none()
        } else {
            self.friction.at(around.position(i))
        }
    }

    /// Whether there are sums for a particle at this depth in a body.
    #[inline(always)]
    pub fn acts_at(&self, wall_depth: T) -> bool {
        if wall_depth > T::zero() {
            !(self.of_bodies.is_empty() && self.on_bodies.is_empty())
        } else {
            !self.of_fluid.is_empty()
        }
    }

    /// All terms for one particle.
    #[inline(always)]
    fn sum(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        // Both in one loop, because a loop over terms is a copy of all of them to compile.
        let rounds: [&[AnyTerm<T>]; 2] = if i.is_wall() {
            [&self.on_bodies, &self.of_bodies]
        } else {
            if let Some(imposed) = &self.imposed {
                sums.add(Quantity::Acceleration, imposed.uniform);
            }
            [&self.of_fluid, &[]]
        };
        for (round, terms) in rounds.into_iter().enumerate() {
            for term in terms {
                term.add(i, near, work, sums);
            }
            if i.is_wall() && round == 0 {
                // The forces on a body are not an acceleration of its particles.
                for a in 0..D {
                    sums[Quantity::Reaction(a)] = sums[Quantity::Acceleration(a)];
                    sums[Quantity::Acceleration(a)] = T::zero();
                }
            }
        }
    }
}

/// Working memory of one worker.
pub(crate) struct Scratch<T, const D: usize> {
    pub surroundings: Surroundings<T, D>,
    neighbours: Neighbours<T, D>,
    work: Work<T>,
    /// Where lists of neighbours grow.
    pub list: List,
}

impl<T: Real, const D: usize> Default for Scratch<T, D> {
    fn default() -> Self {
        Self {
            surroundings: Surroundings::default(),
            neighbours: Neighbours::default(),
            work: Work::default(),
            list: List::new(),
        }
    }
}

/// A sub-domain's share of a sweep, to be compiled for every instruction set.
struct Task<'s, 'n, T: Real, const D: usize> {
    sums: &'s Sums<T, D>,
    written: &'s mut Written<'n, T>,
    scratch: &'s mut Scratch<T, D>,
    listed: Listed<'s>,
    time: f64,
    activity: &'s Activity,
}

impl<T: Real, const D: usize> pulp::WithSimd for Task<'_, '_, T, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        self.sums.run(self.written, self.scratch, self.listed, self.time, self.activity);
    }
}
