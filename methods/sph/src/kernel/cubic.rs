//! The cubic spline.

use std::f64::consts::PI;

use finegrain_framework::Real;

use super::profile::{Profile, positive_part};
use crate::dimension::Dimension;

/// The cubic spline `f(q) = (2 - q)_+^3 - 4 (1 - q)_+^3`, with support 2.
///
/// Monaghan & Lattanzio (1985); this form and `sigma_d` = 1/6, 5/(14 pi), 1/(4 pi) as in
/// Price (2012). It is Schoenberg's (1946) `M_4`; the second derivative is continuous.
#[derive(Clone, Copy, Debug)]
pub struct CubicSpline;

impl Profile for CubicSpline {
    const SUPPORT: f64 = 2.0;

    fn normalisation(dimension: Dimension) -> f64 {
        match dimension {
            Dimension::One => 1.0 / 6.0,
            Dimension::Two => 5.0 / (14.0 * PI),
            Dimension::Three => 1.0 / (4.0 * PI),
        }
    }

    #[inline(always)]
    fn f<T: Real>(q: T) -> T {
        let a = positive_part(T::of(2.0) - q);
        let b = positive_part(T::one() - q);
        a * a * a - T::of(4.0) * (b * b * b)
    }

    #[inline(always)]
    fn df_dq<T: Real>(q: T) -> T {
        let a = positive_part(T::of(2.0) - q);
        let b = positive_part(T::one() - q);
        -T::of(3.0) * (a * a - T::of(4.0) * (b * b))
    }

    #[inline(always)]
    fn lane<T: Real>(q_squared: T) -> (T, T) {
        let q = q_squared.sqrt();
        // Multiplied out where (1 - q)_+ acts, so that q divides without rounding error.
        let df_dq_over_q = if q < T::one() {
            T::of(9.0) * q - T::of(12.0)
        } else {
            let a = T::of(2.0) - q;
            -T::of(3.0) * (a * a) / q
        };
        (Self::f(q), df_dq_over_q)
    }
}
