//! Pressure in bodies, after Adami, Hu & Adams (2012).

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `(sum_f p_f W_if + g . sum_f rho_f (x_i - x_f) W_if) / sum_f W_if` (eq. 27, for bodies at rest),
/// over the fluid only, Pa; 0 where there is no fluid around.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallPressure<T> {
    pub mass: T,
    /// Whether the pressure of the fluid is given as `p / rho^2`.
    pub is_given_by_term: bool,
    /// Acceleration `g` of the fluid by the body force, m/s^2.
    pub body_acceleration: [T; 3],
    /// A sum of the kernel up to here counts as no fluid around, 1/m^3 (1/m^2 in 2-D).
    pub least_kernel: T,
}

impl<T: Real> Term<T> for WallPressure<T> {
    fn reads(&self, _: usize) -> Vec<Quantity> {
        if self.is_given_by_term {
            vec![Quantity::Volume, Quantity::PressureTerm]
        } else {
            vec![Quantity::Volume, Quantity::Pressure]
        }
    }

    fn writes(&self, _: usize) -> Vec<Quantity> {
        vec![Quantity::WallPressure]
    }

    fn uses_kernel(&self) -> bool {
        true
    }

    fn acts_on_bodies(&self) -> bool {
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
        let [weight, other] = work.lanes(near.kernel().len());
        near.kernel_in_fluid(weight);
        other.fill(T::one());
        let [total] = T::dots(weight, [&*other]);
        if total <= self.least_kernel {
            return;
        }
        let volume = near.values(Quantity::Volume);
        let [pressure] = if self.is_given_by_term {
            let term = near.values(Quantity::PressureTerm);
            for ((pressure, &volume), &term) in other.iter_mut().zip(volume).zip(term) {
                let density = self.mass / volume;
                *pressure = term * density * density;
            }
            T::dots(weight, [&*other])
        } else {
            T::dots(weight, [near.values(Quantity::Pressure)])
        };
        for (weight, &volume) in weight.iter_mut().zip(volume) {
            *weight *= self.mass / volume;
        }
        let away = near.sum_differences(weight);
        let mut weight_of_fluid = T::zero();
        for a in 0..D {
            weight_of_fluid += self.body_acceleration[a] * away[a];
        }
        sums[Quantity::WallPressure] += (pressure + weight_of_fluid) / total;
    }
}
