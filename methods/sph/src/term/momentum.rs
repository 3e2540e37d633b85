//! Conservation of momentum (Holmes et al. 2011, eq. I.2): pressure gradient and divergence of
//! the viscous stress.

use finegrain_framework::Real;

use super::Work;
use crate::neighbourhood::{Neighbours, Particle, Quantity};

/// `-sum_j m_j (p_i / rho_i^2 + p_j / rho_j^2) grad_i W_ij`, m/s^2, for equal masses `m`.
#[inline(always)]
pub(crate) fn pressure_gradient<T: Real, const D: usize>(
    i: &Particle<T, D>,
    near: &Neighbours<T, D>,
    work: &mut Work<T>,
    mass: T,
) -> [T; D] {
    let factor = near.gradient_factor();
    let [weight, _] = work.lanes(factor.len());
    let pressure_term = near.values(Quantity::PressureTerm);
    for ((weight, &factor), &p) in weight.iter_mut().zip(factor).zip(pressure_term) {
        *weight = factor * (i.pressure_term + p);
    }
    let mut acceleration = near.sum_differences(weight);
    for a in 0..D {
        acceleration[a] *= -mass;
    }
    acceleration
}

/// Place of component (a, b) of a symmetric tensor in the order xx, xy, yy, xz, yz, zz.
#[inline(always)]
pub(crate) const fn component(a: usize, b: usize) -> usize {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    high * (high + 1) / 2 + low
}

/// `sum_j m_j (mu epsilon_i / rho_i^2 + mu epsilon_j / rho_j^2) . grad_i W_ij`, m/s^2, for equal
/// masses `m`.
///
/// Across the surface of a body the stress is taken to be continuous: a wall particle is seen
/// with the fluid particle's own stress, since its own, from sums that reach into fluid on one
/// side only, says nothing about the flow.
#[inline(always)]
pub(crate) fn stress_divergence<T: Real, const D: usize>(
    i: &Particle<T, D>,
    near: &Neighbours<T, D>,
    work: &mut Work<T>,
    mass: T,
) -> [T; D] {
    let factor = near.gradient_factor();
    let [weight, _] = work.lanes(factor.len());
    let mut acceleration = [T::zero(); D];
    for a in 0..D {
        for b in 0..=a {
            let c = component(a, b);
            let own = i.stress_term[c];
            let stress = near.values(Quantity::StressTerm(c));
            match near.wall_depth() {
                Some(depth) => {
                    let lanes = weight.iter_mut().zip(factor).zip(stress).zip(depth);
                    for (((weight, &factor), &stress), &depth) in lanes {
                        let seen = if depth > T::zero() { own } else { stress };
                        *weight = factor * (own + seen);
                    }
                }
                None => {
                    for ((weight, &factor), &stress) in weight.iter_mut().zip(factor).zip(stress) {
                        *weight = factor * (own + stress);
                    }
                }
            }
            let sums = T::dots(weight, [near.difference(a), near.difference(b)]);
            acceleration[a] += mass * sums[1];
            if a != b {
                acceleration[b] += mass * sums[0];
            }
        }
    }
    acceleration
}
