//! Artificial pressure of Monaghan (2000) against the tensile instability.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `-sum_j m_j (R_i + R_j) f_ij^4 grad_i W_ij`, m/s^2, with `f_ij = W_ij / W(dx)` and
/// `R = epsilon |p| / rho^2` where the pressure is negative, 0 elsewhere (Monaghan 2000, section 3,
/// with n = 4; without the small part for positive pressures).
#[derive(Clone, Copy, Debug)]
pub(crate) struct ArtificialPressure<T> {
    pub mass: T,
    /// `epsilon`.
    pub strength: T,
    /// `1 / W(dx)` with the spacing `dx`.
    pub inverse_kernel: T,
}

impl<T: Real> Term<T> for ArtificialPressure<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::PressureTerm]
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Acceleration, dims).collect()
    }

    fn uses_kernel(&self) -> bool {
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
        let [weight, _] = work.lanes(factor.len());
        let (own, others) = (i[Quantity::PressureTerm], near.values(Quantity::PressureTerm));
        let own = own.min(T::zero());
        let inverse_kernel = self.inverse_kernel;
        let lanes = weight.iter_mut().zip(factor).zip(others).zip(near.kernel());
        for (((weight, &factor), &p), &kernel) in lanes {
            let f = kernel * inverse_kernel;
            *weight = factor * (own + p.min(T::zero())) * (f * f) * (f * f);
        }
        let mut acceleration = near.sum_differences(weight);
        for a in 0..D {
            acceleration[a] *= self.mass * self.strength;
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}
