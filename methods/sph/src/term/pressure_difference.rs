//! Pressure gradient made of differences.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `-1 / rho_i sum_j V_j (p_j - p_i) grad_i W_ij`, m/s^2 (Monaghan 1992, section 3.1).
///
/// Nothing where the pressure is the same everywhere, however particles lie, which the symmetric
/// forms are not; but what a particle gets its neighbour does not lose: momentum is not conserved.
/// With the corrected gradient it is exact for a pressure that varies linearly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PressureDifference<T> {
    pub mass: T,
    /// Whether with the corrected gradient.
    pub is_corrected: bool,
}

impl<T: Real> Term<T> for PressureDifference<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let correction = Quantity::symmetric(Quantity::Correction, dims);
        let correction = correction.filter(|_| self.is_corrected);
        correction.chain([Quantity::Volume, Quantity::Pressure]).collect()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Acceleration, dims).collect()
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let factor = near.gradient_factor();
        let [weight, _] = work.lanes(factor.len());
        let (own, pressure) = (i[Quantity::Pressure], near.values(Quantity::Pressure));
        let volume = near.values(Quantity::Volume);
        let lanes = weight.iter_mut().zip(factor).zip(volume).zip(pressure);
        for (((weight, &factor), &volume), &p) in lanes {
            *weight = factor * volume * (p - own);
        }
        let mut acceleration = near.sum_differences(weight);
        if self.is_corrected {
            acceleration = i.corrected(acceleration);
        }
        let density = self.mass / i[Quantity::Volume];
        for a in 0..D {
            acceleration[a] /= -density;
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}
