//! Tensile instability control of Sun et al. (2018).

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `2 p_i / rho_i^2 sum_j m_j grad_i W_ij`, m/s^2, for particles under tension inside of the fluid:
/// it makes of the sum of the pressures in the momentum equation their difference (Sun, Colagrossi,
/// Marrone, Antuono & Zhang 2018, eq. 8), with which particles do not clump. At a free surface
/// nothing is changed, for it is the sum that holds the pressure at zero there.
///
/// Momentum is then conserved only as well as particles lie evenly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TensileControl<T> {
    pub mass: T,
    /// Particles less full than this are of the free surface.
    pub least_fullness: T,
}

impl<T: Real> Term<T> for TensileControl<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::PressureTerm, Quantity::Fullness]
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Acceleration, dims).collect()
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        _: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let own = i[Quantity::PressureTerm];
        if own >= T::zero() || i[Quantity::Fullness] < self.least_fullness {
            return;
        }
        let mut acceleration = near.sum_differences(near.gradient_factor());
        for a in 0..D {
            acceleration[a] *= T::of(2.0) * own * self.mass;
        }
        sums.add(Quantity::Acceleration, acceleration);
    }
}
