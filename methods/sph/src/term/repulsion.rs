//! Virtual repulsive particles of Monaghan (1994).

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `sum_j D ((r0 / r)^4 - (r0 / r)^2) x_ij / r^2`, m/s^2, over the particles `j` of bodies nearer
/// than the spacing `r0` (Monaghan 1994, section 4.3, with p1 = 4 and p2 = 2).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Repulsion<T> {
    /// `D`, m^2/s^2.
    pub strength: T,
    /// `r0`, m.
    pub spacing: T,
}

impl<T: Real> Term<T> for Repulsion<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::WallDepth]
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Acceleration, dims).collect()
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        _: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let Some(depth) = near.wall_depth() else { return };
        let [weight, _] = work.lanes(depth.len());
        let spacing_squared = self.spacing * self.spacing;
        // Padding has a gradient factor of 0, and so have particles at the edge of the support.
        let lanes = weight.iter_mut().zip(depth).zip(near.gradient_factor());
        for (((weight, &depth), &factor), &r2) in lanes.zip(near.distance_squared()) {
            let ratio = spacing_squared / r2;
            let acts = depth > T::zero() && factor != T::zero() && ratio > T::one();
            *weight = if acts { ratio * (ratio - T::one()) / r2 } else { T::zero() };
        }
        let mut acceleration = near.sum_differences(weight);
        for a in 0..D {
            acceleration[a] *= self.strength;
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}
