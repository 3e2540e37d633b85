//! Laminar viscosity of Morris, Fox & Zhu (1997).

use finegrain_framework::Real;

use super::LaneSum;
use crate::neighbourhood::{LANES, Neighbours, Particle, Quantity};

/// Constants of the term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Morris<T> {
    /// Dynamic viscosity `mu`, Pa s.
    pub dynamic_viscosity: T,
    /// `eta^2 = 0.01 h^2`, m^2: keeps the denominator from vanishing.
    pub eta_squared: T,
}

impl<T: Real> Morris<T> {
    /// `sum_j m_j (mu_i + mu_j) / (rho_i rho_j) (x_ij . grad_i W_ij) / (r_ij^2 + eta^2) v_ij`, m/s^2
    /// (Morris et al. 1997, eq. 22).
    ///
    /// Wall particles are seen with the velocity that the no-slip condition gives them:
    /// `v_ij` grows by `1 + extrapolation(depth)`.
    #[inline(always)]
    pub fn acceleration<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        density: T,
        extrapolation: impl Fn(T) -> T,
        has_walls: bool,
    ) -> [T; D] {
        let mut sums = [LaneSum::zero(); D];
        let volume = near.values(Quantity::Volume);
        let no_depth = [T::zero(); LANES];
        for (k, factor) in near.gradient_factor().iter().enumerate() {
            let depth = if has_walls { &near.values(Quantity::WallDepth)[k] } else { &no_depth };
            let distance_squared = &near.distance_squared()[k];
            let mut weight = [T::zero(); LANES];
            for l in 0..LANES {
                let r2 = distance_squared[l];
                let slope = factor[l] * r2 / (r2 + self.eta_squared);
                weight[l] = slope * volume[k][l] * (T::one() + extrapolation(depth[l]));
            }
            for a in 0..D {
                let velocity = &near.values(Quantity::Velocity(a))[k];
                for l in 0..LANES {
                    sums[a].add(l, weight[l], i.velocity[a] - velocity[l]);
                }
            }
        }
        let scale = T::of(2.0) * self.dynamic_viscosity / density;
        sums.map(|sum| scale * sum.total())
    }
}
