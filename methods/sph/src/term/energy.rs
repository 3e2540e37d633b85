//! Conservation of energy (Holmes et al. 2011, eq. I.3).

use finegrain_framework::Real;

use super::Work;
use super::momentum::component;
use crate::neighbourhood::{Neighbours, Particle, Quantity};

/// Constants of the term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Energy<T> {
    /// Dynamic viscosity `mu`, Pa s; 0 without viscosity.
    pub dynamic_viscosity: T,
}

impl<T: Real> Energy<T> {
    /// Whether there is heating by shear.
    pub fn is_viscous(&self) -> bool {
        self.dynamic_viscosity != T::zero()
    }

    /// `d e_i / dt = 1/2 sum_j m_j (p_i / rho_i^2 + p_j / rho_j^2) v_ij . grad_i W_ij
    ///  + mu / (2 rho_i) epsilon_i : epsilon_i`, W/kg, for equal masses `m`.
    #[inline(always)]
    pub fn rate<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        mass: T,
        density: T,
    ) -> T {
        let factor = near.gradient_factor();
        let [weight, jump] = work.lanes(factor.len());
        let pressure_term = near.values(Quantity::PressureTerm);
        for ((weight, &factor), &p) in weight.iter_mut().zip(factor).zip(pressure_term) {
            *weight = factor * (i.pressure_term + p);
        }
        let mut sum = T::zero();
        for a in 0..D {
            let (v, dx) = (near.values(Quantity::Velocity(a)), near.difference(a));
            for ((jump, &v), &dx) in jump.iter_mut().zip(v).zip(dx) {
                *jump = (i.velocity[a] - v) * dx;
            }
            let [along] = T::dots(weight, [&*jump]);
            sum += along;
        }
        let half = T::of(0.5);
        let compression = half * mass * sum;
        if !self.is_viscous() {
            return compression;
        }
        // stress_term = mu epsilon / rho^2.
        let mut contraction = T::zero();
        for a in 0..D {
            for b in 0..D {
                let stress = i.stress_term[component(a, b)];
                contraction += stress * stress;
            }
        }
        let rho3 = density * density * density;
        compression + half * contraction * rho3 / self.dynamic_viscosity
    }
}
