//! Smoothing kernels `W(r, h)` with compact support.
//!
//! A kernel replaces the delta function in the SPH interpolation (Holmes, Williams & Tilke 2011,
//! section 4.1). Each file of this folder defines one radial [`Profile`]; [`SmoothingFunction`]
//! names them for scenes, and [`Kernel`] evaluates the chosen one over the lanes of a neighbour
//! block.

pub mod cubic;
pub mod gaussian;
pub mod profile;
pub mod quartic;
pub mod quintic;
pub mod wendland;
pub mod wendland_c4;
pub mod wendland_c6;

#[cfg(test)]
mod tests;

use finegrain_framework::Real;

use crate::dimension::Dimension;
use cubic::CubicSpline;
use gaussian::Gaussian;
use profile::Profile;
use quartic::QuarticSpline;
use quintic::QuinticSpline;
use wendland::WendlandC2;
use wendland_c4::WendlandC4;
use wendland_c6::WendlandC6;

/// The name by which a scene chooses its kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SmoothingFunction {
    /// See [`Gaussian`]; the choice of Holmes, Williams & Tilke (2011).
    Gaussian,
    /// See [`CubicSpline`].
    CubicSpline,
    /// See [`QuarticSpline`].
    QuarticSpline,
    /// See [`QuinticSpline`].
    QuinticSpline,
    /// See [`WendlandC2`].
    WendlandC2,
    /// See [`WendlandC4`].
    WendlandC4,
    /// See [`WendlandC6`].
    WendlandC6,
}

/// Evaluates an expression with the type `$Profile` standing for the profile that is named.
macro_rules! with_profile {
    ($name:expr, $Profile:ident => $expression:expr) => {
        match $name {
            SmoothingFunction::Gaussian => {
                type $Profile = Gaussian;
                $expression
            }
            SmoothingFunction::CubicSpline => {
                type $Profile = CubicSpline;
                $expression
            }
            SmoothingFunction::QuarticSpline => {
                type $Profile = QuarticSpline;
                $expression
            }
            SmoothingFunction::QuinticSpline => {
                type $Profile = QuinticSpline;
                $expression
            }
            SmoothingFunction::WendlandC2 => {
                type $Profile = WendlandC2;
                $expression
            }
            SmoothingFunction::WendlandC4 => {
                type $Profile = WendlandC4;
                $expression
            }
            SmoothingFunction::WendlandC6 => {
                type $Profile = WendlandC6;
                $expression
            }
        }
    };
}

// After the macro, which it uses.
pub(crate) mod adaptive;

impl SmoothingFunction {
    /// `kappa`: the radius of the support in smoothing lengths.
    pub fn support(self) -> f64 {
        with_profile!(self, P => P::SUPPORT)
    }
}

/// The kernel `W(r, h) = alpha_d f(q)`, with `q = r / h` and `alpha_d = sigma_d / h^d`.
///
/// For the hot loop it works on *lanes*, contiguous slices with one neighbour an element, and
/// gives besides `W` the gradient factor `F = (1/r) dW/dr`, with which
/// `grad_i W(|x_i - x_j|, h) = F (x_i - x_j)`; `F` is finite at `r = 0`. The lane methods have no
/// branches within the loop and are inlined: called from the `#[inline(always)]`
/// [`pulp::WithSimd::with_simd`] of a task for [`pulp::Arch::dispatch`] they compile to full-width
/// SIMD. (Handed to `dispatch` as a closure they may not: the compiler need not inline the call.)
/// The bits of the result do not depend on the instruction set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kernel<T> {
    function: SmoothingFunction,
    smoothing_length: T,
    /// Square of the radius, in smoothing lengths, from which on lanes are zero.
    cut_squared: T,
    /// 1 / h^2.
    inverse_h_squared: T,
    /// alpha_d, for `W`.
    alpha: T,
    /// alpha_d / h^2, for `F = alpha_d / h^2 f'(q) / q`.
    alpha_over_h_squared: T,
}

impl<T: Real> Kernel<T> {
    /// A kernel with smoothing length `h` in metres.
    ///
    /// `F` at `r = 0` is of the order of `1 / h^(d + 2)`: with `T = f32` in three dimensions it
    /// overflows when `h` is below about 1e-7.
    ///
    /// # Panics
    /// If `smoothing_length` is not finite and above zero.
    pub fn new(function: SmoothingFunction, dimension: Dimension, smoothing_length: T) -> Self {
        let h = smoothing_length.as_f64();
        assert!(
            h > 0.0 && h.is_finite(),
            "smoothing length must be finite and above zero, not {h}"
        );
        let sigma = with_profile!(function, P => P::normalisation(dimension));
        let alpha = sigma / h.powi(dimension.number() as i32);
        Kernel {
            function,
            smoothing_length,
            cut_squared: (T::of(function.support()) * Self::cut()).powi(2),
            inverse_h_squared: T::of(1.0 / (h * h)),
            alpha: T::of(alpha),
            alpha_over_h_squared: T::of(alpha / (h * h)),
        }
    }

    /// Smoothing length `h`, in metres.
    pub fn smoothing_length(&self) -> T {
        self.smoothing_length
    }

    /// Radius of the support, `kappa h`, in metres: particles as far apart or further do not
    /// interact.
    pub fn support_radius(&self) -> T {
        T::of(self.function.support()) * self.smoothing_length
    }

    /// Share of the support radius from which on lanes are zero, a little less than 1: on a lattice many
    /// pairs are exactly the support apart, and rounding would decide, for each of the two by itself,
    /// whether they interact, and for the search, which is made in `f32`, whether to look at them.
    pub fn cut() -> T {
        T::one() - T::epsilon().sqrt().max(T::of(1e-5))
    }

    /// `W` at the distance `q h`, for `q >= 0`: the definition, one value at a time.
    pub fn w(&self, q: T) -> T {
        self.alpha * with_profile!(self.function, P => P::f(q))
    }

    /// `dW/dq` at the distance `q h`, for `q >= 0`: the definition, one value at a time.
    pub fn dw_dq(&self, q: T) -> T {
        self.alpha * with_profile!(self.function, P => P::df_dq(q))
    }

    /// Writes `W` and `F` for each squared distance.
    ///
    /// Both are zero where the distance is the support radius or more, or shorter by the share that
    /// [`Kernel::cut`] leaves out, so a block is padded with infinity. A distance that is NaN gives NaN.
    ///
    /// # Panics
    /// If the slices differ in length.
    #[inline(always)]
    pub fn evaluate(&self, distance_squared: &[T], w: &mut [T], gradient_factor: &mut [T]) {
        assert_eq!(distance_squared.len(), w.len());
        assert_eq!(distance_squared.len(), gradient_factor.len());
        let kernel = *self; // A copy cannot change under the loop, so it stays in registers.
        with_profile!(self.function, P => {
            for ((&r2, w), factor) in distance_squared.iter().zip(w).zip(gradient_factor) {
                (*w, *factor) = kernel.lane::<P>(r2);
            }
        });
    }

    /// Writes `F` for each squared distance, as [`Kernel::evaluate`] does, for rates that do not
    /// need `W`.
    ///
    /// # Panics
    /// If the slices differ in length.
    #[inline(always)]
    pub fn gradient_factor(&self, distance_squared: &[T], gradient_factor: &mut [T]) {
        assert_eq!(distance_squared.len(), gradient_factor.len());
        let kernel = *self; // As above.
        with_profile!(self.function, P => {
            for (&r2, factor) in distance_squared.iter().zip(gradient_factor) {
                (_, *factor) = kernel.lane::<P>(r2);
            }
        });
    }

    /// `W` and `F` at one squared distance.
    #[inline(always)]
    fn lane<P: Profile>(self, distance_squared: T) -> (T, T) {
        let q_squared = distance_squared * self.inverse_h_squared;
        let (f, df_dq_over_q) = P::lane(q_squared);
        let w = self.alpha * f;
        let gradient_factor = self.alpha_over_h_squared * df_dq_over_q;
        if q_squared >= self.cut_squared { (T::zero(), T::zero()) } else { (w, gradient_factor) }
    }
}
