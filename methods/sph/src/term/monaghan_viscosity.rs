//! Laminar viscosity along the line between two particles.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};
use crate::wall::VelocityInBodies;

/// `2 (d + 2) / rho_i sum_j V_j mu (v_ij . x_ij) / (r_ij^2 + eta^2) grad_i W_ij`, m/s^2, in `d`
/// dimensions (Cleary & Monaghan 1999; Monaghan 2005; the factor by the integrals of Espanol &
/// Revenga 2003).
///
/// Two particles act on each other along the line between them, so that angular momentum is
/// conserved as momentum is. It stands for `nu (laplacian v + 2 grad div v)`: that of Newton in a
/// flow without divergence. On a lattice it is weaker, by 18 % with `h` equal to the spacing: nearest
/// neighbours straight along or across a shear count for nothing.
///
/// Wall particles are seen with the velocity that the no-slip condition gives them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MonaghanViscosity<T> {
    pub mass: T,
    /// Dynamic viscosity `mu`, Pa s.
    pub dynamic_viscosity: T,
    /// `eta^2 = 0.01 h^2`, m^2: keeps the denominator from vanishing.
    pub eta_squared: T,
    /// Velocity that is seen in bodies, besides that with which particles move.
    pub in_bodies: Option<VelocityInBodies>,
}

impl<T: Real> Term<T> for MonaghanViscosity<T> {
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
        let [weight, approach] = work.lanes(factor.len());
        near.velocity_jump(i, approach);
        if let Some(in_bodies) = self.in_bodies {
            for a in 0..D {
                let (own, dx) = (i[in_bodies.component(a)], near.difference(a));
                let v = near.values(in_bodies.component(a));
                for ((approach, &v), &dx) in approach.iter_mut().zip(v).zip(dx) {
                    *approach = (own - v).mul_add(dx, *approach);
                }
            }
        }
        let (volume, distance_squared) = (near.values(Quantity::Volume), near.distance_squared());
        let eta_squared = self.eta_squared;
        let lanes = weight.iter_mut().zip(factor).zip(volume).zip(distance_squared);
        for ((((weight, &factor), &volume), &r2), &approach) in lanes.zip(&*approach) {
            *weight = factor * volume * (approach / (r2 + eta_squared));
        }
        i.no_slip.amplify(weight, near.wall_depth());
        let density = self.mass / i[Quantity::Volume];
        let scale = T::of(2.0 * (D as f64 + 2.0)) * self.dynamic_viscosity / density;
        let mut acceleration = near.sum_differences(weight);
        for a in 0..D {
            acceleration[a] *= scale;
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}
