//! Artificial thermal conductivity of a gas.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `sum_j m_j alpha_u v_u (e_i - e_j) / rho_ij r F_ij`, W/kg, with the speed
/// `v_u = (|p_i - p_j| / rho_ij)^(1/2)`, the mean `rho_ij` of the densities and the mean `F_ij` of
/// the gradients with `h_i` and `h_j` (Price 2008, eqs. 25 and 28).
///
/// Heat that a particle gives its neighbour gets. It flows where the pressure jumps, and so makes
/// the pressure continuous where energy and density jump.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Conductivity<T> {
    pub mass: T,
    /// `alpha_u`.
    pub strength: T,
}

impl<T: Real> Term<T> for Conductivity<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::Volume, Quantity::Pressure, Quantity::Energy, Quantity::SmoothingLength]
    }

    fn writes(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::EnergyRate]
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
        let (own, energy) = (i[Quantity::Energy], near.values(Quantity::Energy));
        for ((jump, &energy), &r2) in jump.iter_mut().zip(energy).zip(near.distance_squared()) {
            *jump = (own - energy) * r2.sqrt();
        }
        // 1 / rho_ij = 2 / m V_i V_j / (V_i + V_j)
        let (own, volume) = (i[Quantity::Volume], near.values(Quantity::Volume));
        let (own_pressure, pressure) = (i[Quantity::Pressure], near.values(Quantity::Pressure));
        let two_over_mass = T::of(2.0) / self.mass;
        let lanes = weight.iter_mut().zip(factor).zip(factor_j).zip(volume).zip(pressure);
        for ((((weight, &factor), &factor_j), &volume), &pressure) in lanes {
            let reduced = own * volume / (own + volume);
            let speed = ((own_pressure - pressure).abs() * two_over_mass * reduced).sqrt();
            *weight = speed * reduced * (factor + factor_j);
        }
        let [sum] = T::dots(weight, [&*jump]);
        sums[Quantity::EnergyRate] += self.strength * sum;
    }
}
