//! Wendland's C4 function.

use std::f64::consts::PI;

use finegrain_framework::Real;

use super::profile::{Profile, positive_part};
use crate::dimension::Dimension;

/// Wendland's C4 function `f(q) = (1 - q/2)_+^6 (1 + 3 q + 35/12 q^2)`, with support 2.
///
/// Wendland (1995); `sigma_d` = 27/32, 9/(4 pi), 495/(256 pi), the last two as in Dehnen & Aly
/// (2012). In one dimension it is the function for three, as
/// [`WendlandC2`](super::wendland::WendlandC2) is. Narrower than C2 for the same support: it wants
/// more neighbours, and keeps its order with them.
#[derive(Clone, Copy, Debug)]
pub struct WendlandC4;

impl Profile for WendlandC4 {
    const SUPPORT: f64 = 2.0;

    fn normalisation(dimension: Dimension) -> f64 {
        match dimension {
            Dimension::One => 27.0 / 32.0,
            Dimension::Two => 9.0 / (4.0 * PI),
            Dimension::Three => 495.0 / (256.0 * PI),
        }
    }

    #[inline(always)]
    fn f<T: Real>(q: T) -> T {
        let a = positive_part(T::one() - T::of(0.5) * q);
        let a2 = a * a;
        a2 * a2 * a2 * (T::one() + q * (T::of(3.0) + T::of(35.0 / 12.0) * q))
    }

    #[inline(always)]
    fn df_dq<T: Real>(q: T) -> T {
        let a = positive_part(T::one() - T::of(0.5) * q);
        let a2 = a * a;
        -T::of(14.0 / 3.0) * q * (a2 * a2 * a) * (T::one() + T::of(2.5) * q)
    }

    #[inline(always)]
    fn lane<T: Real>(q_squared: T) -> (T, T) {
        let q = q_squared.sqrt();
        let a = T::one() - T::of(0.5) * q;
        let a2 = a * a;
        (Self::f(q), -T::of(14.0 / 3.0) * (a2 * a2 * a) * (T::one() + T::of(2.5) * q))
    }
}
