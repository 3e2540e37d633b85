//! Pressure gradient and viscosity of Hu & Adams, with averages over pairs that suit particles
//! whose volume is a sum (Adami, Hu & Adams 2012, eqs. 6 to 9).

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};
use crate::wall::VelocityInBodies;

/// `-1 / m sum_j (V_i^2 + V_j^2) (rho_j p_i + rho_i p_j) / (rho_i + rho_j) grad_i W_ij`, m/s^2, for
/// equal masses `m`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WeightedPressureGradient<T> {
    pub mass: T,
}

impl<T: Real> Term<T> for WeightedPressureGradient<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::Volume, Quantity::Pressure]
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
        let (own, volumes) = (i[Quantity::Volume], near.values(Quantity::Volume));
        let (pressure, pressures) = (i[Quantity::Pressure], near.values(Quantity::Pressure));
        for (((weight, &factor), &volume), &p) in
            weight.iter_mut().zip(factor).zip(volumes).zip(pressures)
        {
            // For equal masses densities weigh as volumes do, crosswise.
            let mean = (own * pressure + volume * p) / (own + volume);
            *weight = factor * volume.mul_add(volume, own * own) * mean;
        }
        let mut acceleration = near.sum_differences(weight);
        for a in 0..D {
            acceleration[a] /= -self.mass;
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}

/// `1 / m sum_j mu (V_i^2 + V_j^2) F_ij v_ij`, m/s^2, for equal masses `m`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WeightedViscosity<T> {
    pub mass: T,
    /// Dynamic viscosity `mu`, Pa s.
    pub dynamic_viscosity: T,
    /// Velocity that is seen in bodies, besides that with which particles move.
    pub in_bodies: Option<VelocityInBodies>,
}

impl<T: Real> Term<T> for WeightedViscosity<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        VelocityInBodies::reads(self.in_bodies, dims)
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Acceleration, dims).collect()
    }

    fn sees_velocity_in_bodies(&self) -> bool {
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
        let factor = near.gradient_factor();
        let [weight, jump] = work.lanes(factor.len());
        let (own, volumes) = (i[Quantity::Volume], near.values(Quantity::Volume));
        for ((weight, &factor), &volume) in weight.iter_mut().zip(factor).zip(volumes) {
            *weight = factor * volume.mul_add(volume, own * own);
        }
        i.no_slip.amplify(weight, near.wall_depth());
        let scale = self.dynamic_viscosity / self.mass;
        for a in 0..D {
            near.friction_jump(i, a, self.in_bodies, jump);
            let [sum] = T::dots(weight, [&*jump]);
            sums[Quantity::Acceleration(a)] += scale * sum;
        }
    }
}
