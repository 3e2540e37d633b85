//! Pressure of a gas with smoothing lengths that follow the density.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `-sum_j m_j (p_i / (Omega_i rho_i^2) grad_i W(h_i) + p_j / (Omega_j rho_j^2) grad_i W(h_j))`, m/s^2,
/// and the work `p_i / (Omega_i rho_i^2) sum_j m_j v_ij . grad_i W(h_i)`, W/kg, for equal masses
/// `m` (Springel & Hernquist 2002, eq. 10; Price 2012, eqs. 34 and 35).
///
/// What pressure takes from the energy of motion it gives to the internal energy, exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GasPressure<T> {
    pub mass: T,
}

impl<T: Real> Term<T> for GasPressure<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let velocity = Quantity::vector(Quantity::Velocity, dims);
        velocity.chain([Quantity::PressureTerm, Quantity::SmoothingLength]).collect()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Acceleration, dims).chain([Quantity::EnergyRate]).collect()
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let (factor, factor_j) = (near.gradient_factor(), near.gradient_factor_of_others());
        let [weight, jump] = work.lanes(factor.len());
        let (own, others) = (i[Quantity::PressureTerm], near.values(Quantity::PressureTerm));
        let lanes = weight.iter_mut().zip(factor).zip(factor_j).zip(others);
        for (((weight, &factor), &factor_j), &p) in lanes {
            *weight = own * factor + p * factor_j;
        }
        let mut acceleration = near.sum_differences(weight);
        for a in 0..D {
            acceleration[a] *= -self.mass;
        }
        sums.add(Quantity::Acceleration, acceleration);
        near.velocity_jump(i, jump);
        let [along] = T::dots(factor, [&*jump]);
        sums[Quantity::EnergyRate] += self.mass * own * along;
    }
}
