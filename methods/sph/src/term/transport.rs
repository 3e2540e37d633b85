//! Transport velocity (Adami, Hu & Adams 2013): particles drift towards an even distribution
//! beside the flow, and carry the momentum with them that this moves.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// Velocity of the drift, `-tau p_b / rho_0 V_0 sum_j grad_i W_ij`, m/s.
///
/// What a background pressure `p_b` does to the velocity in half a step that lasts `tau` (eqs. 8
/// and 13), with the reference volume in place of each particle's own, which changes the drift by
/// as much as the density varies. `tau` is fixed, and not the present step, so that the flow does
/// not depend on the time step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drift<T> {
    /// `tau p_b / rho_0 V_0`, m^4/s (m^5/s in 3-D).
    pub strength: T,
}

impl<T: Real> Term<T> for Drift<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        Vec::new()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Drift, dims).collect()
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        _: &Particle<T, D>,
        near: &Neighbours<T, D>,
        _: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let mut drift = near.sum_differences(near.gradient_factor());
        for a in 0..D {
            drift[a] *= -self.strength;
        }
        sums.add(Quantity::Drift, drift);
    }
}

/// `1 / m sum_j (V_i^2 + V_j^2) (A_i + A_j) / 2 . grad_i W_ij`, m/s^2, with `A = rho v w` of the
/// velocity `v` and that of the drift `w` (eqs. 4 and 8), over the fluid only: what the drift moves
/// of the momentum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DriftStress;

impl<T: Real> Term<T> for DriftStress {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let velocity = Quantity::vector(Quantity::Velocity, dims);
        let drift = Quantity::vector(Quantity::Drift, dims);
        velocity.chain(drift).chain([Quantity::Volume, Quantity::WallDepth]).collect()
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
        let [weight, along] = work.lanes(factor.len());
        let (own, volume) = (i[Quantity::Volume], near.values(Quantity::Volume));
        let half = T::of(0.5);
        // The density is the mass over the volume: the mass cancels.
        for ((weight, &factor), &volume) in weight.iter_mut().zip(factor).zip(volume) {
            *weight = half * factor * volume.mul_add(volume, own * own);
        }
        near.leave_out_bodies(weight);
        let direction = near.sum_differences(weight);
        let mut own_along = T::zero();
        for a in 0..D {
            own_along += i[Quantity::Drift(a)] * direction[a];
        }
        own_along /= own;
        along.fill(T::zero());
        for a in 0..D {
            let (drift, dx) = (near.values(Quantity::Drift(a)), near.difference(a));
            for ((along, &drift), &dx) in along.iter_mut().zip(drift).zip(dx) {
                *along = drift.mul_add(dx, *along);
            }
        }
        for ((along, &weight), &volume) in along.iter_mut().zip(&*weight).zip(volume) {
            *along *= weight / volume;
        }
        for a in 0..D {
            let [others] = T::dots(along, [near.values(Quantity::Velocity(a))]);
            sums[Quantity::Acceleration(a)] += own_along * i[Quantity::Velocity(a)] + others;
        }
    }
}
