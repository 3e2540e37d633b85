//! The quartic spline.

use std::f64::consts::PI;

use finegrain_framework::Real;

use super::profile::{Profile, positive_part};
use crate::dimension::Dimension;

/// The quartic spline `f(q) = (5/2 - q)_+^4 - 5 (3/2 - q)_+^4 + 10 (1/2 - q)_+^4`, with support
/// 5/2.
///
/// Morris (1996); this form and `sigma_d` = 1/24, 96/(1199 pi), 1/(20 pi) as in Price (2012). It
/// is Schoenberg's (1946) `M_5`; the third derivative is continuous.
#[derive(Clone, Copy, Debug)]
pub struct QuarticSpline;

impl Profile for QuarticSpline {
    const SUPPORT: f64 = 2.5;

    fn normalisation(dimension: Dimension) -> f64 {
        match dimension {
            Dimension::One => 1.0 / 24.0,
            Dimension::Two => 96.0 / (1199.0 * PI),
            Dimension::Three => 1.0 / (20.0 * PI),
        }
    }

    #[inline(always)]
    fn f<T: Real>(q: T) -> T {
        let a = positive_part(T::of(2.5) - q);
        let b = positive_part(T::of(1.5) - q);
        let c = positive_part(T::of(0.5) - q);
        let (a, b, c) = (a * a, b * b, c * c);
        a * a - T::of(5.0) * (b * b) + T::of(10.0) * (c * c)
    }

    #[inline(always)]
    fn df_dq<T: Real>(q: T) -> T {
        let a = positive_part(T::of(2.5) - q);
        let b = positive_part(T::of(1.5) - q);
        let c = positive_part(T::of(0.5) - q);
        -T::of(4.0) * (a * a * a - T::of(5.0) * (b * b * b) + T::of(10.0) * (c * c * c))
    }

    #[inline(always)]
    fn lane<T: Real>(q_squared: T) -> (T, T) {
        let q = q_squared.sqrt();
        // Multiplied out where (1/2 - q)_+ acts, so that q divides without rounding error.
        let df_dq_over_q = if q < T::of(0.5) {
            T::of(24.0) * q_squared - T::of(30.0)
        } else {
            let a = T::of(2.5) - q;
            let b = positive_part(T::of(1.5) - q);
            -T::of(4.0) * (a * a * a - T::of(5.0) * (b * b * b)) / q
        };
        (Self::f(q), df_dq_over_q)
    }
}
