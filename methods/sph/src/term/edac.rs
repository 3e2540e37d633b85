//! Entropically damped artificial compressibility (Ramachandran & Puri 2019): pressure evolves by
//! itself, with diffusion.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// Rate of change of the pressure, Pa/s (eq. 18), the sum of
///
/// - compression: `rho_i c^2 sum_j V_j v_ij . grad_i W_ij`,
/// - diffusion: `nu / V_i sum_j (V_i^2 + V_j^2) (p_i - p_j) F_ij`,
/// - and, where particles drift with a velocity `w` besides that of the flow, the pressure that
///   they drift into: `w_i . sum_j V_j (p_j - p_i) grad_i W_ij`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PressureEvolution<T> {
    pub mass: T,
    pub sound_speed_squared: T,
    /// Of the pressure, m^2/s.
    pub diffusivity: T,
    /// Whether particles drift.
    pub drifts: bool,
    /// Whether with the corrected gradient, where there is one.
    pub is_corrected: bool,
}

impl<T: Real> Term<T> for PressureEvolution<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let drift = Quantity::vector(Quantity::Drift, dims).filter(|_| self.drifts);
        let correction = Quantity::symmetric(Quantity::Correction, dims);
        let correction = correction.filter(|_| self.is_corrected);
        let velocity = Quantity::vector(Quantity::Velocity, dims).chain(correction);
        velocity.chain(drift).chain([Quantity::Volume, Quantity::Pressure]).collect()
    }

    fn writes(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::PressureRate]
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
        let [weight, jump] = work.lanes(factor.len());
        let (own, volume) = (i[Quantity::Volume], near.values(Quantity::Volume));
        let (own_pressure, pressure) = (i[Quantity::Pressure], near.values(Quantity::Pressure));
        if self.is_corrected {
            near.corrected_velocity_jump(i, jump);
        } else {
            near.velocity_jump(i, jump);
        }
        for ((weight, &factor), &volume) in weight.iter_mut().zip(factor).zip(volume) {
            *weight = factor * volume;
        }
        let [compression] = T::dots(weight, [&*jump]);
        let density = self.mass / own;
        let mut sum = density * self.sound_speed_squared * compression;
        for (jump, &p) in jump.iter_mut().zip(pressure) {
            *jump = own_pressure - p;
        }
        if self.drifts {
            for (weight, &jump) in weight.iter_mut().zip(&*jump) {
                *weight *= jump;
            }
            let mut gradient = near.sum_differences(weight);
            if self.is_corrected {
                gradient = i.corrected(gradient);
            }
            for a in 0..D {
                sum -= i[Quantity::Drift(a)] * gradient[a];
            }
        }
        for ((weight, &factor), &volume) in weight.iter_mut().zip(factor).zip(volume) {
            *weight = factor * volume.mul_add(volume, own * own);
        }
        let [diffusion] = T::dots(weight, [&*jump]);
        sums[Quantity::PressureRate] += sum + self.diffusivity / own * diffusion;
    }
}
