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
        let factor = near.gradient_factor();
        let [weight, _] = work.lanes(factor.len());
        let (own, others) = (i[Quantity::PressureTerm], near.values(Quantity::PressureTerm));
        for ((weight, &factor), &p) in weight.iter_mut().zip(factor).zip(others) {
            *weight = factor * (own + p);
        }
        let mut acceleration = near.sum_differences(weight);
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
        let factor = near.gradient_factor();
        let [weight, _] = work.lanes(factor.len());
        let mut acceleration = [T::zero(); D];
        for a in 0..D {
            for b in 0..=a {
                let c = component(a, b);
                let own = i[Quantity::StressTerm(c)];
                let stress = near.values(Quantity::StressTerm(c));
                match near.wall_depth() {
                    Some(depth) if i.is_wall() => {
                        let lanes = weight.iter_mut().zip(factor).zip(stress).zip(depth);
                        for (((weight, &factor), &stress), &depth) in lanes {
                            let seen = if depth > T::zero() { T::zero() } else { stress };
                            *weight = factor * (seen + seen);
                        }
                    }
                    Some(depth) => {
                        let lanes = weight.iter_mut().zip(factor).zip(stress).zip(depth);
                        for (((weight, &factor), &stress), &depth) in lanes {
                            let seen = if depth > T::zero() { own } else { stress };
                            *weight = factor * (own + seen);
                        }
                    }
                    None => {
                        let lanes = weight.iter_mut().zip(factor).zip(stress);
                        for ((weight, &factor), &stress) in lanes {
                            *weight = factor * (own + stress);
                        }
                    }
                }
                let along = T::dots(weight, [near.difference(a), near.difference(b)]);
                acceleration[a] += self.mass * along[1];
                if a != b {
                    acceleration[b] += self.mass * along[0];
                }
            }
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}
