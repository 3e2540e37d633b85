//! Conservation of mass (Holmes et al. 2011, eq. I.1).

use finegrain_framework::Real;

use super::Work;
use crate::neighbourhood::{Neighbours, Particle, Quantity};

/// `d rho_i / dt = sum_j m_j (v_i - v_j) . grad_i W_ij`, kg/(m^3 s), for equal masses `m`.
#[inline(always)]
pub(crate) fn continuity<T: Real, const D: usize>(
    i: &Particle<T, D>,
    near: &Neighbours<T, D>,
    work: &mut Work<T>,
    mass: T,
) -> T {
    let factor = near.gradient_factor();
    let [jump, _] = work.lanes(factor.len());
    jump.fill(T::zero());
    for a in 0..D {
        let (v, dx) = (near.values(Quantity::Velocity(a)), near.difference(a));
        for ((jump, &v), &dx) in jump.iter_mut().zip(v).zip(dx) {
            *jump = (i.velocity[a] - v).mul_add(dx, *jump);
        }
    }
    let [sum] = T::dots(factor, [&*jump]);
    mass * sum
}
