//! Conservation of mass (Holmes et al. 2011, eq. I.1).

use finegrain_framework::Real;

use super::LaneSum;
use crate::neighbourhood::{LANES, Neighbours, Particle, Quantity};

/// `d rho_i / dt = sum_j m_j (v_i - v_j) . grad_i W_ij`, kg/(m^3 s), for equal masses `m`.
#[inline(always)]
pub(crate) fn continuity<T: Real, const D: usize>(
    i: &Particle<T, D>,
    near: &Neighbours<T, D>,
    mass: T,
) -> T {
    let mut sum = LaneSum::zero();
    for a in 0..D {
        let difference = near.difference(a);
        let velocity = near.values(Quantity::Velocity(a));
        for (k, factor) in near.gradient_factor().iter().enumerate() {
            for l in 0..LANES {
                let gradient = factor[l] * difference[k][l];
                sum.add(l, i.velocity[a] - velocity[k][l], gradient);
            }
        }
    }
    mass * sum.total()
}
