//! Strain-rate tensor of a particle, for the viscous terms of eqs. I.2 and I.3.

use finegrain_framework::Real;

use super::LaneSum;
use super::momentum::component;
use crate::neighbourhood::{LANES, Neighbours, Particle, Quantity};

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
        density: T,
        extrapolation: impl Fn(T) -> T,
        has_walls: bool,
    ) -> [T; 6] {
        let mut sums = [[LaneSum::zero(); D]; D];
        let volume = near.values(Quantity::Volume);
        let no_depth = [T::zero(); LANES];
        for (k, factor) in near.gradient_factor().iter().enumerate() {
            let depth = if has_walls { &near.values(Quantity::WallDepth)[k] } else { &no_depth };
            let mut weight = [T::zero(); LANES];
            for l in 0..LANES {
                weight[l] = factor[l] * volume[k][l] * (T::one() + extrapolation(depth[l]));
            }
            for a in 0..D {
                let velocity = &near.values(Quantity::Velocity(a))[k];
                let mut jump = [T::zero(); LANES];
                for l in 0..LANES {
                    jump[l] = weight[l] * (velocity[l] - i.velocity[a]);
                }
                for b in 0..D {
                    let difference = &near.difference(b)[k];
                    for l in 0..LANES {
                        sums[a][b].add(l, jump[l], difference[l]);
                    }
                }
            }
        }
        let gradient = sums.map(|row| row.map(|sum| sum.total()));
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
