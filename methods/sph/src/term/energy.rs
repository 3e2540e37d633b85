//! Conservation of energy (Holmes et al. 2011, eq. I.3).

use finegrain_framework::Real;

use super::LaneSum;
use super::momentum::component;
use crate::neighbourhood::{LANES, Neighbours, Particle, Quantity};

/// Constants of the term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Energy<T> {
    /// Dynamic viscosity `mu`, Pa s; 0 without viscosity.
    pub dynamic_viscosity: T,
}

impl<T: Real> Energy<T> {
    /// `d e_i / dt = 1/2 sum_j m_j (p_i / rho_i^2 + p_j / rho_j^2) v_ij . grad_i W_ij
    ///  + mu / (2 rho_i) epsilon_i : epsilon_i`, W/kg, for equal masses `m`.
    #[inline(always)]
    pub fn rate<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        mass: T,
        density: T,
    ) -> T {
        let pressure_term = near.values(Quantity::PressureTerm);
        let mut sum = LaneSum::zero();
        for a in 0..D {
            let difference = near.difference(a);
            let velocity = near.values(Quantity::Velocity(a));
            for (k, factor) in near.gradient_factor().iter().enumerate() {
                for l in 0..LANES {
                    let weight = factor[l] * (i.pressure_term + pressure_term[k][l]);
                    let jump = i.velocity[a] - velocity[k][l];
                    sum.add(l, weight * jump, difference[k][l]);
                }
            }
        }
        let work = T::of(0.5) * mass * sum.total();
        if self.dynamic_viscosity == T::zero() {
            return work;
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
        work + contraction * rho3 / (T::of(2.0) * self.dynamic_viscosity)
    }
}
