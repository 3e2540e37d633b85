//! Strain-rate tensor of a particle, for the viscous terms of eqs. I.2 and I.3.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values, component};
use crate::wall::VelocityInBodies;

/// `mu epsilon_i / rho_i^2` with the strain rate
/// `epsilon^ab = d_b v^a + d_a v^b - 2/3 (div v) delta^ab`, where
/// `d_b v^a = sum_j m_j / rho_j (v_j^a - v_i^a) d_b W_ij` (Liu & Liu 2003, section 4.3).
///
/// Wall particles are seen with the velocity that the no-slip condition gives them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrainRate<T> {
    pub mass: T,
    /// Dynamic viscosity `mu`, Pa s.
    pub dynamic_viscosity: T,
    /// Velocity that is seen in bodies, besides that with which particles move.
    pub in_bodies: Option<VelocityInBodies>,
    /// Whether with the corrected gradient.
    pub is_corrected: bool,
}

impl<T: Real> Term<T> for StrainRate<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let correction = Quantity::symmetric(Quantity::Correction, dims);
        let correction = correction.filter(|_| self.is_corrected);
        VelocityInBodies::reads(self.in_bodies, dims).into_iter().chain(correction).collect()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::symmetric(Quantity::StressTerm, dims).collect()
    }

    fn uses_gradient(&self) -> bool {
        true
    }

    fn sees_velocity_in_bodies(&self) -> bool {
        true
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let volume = near.values(Quantity::Volume);
        let [weight, jump] = work.lanes(volume.len());
        let weight = match near.wall_depth() {
            None => volume,
            depth => {
                weight.copy_from_slice(volume);
                i.no_slip.amplify(weight, depth);
                weight
            }
        };
        let mut gradient = [[T::zero(); D]; D];
        for a in 0..D {
            let (own, v) = (i[Quantity::Velocity(a)], near.values(Quantity::Velocity(a)));
            for ((jump, &weight), &v) in jump.iter_mut().zip(weight).zip(v) {
                *jump = weight * (v - own);
            }
            if let Some(in_bodies) = self.in_bodies {
                let lanes = jump.iter_mut().zip(weight).zip(near.values(in_bodies.component(a)));
                for ((jump, &weight), &v) in lanes {
                    *jump += weight * v;
                }
            }
            gradient[a] = T::dots(jump, near.gradients());
            if self.is_corrected {
                gradient[a] = i.corrected(gradient[a]);
            }
        }
        let divergence = (0..D).fold(T::zero(), |sum, a| sum + gradient[a][a]);
        let density = self.mass / i[Quantity::Volume];
        let scale = self.dynamic_viscosity / (density * density);
        for a in 0..D {
            for b in 0..=a {
                let trace = if a == b { T::of(2.0 / 3.0) * divergence } else { T::zero() };
                sums[Quantity::StressTerm(component(a, b))] +=
                    scale * (gradient[a][b] + gradient[b][a] - trace);
            }
        }
    }
}
