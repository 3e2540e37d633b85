//! Strain-rate tensor of a particle, for the viscous terms of eqs. I.2 and I.3.

use finegrain_framework::Real;

use super::Work;
use super::momentum::component;
use crate::neighbourhood::{Neighbours, Particle, Quantity};
use crate::wall::Extrapolation;

/// Constants of the term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StrainRate<T> {
    /// Dynamic viscosity `mu`, Pa s.
    pub dynamic_viscosity: T,
}

impl<T: Real> StrainRate<T> {
    /// `mu epsilon_i / rho_i^2` with the traceless strain rate
    /// `epsilon^ab = d_b v^a + d_a v^b - 2/3 (div v) delta^ab`, where
    /// `d_b v^a = sum_j m_j / rho_j (v_j^a - v_i^a) d_b W_ij` (Liu & Liu 2003, section 4.3).
    ///
    /// Wall particles are seen with the velocity that `no_slip` gives them.
    #[inline(always)]
    pub fn stress_term<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        density: T,
        no_slip: &Extrapolation<T>,
    ) -> [T; 6] {
        let factor = near.gradient_factor();
        let [weight, jump] = work.lanes(factor.len());
        let volume = near.values(Quantity::Volume);
        for ((weight, &factor), &volume) in weight.iter_mut().zip(factor).zip(volume) {
            *weight = factor * volume;
        }
        no_slip.amplify(weight, near.wall_depth());
        let mut gradient = [[T::zero(); D]; D];
        for a in 0..D {
            let v = near.values(Quantity::Velocity(a));
            for ((jump, &weight), &v) in jump.iter_mut().zip(&*weight).zip(v) {
                *jump = weight * (v - i.velocity[a]);
            }
            gradient[a] = near.sum_differences(jump);
        }
        let divergence = (0..D).fold(T::zero(), |sum, a| sum + gradient[a][a]);
        let scale = self.dynamic_viscosity / (density * density);
        let mut stress = [T::zero(); 6];
        for a in 0..D {
            for b in 0..=a {
                let trace = if a == b { T::of(2.0 / 3.0) * divergence } else { T::zero() };
                stress[component(a, b)] = scale * (gradient[a][b] + gradient[b][a] - trace);
            }
        }
        stress
    }
}
