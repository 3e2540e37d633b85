//! Conservation of energy (Holmes et al. 2011, eq. I.3).

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values, component};

/// `d e_i / dt = 1/2 sum_j m_j (p_i / rho_i^2 + p_j / rho_j^2) v_ij . grad_i W_ij
///  + mu / (2 rho_i) epsilon_i : epsilon_i`, W/kg, for equal masses `m`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Energy<T> {
    pub mass: T,
    /// Dynamic viscosity `mu`, Pa s; 0 without viscosity.
    pub dynamic_viscosity: T,
}

impl<T: Real> Energy<T> {
    /// Whether there is heating by shear.
    fn is_viscous(&self) -> bool {
        self.dynamic_viscosity != T::zero()
    }
}

impl<T: Real> Term<T> for Energy<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let velocity = Quantity::vector(Quantity::Velocity, dims);
        let stress = Quantity::symmetric(Quantity::StressTerm, dims).filter(|_| self.is_viscous());
        velocity.chain(stress).chain([Quantity::Volume, Quantity::PressureTerm]).collect()
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
        let factor = near.gradient_factor();
        let [weight, jump] = work.lanes(factor.len());
        let (own, others) = (i[Quantity::PressureTerm], near.values(Quantity::PressureTerm));
        for ((weight, &factor), &p) in weight.iter_mut().zip(factor).zip(others) {
            *weight = factor * (own + p);
        }
        let mut sum = T::zero();
        for a in 0..D {
            let (v, dx) = (near.values(Quantity::Velocity(a)), near.difference(a));
            for ((jump, &v), &dx) in jump.iter_mut().zip(v).zip(dx) {
                *jump = (i[Quantity::Velocity(a)] - v) * dx;
            }
            let [along] = T::dots(weight, [&*jump]);
            sum += along;
        }
        let half = T::of(0.5);
        sums[Quantity::EnergyRate] += half * self.mass * sum;
        if !self.is_viscous() {
            return;
        }
        // stress_term = mu epsilon / rho^2.
        let mut contraction = T::zero();
        for a in 0..D {
            for b in 0..D {
                let stress = i[Quantity::StressTerm(component(a, b))];
                contraction += stress * stress;
            }
        }
        let density = self.mass / i[Quantity::Volume];
        let rho3 = density * density * density;
        sums[Quantity::EnergyRate] += half * contraction * rho3 / self.dynamic_viscosity;
    }
}
