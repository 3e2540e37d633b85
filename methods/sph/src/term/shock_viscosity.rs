//! Artificial viscosity of a gas, by the speed of the signals between particles.

use finegrain_framework::Real;
use finegrain_framework::lanes::SUMS;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `-sum_j m_j Pi_ij grad_i W_ij`, m/s^2, and the heat `1/2 sum_j m_j Pi_ij v_ij . grad_i W_ij`, W/kg,
/// with `Pi_ij = -alpha/2 v_sig w / rho_ij` for particles that approach at `w = v_ij . x_ij / r < 0`
/// and 0 for others, the speed of signals `v_sig = c_i + c_j - beta w`, the mean `rho_ij` of the
/// densities, and the mean of the gradients with `h_i` and `h_j` (Monaghan 1997, section 4).
///
/// Notes down the fastest signal to a particle, m/s, for the time step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShockViscosity<T> {
    /// `alpha`.
    pub strength: T,
    /// `beta`.
    pub approach: T,
}

impl<T: Real> Term<T> for ShockViscosity<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let velocity = Quantity::vector(Quantity::Velocity, dims);
        let others = [Quantity::Volume, Quantity::SoundSpeed, Quantity::SmoothingLength];
        velocity.chain(others).collect()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        let acceleration = Quantity::vector(Quantity::Acceleration, dims);
        acceleration.chain([Quantity::EnergyRate, Quantity::SignalSpeed]).collect()
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let (factor, factor_j) = (near.gradient_factor(), near.gradient_factor_of_others());
        let distance_squared = near.distance_squared();
        let [weight, jump] = work.lanes(factor.len());
        near.velocity_jump(i, jump);
        let (own, sound) = (i[Quantity::SoundSpeed], near.values(Quantity::SoundSpeed));
        let (approach, least) = (self.approach, T::min_positive_value());
        let lanes = weight.iter_mut().zip(&mut *jump).zip(distance_squared).zip(sound);
        for (((signal, jump), &r2), &sound) in lanes {
            *jump = if *jump < T::zero() { *jump } else { T::zero() };
            *signal = own + sound - approach * *jump / (r2 + least).sqrt();
        }
        for ((signal, &factor), &factor_j) in weight.iter_mut().zip(factor).zip(factor_j) {
            *signal = if factor + factor_j < T::zero() { *signal } else { T::zero() };
        }
        let fastest = largest(weight);
        sums[Quantity::SignalSpeed] = sums[Quantity::SignalSpeed].max(fastest);

        // m Pi F, with m / rho_ij = 2 V_i V_j / (V_i + V_j) and F the mean of the two.
        let (own, volume) = (i[Quantity::Volume], near.values(Quantity::Volume));
        let half = -T::of(0.5) * self.strength;
        let lanes = weight.iter_mut().zip(&*jump).zip(distance_squared);
        let lanes = lanes.zip(factor).zip(factor_j).zip(volume);
        for (((((weight, &jump), &r2), &factor), &factor_j), &volume) in lanes {
            let w = jump / (r2 + least).sqrt();
            let reduced = own * volume / (own + volume);
            *weight = half * *weight * w * reduced * (factor + factor_j);
        }
        let mut acceleration = near.sum_differences(weight);
        for a in 0..D {
            acceleration[a] = -acceleration[a];
        }
        sums.add(Quantity::Acceleration, acceleration);
        let [along] = T::dots(weight, [&*jump]);
        sums[Quantity::EnergyRate] += T::of(0.5) * along;
    }
}

/// The largest of whole groups of lanes that are not negative.
#[inline(always)]
fn largest<T: Real>(lanes: &[T]) -> T {
    let mut most = [T::zero(); SUMS];
    for group in lanes.as_chunks::<SUMS>().0 {
        for l in 0..SUMS {
            most[l] = if group[l] > most[l] { group[l] } else { most[l] };
        }
    }
    let mut largest = T::zero();
    for l in 0..SUMS {
        largest = largest.max(most[l]);
    }
    largest
}
