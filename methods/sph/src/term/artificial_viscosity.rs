//! Artificial viscosity of Monaghan (1992).

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `-sum_j m_j Pi_ij grad_i W_ij`, m/s^2, with `Pi_ij = (-alpha c mu_ij + beta mu_ij^2) / rho_ij` for
/// particles that approach each other and 0 for others,
/// `mu_ij = h v_ij . x_ij / (r^2 + 0.01 h^2)`, and the mean `rho_ij` of the densities (Monaghan
/// 1992, section 4.1).
///
/// Friction with bodies is none of its business: they take no part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArtificialViscosity<T> {
    pub mass: T,
    /// `alpha c`, m/s.
    pub linear: T,
    /// `beta`.
    pub quadratic: T,
    /// Smoothing length `h`, m.
    pub smoothing_length: T,
}

impl<T: Real> Term<T> for ArtificialViscosity<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let velocity = Quantity::vector(Quantity::Velocity, dims);
        velocity.chain([Quantity::Density, Quantity::WallDepth]).collect()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Acceleration, dims).collect()
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
        let [weight, approach] = work.lanes(factor.len());
        near.velocity_jump(i, approach);
        let (own, density) = (i[Quantity::Density], near.values(Quantity::Density));
        let Self { linear, quadratic, smoothing_length: h, .. } = *self;
        let eta_squared = T::of(0.01) * h * h;
        let lanes = weight.iter_mut().zip(factor).zip(&*approach).zip(density);
        for ((((weight, &factor), &approach), &density), &r2) in lanes.zip(near.distance_squared())
        {
            let mu = h * approach.min(T::zero()) / (r2 + eta_squared);
            *weight = factor * mu * (quadratic * mu - linear) / (own + density);
        }
        near.leave_out_bodies(weight);
        let mut acceleration = near.sum_differences(weight);
        for a in 0..D {
            // Twice, for the mean density is half of the sum.
            acceleration[a] *= -T::of(2.0) * self.mass;
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}
