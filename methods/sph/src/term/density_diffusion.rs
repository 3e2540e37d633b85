//! Diffusion of density, which takes the noise out of the pressure.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `delta h c sum_j V_j psi_ij . grad_i W_ij`, kg/(m^3 s), with
/// `psi_ij = 2 (rho_j - rho_i) x_ji / r^2` (Molteni & Colagrossi 2009), less what a smooth field
/// gives: `<grad rho>_i + <grad rho>_j` (Antuono et al. 2010), or the hydrostatic differences
/// `2 rho_0 g . x_ji / c^2 x_ji / r^2` (Fourtakas et al. 2019, of first order in the Mach number
/// squared).
///
/// Since `x_ji . grad_i W_ij = -F r^2`, nothing is divided by a distance. Bodies take no part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DensityDiffusion<T> {
    /// `delta h c`, m^2/s.
    pub diffusivity: T,
    /// Whether the gradients of the density are taken off.
    pub knows_gradient: bool,
    /// Gradient of the density at rest, `rho_0 g / c^2`, kg/m^4, that is taken off.
    pub at_rest: [T; 3],
}

impl<T: Real> Term<T> for DensityDiffusion<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let gradient = Quantity::vector(Quantity::DensityGradient, dims);
        gradient
            .filter(|_| self.knows_gradient)
            .chain([Quantity::Volume, Quantity::Density, Quantity::WallDepth])
            .collect()
    }

    fn writes(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::DensityRate]
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
        let (own, density) = (i[Quantity::Density], near.values(Quantity::Density));
        let two = T::of(2.0);
        for (jump, &density) in jump.iter_mut().zip(density) {
            *jump = two * (density - own);
        }
        for a in 0..D {
            let dx = near.difference(a);
            let at_rest = two * self.at_rest[a];
            if self.knows_gradient {
                let gradient = Quantity::DensityGradient(a);
                let (own, others) = (i[gradient], near.values(gradient));
                for ((jump, &gradient), &dx) in jump.iter_mut().zip(others).zip(dx) {
                    *jump = (own + gradient).mul_add(dx, *jump);
                }
            } else {
                for (jump, &dx) in jump.iter_mut().zip(dx) {
                    *jump = at_rest.mul_add(dx, *jump);
                }
            }
        }
        let volume = near.values(Quantity::Volume);
        for ((weight, &factor), &volume) in weight.iter_mut().zip(factor).zip(volume) {
            *weight = factor * volume;
        }
        near.leave_out_bodies(weight);
        let [sum] = T::dots(weight, [&*jump]);
        sums[Quantity::DensityRate] -= self.diffusivity * sum;
    }
}
