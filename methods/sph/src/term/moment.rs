//! Sums that tell how the neighbours of a particle lie around it, and how the density differs
//! among them.

use std::marker::PhantomData;

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values, component};

/// `M_i = sum_j V_j (x_j - x_i) (grad_i W_ij)^T` (Bonet & Lok 1999, eq. 46, its inverse being the
/// correction; Marrone et al. 2010): the unit matrix where neighbours lie evenly all around, with
/// a smaller eigenvalue towards a free surface.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct MomentMatrix<T>(PhantomData<T>);

impl<T: Real> Term<T> for MomentMatrix<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::Volume]
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::symmetric(Quantity::Moment, dims).collect()
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        _: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let factor = near.gradient_factor();
        let [weight, along] = work.lanes(factor.len());
        let volume = near.values(Quantity::Volume);
        for ((weight, &factor), &volume) in weight.iter_mut().zip(factor).zip(volume) {
            *weight = factor * volume;
        }
        for a in 0..D {
            for ((along, &weight), &dx) in along.iter_mut().zip(&*weight).zip(near.difference(a)) {
                *along = weight * dx;
            }
            let row = near.sum_differences(along);
            for b in 0..=a {
                sums[Quantity::Moment(component(a, b))] -= row[b];
            }
        }
    }
}

/// `sum_j V_j (rho_j - rho_i) grad_i W_ij`, kg/m^4: with the inverse of the moment matrix the
/// gradient of the density, exact where that is linear (Randles & Libersky 1996).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DensitySlope<T>(PhantomData<T>);

impl<T: Real> Term<T> for DensitySlope<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::Volume, Quantity::Density]
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::DensitySlope, dims).collect()
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
        let (own, density) = (i[Quantity::Density], near.values(Quantity::Density));
        let volume = near.values(Quantity::Volume);
        let lanes = weight.iter_mut().zip(factor).zip(volume).zip(density);
        for (((weight, &factor), &volume), &density) in lanes {
            *weight = factor * volume * (density - own);
        }
        sums.add(Quantity::DensitySlope, near.sum_differences(weight));
    }
}
