//! Conservation of mass (Holmes et al. 2011, eq. I.1).

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `d rho_i / dt = sum_j m_j (v_i - v_j) . grad_i W_ij`, kg/(m^3 s), for equal masses `m`; or
/// `rho_i sum_j V_j (v_i - v_j) . L_i grad_i W_ij` with the corrected gradient (Bonet & Lok 1999),
/// which is exact where the velocity varies linearly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Continuity<T> {
    pub mass: T,
    /// Whether with the corrected gradient.
    pub is_corrected: bool,
}

impl<T: Real> Term<T> for Continuity<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let correction = Quantity::symmetric(Quantity::Correction, dims).chain([Quantity::Volume]);
        let correction = correction.filter(|_| self.is_corrected);
        Quantity::vector(Quantity::Velocity, dims).chain(correction).collect()
    }

    fn writes(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::DensityRate]
    }

    fn uses_gradient(&self) -> bool {
        !self.is_corrected
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        if self.is_corrected {
            let factor = near.gradient_factor();
            let [jump, weight] = work.lanes(factor.len());
            near.corrected_velocity_jump(i, jump);
            let volume = near.values(Quantity::Volume);
            for ((weight, &factor), &volume) in weight.iter_mut().zip(factor).zip(volume) {
                *weight = factor * volume;
            }
            let [sum] = T::dots(weight, [&*jump]);
            sums[Quantity::DensityRate] += self.mass / i[Quantity::Volume] * sum;
        } else {
            let (mut minus_own, mut velocity) = ([T::zero(); D], [&[][..]; D]);
            for a in 0..D {
                minus_own[a] = -i[Quantity::Velocity(a)];
                velocity[a] = near.values(Quantity::Velocity(a));
            }
            let sum = T::raised_contraction(minus_own, velocity, near.gradients());
            sums[Quantity::DensityRate] -= self.mass * sum;
        }
    }
}
