//! Density by summation, together with the smoothing length that follows from it.
//!
//! A rate stage of its own: it has to iterate, since the smoothing length that the sum depends on
//! depends on the sum.

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::CellBlock;
use finegrain_framework::{
    ColumnId, Domain, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real, Stage, State,
};

use crate::candidates::{Candidates, Gathered};
use crate::evaluation::{Alone, Piece};
use crate::fields::Fields;
use crate::kernel::adaptive::AdaptiveKernel;
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::Quantity;

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
pub(crate) struct AdaptiveDensity<T, const D: usize> {
    kernel: AdaptiveKernel<T, D>,
    mass: T,
    /// `eta`.
    ratio: T,
    gathered: Gathered<T>,
    density: State<T>,
    identity: State<u32>,
    smoothing_length: Rate<T>,
    grad_h: Rate<T>,
}

impl<T: Real, const D: usize> AdaptiveDensity<T, D> {
    /// For particles of mass `mass`, kg, and the smoothing ratio `ratio`.
    pub fn piece(kernel: AdaptiveKernel<T, D>, mass: T, ratio: T) -> Piece<T> {
        Piece::Alone(Alone {
            reads: Vec::new(),
            writes: vec![Quantity::SmoothingLength, Quantity::GradH],
            stage: Box::new(move |fields: &Fields<T>| {
                let rate = |quantity| fields.rate(quantity).expect("declared, since it is written");
                Stage::rate(Self {
                    kernel,
                    mass,
                    ratio,
                    gathered: Gathered::new(fields, Vec::new(), true),
                    density: fields.density,
                    identity: fields.identity,
                    smoothing_length: rate(Quantity::SmoothingLength),
                    grad_h: rate(Quantity::GradH),
                })
            }),
        })
    }

    /// All particles of a sub-domain.
    #[inline(always)]
    fn run(
        &self,
        near: &Near<'_, Cells<T>>,
        block: &CellBlock<'_, T>,
        [smoothing_length, grad_h]: [&mut [T]; 2],
        scratch: &mut Scratch<T, D>,
    ) -> Result<(), Fault> {
        let Scratch { candidates, neighbours, ones } = scratch;
        let density = near.state(self.density).own().whole();
        let range = self.kernel.support() * self.kernel.longest;
        let first = near.spans()[0].start;
        for cell in block.cells() {
            candidates.collect(&self.gathered, near, block, cell, range);
            for k in 0..cell.span.len() {
                let i = cell.span.start - first + k;
                let particle = candidates.particle(&self.gathered, k);
                let guess = self.ratio * root::<T, D>(self.mass / density[i]);
                match self.solve(candidates, neighbours, ones, &particle, guess) {
                    Ok((h, omega)) => (smoothing_length[i], grad_h[i]) = (h, omega),
                    Err(needed) => return Err(self.fault(near, i, needed)),
                }
            }
        }
        Ok(())
    }

    /// Smoothing length and `Omega` of one particle; in error, the smoothing length it would need.
    #[inline(always)]
    fn solve(
        &self,
        candidates: &Candidates<T, D>,
        neighbours: &mut Neighbours<T, D>,
        ones: &mut Vec<T>,
        particle: &Particle<T, D>,
        guess: T,
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
                neighbours.find(
                    &self.gathered,
                    candidates,
                    particle,
                    self.kernel.support() * reach,
                );
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

    #[cold]
    fn fault(&self, near: &Near<'_, Cells<T>>, i: usize, needed: T) -> Fault {
        let identity = near.state(self.identity).own().whole()[i];
        let longest = self.kernel.longest;
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
    candidates: Candidates<T, D>,
    neighbours: Neighbours<T, D>,
    /// As many ones as there are lanes.
    ones: Vec<T>,
}

impl<T: Real, const D: usize> Default for Scratch<T, D> {
    fn default() -> Self {
        Self {
            candidates: Candidates::default(),
            neighbours: Neighbours::default(),
            ones: Vec::new(),
        }
    }
}

/// A sub-domain's share, to be compiled for every instruction set.
struct Task<'s, 'n, T: Real, const D: usize> {
    stage: &'s AdaptiveDensity<T, D>,
    near: &'s Near<'n, Cells<T>>,
    block: &'s CellBlock<'n, T>,
    written: [&'s mut [T]; 2],
    scratch: &'s mut Scratch<T, D>,
}

impl<T: Real, const D: usize> pulp::WithSimd for Task<'_, '_, T, D> {
    type Output = Result<(), Fault>;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Self::Output {
        self.stage.run(self.near, self.block, self.written, self.scratch)
    }
}

impl<T: Real, const D: usize> RateStage<Cells<T>> for AdaptiveDensity<T, D> {
    type Scratch = Scratch<T, D>;

    fn name(&self) -> &str {
        "sph density and smoothing length"
    }

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.smoothing_length.id(), self.grad_h.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Cells<T>>,
        rates: &mut Rates<'_, Cells<T>>,
        scratch: &mut Self::Scratch,
        _: &Moment,
    ) -> Result<(), Fault> {
        let block = near.domain().sub_domain(near.id());
        let written =
            [rates.column(self.smoothing_length).whole(), rates.column(self.grad_h).whole()];
        pulp::Arch::new().dispatch(Task { stage: self, near, block: &block, written, scratch })
    }
}
