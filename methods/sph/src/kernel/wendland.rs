//! Wendland's C2 function.

use std::f64::consts::PI;

use finegrain_framework::Real;

use super::profile::{Profile, positive_part};
use crate::dimension::Dimension;

/// Wendland's C2 function `f(q) = (1 - q/2)_+^4 (1 + 2 q)`, with support 2.
///
/// Wendland (1995); `sigma_d` = 3/4, 7/(4 pi), 21/(16 pi), the last two as in Dehnen & Aly
/// (2012). In one dimension, too, it is the function for three: positive definite there, though
/// not of least degree. `f'(q) / q` needs neither a division nor an exponential, and a positive
/// Fourier transform keeps particles from pairing.
#[derive(Clone, Copy, Debug)]
pub struct WendlandC2;

impl Profile for WendlandC2 {
    const SUPPORT: f64 = 2.0;

    fn normalisation(dimension: Dimension) -> f64 {
        match dimension {
            Dimension::One => 3.0 / 4.0,
            Dimension::Two => 7.0 / (4.0 * PI),
            Dimension::Three => 21.0 / (16.0 * PI),
        }
    }

    #[inline(always)]
    fn f<T: Real>(q: T) -> T {
        let a = positive_part(T::one() - T::of(0.5) * q);
        let a2 = a * a;
        a2 * a2 * (T::one() + T::of(2.0) * q)
    }

    #[inline(always)]
    fn df_dq<T: Real>(q: T) -> T {
        let a = positive_part(T::one() - T::of(0.5) * q);
        -T::of(5.0) * q * (a * a * a)
    }

    #[inline(always)]
    fn lane<T: Real>(q_squared: T) -> (T, T) {
        let q = q_squared.sqrt();
        let a = T::one() - T::of(0.5) * q;
        (Self::f(q), -T::of(5.0) * (a * a * a))
    }
}
