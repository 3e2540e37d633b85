//! Conservation of momentum (Holmes et al. 2011, eq. I.2): pressure gradient and divergence of
//! the viscous stress.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values, component};

/// `-sum_j m_j (p_i / rho_i^2 + p_j / rho_j^2) grad_i W_ij`, m/s^2, for equal masses `m`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PressureGradient<T> {
    pub mass: T,
}

impl<T: Real> Term<T> for PressureGradient<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::PressureTerm]
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Acceleration, dims).collect()
    }

    fn uses_gradient(&self) -> bool {
        true
    }

    fn pushes_bodies(&self) -> bool {
        true
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        _: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let (own, others) = (i[Quantity::PressureTerm], near.values(Quantity::PressureTerm));
        let mut acceleration = T::raised_dots(own, others, near.gradients());
        for a in 0..D {
            acceleration[a] *= -self.mass;
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}

/// `sum_j m_j (mu epsilon_i / rho_i^2 + mu epsilon_j / rho_j^2) . grad_i W_ij`, m/s^2, for equal
/// masses `m`.
///
/// Across the surface of a body the stress is taken to be continuous: a wall particle is seen
/// with the fluid particle's own stress, since its own, from sums that reach into fluid on one
/// side only, says nothing about the flow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StressDivergence<T> {
    pub mass: T,
}

impl<T: Real> Term<T> for StressDivergence<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        Quantity::symmetric(Quantity::StressTerm, dims).chain([Quantity::WallDepth]).collect()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Acceleration, dims).collect()
    }

    fn uses_gradient(&self) -> bool {
        true
    }

    fn pushes_bodies(&self) -> bool {
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
        let gradient = near.gradients();
        let mut acceleration = [T::zero(); D];
        let Some(depth) = near.wall_depth() else {
            for a in 0..D {
                let (mut own, mut stress) = ([T::zero(); D], [&[][..]; D]);
                for b in 0..D {
                    own[b] = i[Quantity::StressTerm(component(a, b))];
                    stress[b] = near.values(Quantity::StressTerm(component(a, b)));
                }
                acceleration[a] = self.mass * T::raised_contraction(own, stress, gradient);
            }
            sums.add(Quantity::Acceleration, acceleration);
            return;
        };
        let [seen, _] = work.lanes(depth.len());
        for a in 0..D {
            for b in 0..=a {
                let stress = near.values(Quantity::StressTerm(component(a, b)));
                let lanes = seen.iter_mut().zip(stress).zip(depth);
                let own = if i.is_wall() {
                    for ((seen, &stress), &depth) in lanes {
                        *seen = if depth > T::zero() { T::zero() } else { stress + stress };
                    }
                    T::zero()
                } else {
                    let own = i[Quantity::StressTerm(component(a, b))];
                    for ((seen, &stress), &depth) in lanes {
                        *seen = if depth > T::zero() { own } else { stress };
                    }
                    own
                };
                let along = T::raised_dots(own, seen, [gradient[a], gradient[b]]);
                acceleration[a] += self.mass * along[1];
                if a != b {
                    acceleration[b] += self.mass * along[0];
                }
            }
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}
