//! Conservation of mass (Holmes et al. 2011, eq. I.1).

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `d rho_i / dt = sum_j m_j (v_i - v_j) . grad_i W_ij`, kg/(m^3 s), for equal masses `m`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Continuity<T> {
    pub mass: T,
}

impl<T: Real> Term<T> for Continuity<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Velocity, dims).collect()
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
        let [jump, _] = work.lanes(factor.len());
        near.velocity_jump(i, jump);
        let [sum] = T::dots(factor, [&*jump]);
        sums[Quantity::DensityRate] += self.mass * sum;
    }
}
