//! Wendland's C6 function.

use std::f64::consts::PI;

use finegrain_framework::Real;

use super::profile::{Profile, positive_part};
use crate::dimension::Dimension;

/// Wendland's C6 function `f(q) = (1 - q/2)_+^8 (1 + 4 q + 25/4 q^2 + 4 q^3)`, with support 2.
///
/// Wendland (1995); `sigma_d` = 15/16, 39/(14 pi), 1365/(512 pi), the last two as in Dehnen & Aly
/// (2012). In one dimension it is the function for three, as
/// [`WendlandC2`](super::wendland::WendlandC2) is. Narrower still than C4.
#[derive(Clone, Copy, Debug)]
pub struct WendlandC6;

impl Profile for WendlandC6 {
    const SUPPORT: f64 = 2.0;

    fn normalisation(dimension: Dimension) -> f64 {
        match dimension {
            Dimension::One => 15.0 / 16.0,
            Dimension::Two => 39.0 / (14.0 * PI),
            Dimension::Three => 1365.0 / (512.0 * PI),
        }
    }

    #[inline(always)]
    fn f<T: Real>(q: T) -> T {
        let a = positive_part(T::one() - T::of(0.5) * q);
        let a2 = a * a;
        let a4 = a2 * a2;
        a4 * a4 * (T::one() + q * (T::of(4.0) + q * (T::of(6.25) + T::of(4.0) * q)))
    }

    #[inline(always)]
    fn df_dq<T: Real>(q: T) -> T {
        let a = positive_part(T::one() - T::of(0.5) * q);
        let a2 = a * a;
        let slope = T::one() + q * (T::of(3.5) + T::of(4.0) * q);
        -T::of(5.5) * q * (a2 * a2 * a2 * a) * slope
    }

    #[inline(always)]
    fn lane<T: Real>(q_squared: T) -> (T, T) {
        let q = q_squared.sqrt();
        let a = T::one() - T::of(0.5) * q;
        let a2 = a * a;
        let slope = T::one() + q * (T::of(3.5) + T::of(4.0) * q);
        (Self::f(q), -T::of(5.5) * (a2 * a2 * a2 * a) * slope)
    }
}
