//! Conservation of momentum (Holmes et al. 2011, eq. I.2): pressure gradient and divergence of
//! the viscous stress.

use finegrain_framework::Real;

use super::LaneSum;
use crate::fields::symmetric;
use crate::neighbourhood::{LANES, Neighbours, Particle, Quantity};

/// `-sum_j m_j (p_i / rho_i^2 + p_j / rho_j^2) grad_i W_ij`, m/s^2, for equal masses `m`.
#[inline(always)]
pub(crate) fn pressure_gradient<T: Real, const D: usize>(
    i: &Particle<T, D>,
    near: &Neighbours<T, D>,
    mass: T,
) -> [T; D] {
    let pressure_term = near.values(Quantity::PressureTerm);
    let mut sums = [LaneSum::zero(); D];
    for (k, factor) in near.gradient_factor().iter().enumerate() {
        let mut weight = [T::zero(); LANES];
        for l in 0..LANES {
            weight[l] = factor[l] * (i.pressure_term + pressure_term[k][l]);
        }
        for a in 0..D {
            let difference = &near.difference(a)[k];
            for l in 0..LANES {
                sums[a].add(l, weight[l], difference[l]);
            }
        }
    }
    sums.map(|sum| -mass * sum.total())
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
    mass: T,
    has_walls: bool,
) -> [T; D] {
    let mut sums = [LaneSum::zero(); D];
    let no_depth = [T::zero(); LANES];
    for (k, factor) in near.gradient_factor().iter().enumerate() {
        let depth = if has_walls { &near.values(Quantity::WallDepth)[k] } else { &no_depth };
        let mut stress = [[T::zero(); LANES]; 6];
        for c in 0..symmetric(D) {
            let seen = &near.values(Quantity::StressTerm(c))[k];
            for l in 0..LANES {
                let own = i.stress_term[c];
                let other = if depth[l] > T::zero() { own } else { seen[l] };
                stress[c][l] = factor[l] * (own + other);
            }
        }
        for a in 0..D {
            for b in 0..D {
                let difference = &near.difference(b)[k];
                for l in 0..LANES {
                    sums[a].add(l, stress[component(a, b)][l], difference[l]);
                }
            }
        }
    }
    sums.map(|sum| mass * sum.total())
}
