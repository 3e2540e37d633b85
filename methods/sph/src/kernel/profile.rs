//! The radial profile of a smoothing kernel: what a file of this folder defines.

use finegrain_framework::Real;

use crate::dimension::Dimension;

/// A radial profile `f(q)`, from which a kernel is made by `W(r, h) = sigma_d / h^d f(r / h)`.
///
/// Everything is dimensionless: `q = r / h` is a distance in smoothing lengths. A profile falls
/// steadily from `f(0)` to the edge of its support.
pub trait Profile {
    /// `kappa`: the profile is zero for `q >= kappa`.
    const SUPPORT: f64;

    /// `sigma_d`, with which the integral of `sigma_d f(|x|)` over all space of this dimension
    /// is one.
    fn normalisation(dimension: Dimension) -> f64;

    /// `f(q)` for `q >= 0`, as the literature writes it.
    fn f<T: Real>(q: T) -> T;

    /// `f'(q)` for `q >= 0`, as the literature writes it.
    fn df_dq<T: Real>(q: T) -> T;

    /// `f(q)` and `f'(q) / q` from `q^2`, in the form for loops over lanes: without branches, and
    /// with the limit of `f'(q) / q` at `q = 0`.
    ///
    /// Holds inside the support; what it returns outside has no meaning.
    fn lane<T: Real>(q_squared: T) -> (T, T);
}

/// `x` where it is positive, otherwise 0: the `(x)_+` of truncated powers. NaN stays NaN.
#[inline(always)]
pub(super) fn positive_part<T: Real>(x: T) -> T {
    if x < T::zero() { T::zero() } else { x }
}
