//! The quintic spline.

use std::f64::consts::PI;

use finegrain_framework::Real;

use super::profile::{Profile, positive_part};
use crate::dimension::Dimension;

/// The quintic spline `f(q) = (3 - q)_+^5 - 6 (2 - q)_+^5 + 15 (1 - q)_+^5`, with support 3.
///
/// Morris, Fox & Zhu (1997); this form and `sigma_d` = 1/120, 7/(478 pi), 1/(120 pi) as in
/// Price (2012). The 3/(359 pi) that some texts print for three dimensions is 0.3 % too large. It
/// is Schoenberg's (1946) `M_6`; the fourth derivative is continuous.
#[derive(Clone, Copy, Debug)]
pub struct QuinticSpline;

impl Profile for QuinticSpline {
    const SUPPORT: f64 = 3.0;

    fn normalisation(dimension: Dimension) -> f64 {
        match dimension {
            Dimension::One => 1.0 / 120.0,
            Dimension::Two => 7.0 / (478.0 * PI),
            Dimension::Three => 1.0 / (120.0 * PI),
        }
    }

    #[inline(always)]
    fn f<T: Real>(q: T) -> T {
        let a = positive_part(T::of(3.0) - q);
        let b = positive_part(T::of(2.0) - q);
        let c = positive_part(T::one() - q);
        let (a2, b2, c2) = (a * a, b * b, c * c);
        a2 * a2 * a - T::of(6.0) * (b2 * b2 * b) + T::of(15.0) * (c2 * c2 * c)
    }

    #[inline(always)]
    fn df_dq<T: Real>(q: T) -> T {
        let a = positive_part(T::of(3.0) - q);
        let b = positive_part(T::of(2.0) - q);
        let c = positive_part(T::one() - q);
        let (a2, b2, c2) = (a * a, b * b, c * c);
        -T::of(5.0) * (a2 * a2 - T::of(6.0) * (b2 * b2) + T::of(15.0) * (c2 * c2))
    }

    #[inline(always)]
    fn lane<T: Real>(q_squared: T) -> (T, T) {
        let q = q_squared.sqrt();
        // Multiplied out where (1 - q)_+ acts, so that q divides without rounding error.
        let df_dq_over_q = if q < T::one() {
            q_squared * (T::of(120.0) - T::of(50.0) * q) - T::of(120.0)
        } else {
            let a = T::of(3.0) - q;
            let b = positive_part(T::of(2.0) - q);
            let (a2, b2) = (a * a, b * b);
            -T::of(5.0) * (a2 * a2 - T::of(6.0) * (b2 * b2)) / q
        };
        (Self::f(q), df_dq_over_q)
    }
}
