//! Laminar viscosity of Morris, Fox & Zhu (1997).

use finegrain_framework::Real;

use super::Work;
use crate::neighbourhood::{Neighbours, Particle, Quantity};
use crate::wall::Extrapolation;

/// Constants of the term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Morris<T> {
    /// Dynamic viscosity `mu`, Pa s.
    pub dynamic_viscosity: T,
    /// `eta^2 = 0.01 h^2`, m^2: keeps the denominator from vanishing.
    pub eta_squared: T,
}

impl<T: Real> Morris<T> {
    /// `sum_j m_j (mu_i + mu_j) / (rho_i rho_j) (x_ij . grad_i W_ij) / (r_ij^2 + eta^2) v_ij`, m/s^2
    /// (Morris et al. 1997, eq. 22).
    ///
    /// Wall particles are seen with the velocity that the no-slip condition gives them.
    #[inline(always)]
    pub fn acceleration<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        density: T,
        no_slip: &Extrapolation<T>,
    ) -> [T; D] {
        let factor = near.gradient_factor();
        let [weight, jump] = work.lanes(factor.len());
        let (volume, distance_squared) = (near.values(Quantity::Volume), near.distance_squared());
        let eta_squared = self.eta_squared;
        for (((weight, &factor), &volume), &r2) in
            weight.iter_mut().zip(factor).zip(volume).zip(distance_squared)
        {
            *weight = factor * volume * (r2 / (r2 + eta_squared));
        }
        no_slip.amplify(weight, near.wall_depth());
        let scale = T::of(2.0) * self.dynamic_viscosity / density;
        let mut acceleration = [T::zero(); D];
        for (a, acceleration) in acceleration.iter_mut().enumerate() {
            for (jump, &v) in jump.iter_mut().zip(near.values(Quantity::Velocity(a))) {
                *jump = i.velocity[a] - v;
            }
            let [sum] = T::dots(weight, [&*jump]);
            *acceleration = scale * sum;
        }
        acceleration
    }
}
