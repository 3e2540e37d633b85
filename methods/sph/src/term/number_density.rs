//! Number density, from which volume and density follow where density is a sum and not a state.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `sum_j W_ij`, 1/m^3 (1/m^2 in 2-D): one over the volume of the particle (Hu & Adams 2006, J.
/// Comput. Phys. 213). Particles of bodies count as those of the fluid do.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NumberDensity;

impl<T: Real> Term<T> for NumberDensity {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        Vec::new()
    }

    fn writes(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::NumberDensity]
    }

    fn uses_kernel(&self) -> bool {
        true
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        _: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let kernel = near.kernel();
        let [one, _] = work.lanes(kernel.len());
        one.fill(T::one());
        let [sum] = T::dots(kernel, [&*one]);
        sums[Quantity::NumberDensity] += sum;
    }
}
