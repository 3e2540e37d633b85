//! Density by summation, together with the smoothing length that follows from it.
//!
//! A rate stage of its own: it has to iterate, since the smoothing length that the sum depends on
//! depends on the sum.

use finegrain_framework::instructions;
use finegrain_framework::space::Cells;
use finegrain_framework::{
    Activity, ColumnId, Domain, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real, Stage,
    State,
};

use crate::evaluation::{Alone, Piece};
use crate::fields::Fields;
use crate::gathered::{Gathered, Layout, Wanted};
use crate::kernel::adaptive::AdaptiveKernel;
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::Quantity;
use crate::surroundings::Surroundings;
use crate::sweep_part::SweepPart;

/// Most iterations for one particle; a few are usual.
const MOST_ITERATIONS: usize = 100;

/// Solves `m sum_j W(r_ij, h_i) = m (eta / h_i)^D` for the smoothing length `h_i` of every
/// particle, and sums up `Omega_i = 1 - dh_i/drho_i m sum_j dW(r_ij, h_i)/dh_i`, by which the
/// forces of varying smoothing lengths differ (Springel & Hernquist 2002, eqs. 5 to 8; Price 2012,
/// eqs. 10 to 29).
///
/// Newton's method within a bracket, from the smoothing length that goes with the particle's last
/// density, which is part of its state: a restart finds the same bits.
#[derive(Clone, Debug)]
pub(crate) struct AdaptiveDensity<T, P, const D: usize> {
    gathered: Gathered<T, P>,
    density: State<T>,
    identity: State<u32>,
    smoothing_length: Rate<T>,
    grad_h: Rate<T>,
    solver: Solver<T, D>,
}

impl<T: Real, P: Real, const D: usize> AdaptiveDensity<T, P, D> {
    /// For particles of mass `mass`, kg, and the smoothing ratio `ratio`.
    pub fn piece(kernel: AdaptiveKernel<T, D>, mass: T, ratio: T) -> Piece<T, P> {
        Piece::Alone(Alone {
            reads: Vec::new(),
            writes: vec![Quantity::SmoothingLength, Quantity::GradH],
            stage: Box::new(move |fields: &Fields<T, P>| {
                let rate = |quantity| fields.rate(quantity).expect("declared, since it is written");
                let wanted = Wanted { kernel: true, ..Wanted::default() };
                let gathered = Gathered::new(fields, Vec::new(), wanted);
                let layout = gathered.layout.clone();
                Stage::rate(Self {
                    gathered,
                    density: fields.density,
                    identity: fields.identity,
                    smoothing_length: rate(Quantity::SmoothingLength),
                    grad_h: rate(Quantity::GradH),
                    solver: Solver { kernel, mass, ratio, layout },
                })
            }),
        })
    }

    #[cold]
    fn fault(&self, near: &Near<'_, Cells<P>>, i: usize, needed: T) -> Fault {
        let identity = near.state(self.identity).own().whole()[i];
        let longest = self.solver.kernel.longest;
        Fault::new(if needed.is_nan() {
            format!("the smoothing length of particle {identity} does not converge")
        } else {
            format!(
                "particle {identity} needs a smoothing length of about {needed:.3e} m; it must be at \
                 most {longest:.3e} m, for which neighbours are searched"
            )
        })
    }
}

impl<T: Real, P: Real, const D: usize> RateStage<Cells<P>> for AdaptiveDensity<T, P, D> {
    type Scratch = Scratch<T, D>;

    fn name(&self) -> &str {
        "sph density and smoothing length"
    }

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.smoothing_length.id(), self.grad_h.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Cells<P>>,
        rates: &mut Rates<'_, Cells<P>>,
        scratch: &mut Self::Scratch,
        _: &Moment,
    ) -> Result<(), Fault> {
        let block = near.domain().sub_domain(near.id());
        let smoothing_length = rates.column(self.smoothing_length).whole();
        let grad_h = rates.column(self.grad_h).whole();
        let density = near.state(self.density).own().whole();
        let solver = &self.solver;
        let range = solver.kernel.support() * solver.kernel.longest;
        SweepPart::Collect.begin(near.activity());
        scratch.surroundings.collect(&self.gathered, near, &block, range);
        let written = [smoothing_length, grad_h];
        let solved = solver.write(density, written, scratch, near.activity());
        solved.map_err(|(i, needed)| self.fault(near, i, needed))
    }
}

/// What is computed from gathered values.
#[derive(Clone, Debug)]
struct Solver<T, const D: usize> {
    kernel: AdaptiveKernel<T, D>,
    mass: T,
    /// `eta`.
    ratio: T,
    layout: Layout,
}

impl<T: Real, const D: usize> Solver<T, D> {
    /// All particles of a sub-domain, by the best instructions of this processor; in error, the number
    /// of one of them and the smoothing length it would need.
    ///
    /// Not inlined, so that it is compiled once, and not again for every type of positions.
    #[inline(never)]
    fn write(
        &self,
        density: &[T],
        written: [&mut [T]; 2],
        scratch: &mut Scratch<T, D>,
        activity: &Activity,
    ) -> Result<(), (usize, T)> {
        instructions::dispatch(Task { solver: self, density, written, scratch, activity })
    }

    #[inline(always)]
    fn run(
        &self,
        density: &[T],
        [smoothing_length, grad_h]: [&mut [T]; 2],
        scratch: &mut Scratch<T, D>,
        activity: &Activity,
    ) -> Result<(), (usize, T)> {
        let Scratch { surroundings, neighbours, ones } = scratch;
        let mut particle = Particle::default();
        neighbours.prepare(&self.layout, surroundings.sees_bodies);
        for cell in 0..surroundings.cells.len() {
            let own = surroundings.cells[cell].clone();
            SweepPart::Search.begin(activity);
            surroundings.select(own.clone());
            for k in own {
                surroundings.look_up(&self.layout, k, &mut particle);
                let guess = self.ratio * root::<T, D>(self.mass / density[k]);
                let solved = self.solve(surroundings, neighbours, ones, &particle, guess, activity);
                (smoothing_length[k], grad_h[k]) = solved.map_err(|needed| (k, needed))?;
            }
        }
        Ok(())
    }

    /// Smoothing length and `Omega` of one particle; in error, the smoothing length it would need.
    #[inline(always)]
    fn solve(
        &self,
        surroundings: &Surroundings<T, D>,
        neighbours: &mut Neighbours<T, D>,
        ones: &mut Vec<T>,
        particle: &Particle<T, D>,
        guess: T,
        activity: &Activity,
    ) -> Result<(T, T), T> {
        let longest = self.kernel.longest;
        let tolerance = T::epsilon().sqrt() * T::epsilon().sqrt().sqrt();
        let dims = T::of(D as f64);
        let (mut low, mut high) = (T::zero(), longest);
        let mut h = if guess < longest { guess } else { longest };
        let mut reach = T::zero();
        for _ in 0..MOST_ITERATIONS {
            if h > reach {
                // A little further, for the iterations to come.
                reach = (T::of(1.1) * h).min(longest);
                let radius = self.kernel.support() * reach;
                neighbours.find(surroundings, particle, radius, None, activity);
                SweepPart::Kernel.begin(activity);
                ones.resize(neighbours.distance_squared().len().max(ones.len()), T::one());
            }
            neighbours.evaluate(&self.kernel.at(h));
            let lanes = neighbours.distance_squared();
            let [kernels] = T::dots(neighbours.kernel(), [&ones[..lanes.len()]]);
            let [slopes] = T::dots(neighbours.gradient_factor(), [lanes]);
            let (sum, slopes) = (self.mass * kernels, self.mass * slopes);
            let wanted = self.mass * power::<T, D>(self.ratio / h);
            // h d/dh of (sum - wanted), since h dW/dh = -(D W + r^2 F).
            let excess = sum - wanted;
            let slope = dims * (wanted - sum) - slopes;
            let newton = h * (T::one() - excess / slope);
            if (newton - h).abs() <= tolerance * h {
                return Ok((newton, -slopes / (dims * sum)));
            }
            if excess < T::zero() {
                if h >= longest {
                    return Err(newton.max(h));
                }
                low = h;
            } else {
                high = h;
            }
            h = if slope > T::zero() && newton > low && newton < high {
                newton
            } else if high == longest && slope > T::zero() && newton >= high {
                longest
            } else {
                T::of(0.5) * (low + high)
            };
        }
        Err(T::nan())
    }
}

/// `x^D`.
#[inline(always)]
pub(crate) fn power<T: Real, const D: usize>(x: T) -> T {
    let mut power = x;
    for _ in 1..D {
        power *= x;
    }
    power
}

/// `x^(1/D)`.
#[inline(always)]
pub(crate) fn root<T: Real, const D: usize>(x: T) -> T {
    match D {
        1 => x,
        2 => x.sqrt(),
        _ => x.cbrt(),
    }
}

/// Working memory of one worker.
pub(crate) struct Scratch<T, const D: usize> {
    surroundings: Surroundings<T, D>,
    neighbours: Neighbours<T, D>,
    /// As many ones as there are lanes.
    ones: Vec<T>,
}

impl<T: Real, const D: usize> Default for Scratch<T, D> {
    fn default() -> Self {
        Self {
            surroundings: Surroundings::default(),
            neighbours: Neighbours::default(),
            ones: Vec::new(),
        }
    }
}

/// A sub-domain's share, to be compiled for every instruction set.
struct Task<'s, T: Real, const D: usize> {
    solver: &'s Solver<T, D>,
    density: &'s [T],
    written: [&'s mut [T]; 2],
    scratch: &'s mut Scratch<T, D>,
    activity: &'s Activity,
}

impl<T: Real, const D: usize> pulp::WithSimd for Task<'_, T, D> {
    type Output = Result<(), (usize, T)>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        self.solver.run(self.density, self.written, self.scratch, self.activity)
    }
}
