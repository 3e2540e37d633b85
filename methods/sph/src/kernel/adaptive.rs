//! A kernel whose smoothing length differs from particle to particle.

use finegrain_framework::Real;

use super::{
    CubicSpline, Gaussian, Kernel, QuarticSpline, QuinticSpline, SmoothingFunction, WendlandC2,
    WendlandC4, WendlandC6,
};
use crate::dimension::Dimension;

/// The kernel of one smoothing function in `D` dimensions at any smoothing length up to a longest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AdaptiveKernel<T, const D: usize> {
    /// The kernel with smoothing length 1.
    unit: Kernel<T>,
    /// The longest smoothing length, m: neighbours are searched for as far as it reaches.
    pub longest: T,
}

impl<T: Real, const D: usize> AdaptiveKernel<T, D> {
    /// A kernel with smoothing lengths up to `longest`, m.
    pub fn new(function: SmoothingFunction, longest: T) -> Self {
        let dimension = match D {
            1 => Dimension::One,
            2 => Dimension::Two,
            _ => Dimension::Three,
        };
        Self { unit: Kernel::new(function, dimension, T::one()), longest }
    }

    /// Radius of the support in smoothing lengths.
    #[inline(always)]
    pub fn support(&self) -> T {
        self.unit.support_radius()
    }

    /// The kernel with smoothing length `h`, m.
    #[inline(always)]
    pub fn at(&self, h: T) -> Kernel<T> {
        let inverse = T::one() / h;
        let inverse_h_squared = inverse * inverse;
        let mut alpha = self.unit.alpha;
        for _ in 0..D {
            alpha *= inverse;
        }
        Kernel {
            smoothing_length: h,
            inverse_h_squared,
            alpha,
            alpha_over_h_squared: alpha * inverse_h_squared,
            ..self.unit
        }
    }

    /// Writes `F` for each squared distance, each with a smoothing length of its own; see
    /// [`Kernel::gradient_factor`].
    ///
    /// # Panics
    /// If the slices differ in length.
    #[inline(always)]
    pub fn gradient_factor(
        &self,
        distance_squared: &[T],
        smoothing_length: &[T],
        gradient_factor: &mut [T],
    ) {
        assert_eq!(distance_squared.len(), gradient_factor.len());
        assert_eq!(distance_squared.len(), smoothing_length.len());
        let kernel = *self; // A copy cannot change under the loop, so it stays in registers.
        with_profile!(self.unit.function, P => {
            let lanes = distance_squared.iter().zip(smoothing_length).zip(gradient_factor);
            for ((&r2, &h), factor) in lanes {
                (_, *factor) = kernel.at(h).lane::<P>(r2);
            }
        });
    }
}

/// The kernels of a model.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kernels<T, const D: usize> {
    /// One for all particles.
    Uniform(Kernel<T>),
    /// Every particle has its own smoothing length.
    Adaptive(AdaptiveKernel<T, D>),
}

impl<T: Real, const D: usize> Kernels<T, D> {
    /// The largest distance at which particles may interact, m.
    #[inline(always)]
    pub fn range(&self) -> T {
        match self {
            Self::Uniform(kernel) => kernel.support_radius(),
            Self::Adaptive(kernel) => kernel.support() * kernel.longest,
        }
    }
}
