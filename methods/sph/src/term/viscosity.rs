//! Laminar viscosity of Morris, Fox & Zhu (1997).

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};
use crate::wall::VelocityInBodies;

/// `sum_j m_j (mu_i + mu_j) / (rho_i rho_j) (x_ij . grad_i W_ij) / (r_ij^2 + eta^2) v_ij`, m/s^2
/// (Morris et al. 1997, eq. 22).
///
/// Wall particles are seen with the velocity that the no-slip condition gives them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MorrisViscosity<T> {
    pub mass: T,
    /// Dynamic viscosity `mu`, Pa s.
    pub dynamic_viscosity: T,
    /// `eta^2 = 0.01 h^2`, m^2: keeps the denominator from vanishing.
    pub eta_squared: T,
    /// Velocity that is seen in bodies, besides that with which particles move.
    pub in_bodies: Option<VelocityInBodies>,
}

impl<T: Real> Term<T> for MorrisViscosity<T> {
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
        let (volume, distance_squared) = (near.values(Quantity::Volume), near.distance_squared());
        let eta_squared = self.eta_squared;
        for (((weight, &factor), &volume), &r2) in
            weight.iter_mut().zip(factor).zip(volume).zip(distance_squared)
        {
            *weight = factor * volume * (r2 / (r2 + eta_squared));
        }
        i.no_slip.amplify(weight, near.wall_depth());
        let density = self.mass / i[Quantity::Volume];
        let scale = T::of(2.0) * self.dynamic_viscosity / density;
        for a in 0..D {
            near.friction_jump(i, a, self.in_bodies, jump);
            let [sum] = T::dots(weight, [&*jump]);
            sums[Quantity::Acceleration(a)] += scale * sum;
        }
    }
}
