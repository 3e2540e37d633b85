//! The waves of a gas along an axis: the eigenvectors of the Jacobian of its flux, of Roe's mean of two states.
//!
//! Sound that goes against the axis, what is carried along (entropy, and velocity across the axis), and sound
//! that goes with the axis, for an ideal gas (Roe 1981, J. Comput. Phys. 43; Toro 2009, section 11.2.2).

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

/// Of a gas of `F` unknowns: density, momentum in `F - 2` directions, energy.
#[derive(Clone, Copy)]
pub(super) struct Waves<V: Pack, const F: usize> {
    axis: usize,
    heat_ratio: V::Scalar,
    /// In the places of momentum.
    velocity: [V; F],
    /// Square of the velocity, of all its components.
    squared: V,
    enthalpy: V,
    sound: V,
}

/// A state, as far as Roe's mean needs it.
#[derive(Clone, Copy)]
pub(super) struct Side<V, const F: usize> {
    /// Density, momentum, energy.
    pub unknowns: [V; F],
    pub sound: V,
}

impl<V: Pack, const F: usize> Waves<V, F> {
    /// Of the mean in which velocity and enthalpy have the roots of the densities as weights.
    #[inline(always)]
    pub fn between(
        left: Side<V, F>,
        right: Side<V, F>,
        axis: usize,
        heat_ratio: V::Scalar,
    ) -> Self {
        let (a, b) = (left.unknowns, right.unknowns);
        let (root_a, root_b) = (a[0].sqrt(), b[0].sqrt());
        let both = root_a + root_b;
        let (weight_a, weight_b) = (root_a / both, root_b / both);
        let zero = both.splat_like(V::Scalar::of(0.0));
        let (mut velocity, mut squared, mut jump) = ([zero; F], zero, zero);
        for f in 1..F - 1 {
            let (in_a, in_b) = (a[f] / a[0], b[f] / b[0]);
            velocity[f] = in_a * weight_a + in_b * weight_b;
            squared = squared + velocity[f] * velocity[f];
            jump = jump + (in_a - in_b) * (in_a - in_b);
        }
        // The square of the speed of sound is (gamma - 1) (H - q^2 / 2) of the mean, written as a sum of what is
        // positive: nothing is lost where the gas is cold and fast.
        let above_one = heat_ratio - V::Scalar::of(1.0);
        let shared = weight_a * weight_b * jump * (above_one * V::Scalar::of(0.5));
        let sound_squared =
            left.sound * left.sound * weight_a + right.sound * right.sound * weight_b + shared;
        let enthalpy =
            sound_squared * (V::Scalar::of(1.0) / above_one) + squared * V::Scalar::of(0.5);
        Self { axis, heat_ratio, velocity, squared, enthalpy, sound: sound_squared.sqrt() }
    }

    /// How fast waves of each family go, where the gas has this velocity along the axis; in the places of
    /// [`Waves::strengths`].
    #[inline(always)]
    pub fn speeds(&self, velocity: V, sound: V) -> [V; F] {
        let mut speeds = [velocity; F];
        speeds[0] = velocity - sound;
        speeds[F - 1] = velocity + sound;
        speeds
    }

    /// How much of each wave is in `w`, by the left eigenvectors (Toro, eqs. 11.68 to 11.70). In the first place
    /// sound against, in the last sound with the axis; in those of momentum what is carried along, entropy in
    /// that along the axis.
    #[inline(always)]
    pub fn strengths(&self, w: [V; F]) -> [V; F] {
        let along = 1 + self.axis;
        let (u, c) = (self.velocity[along], self.sound);
        let mut strengths = w;
        let mut work = (self.enthalpy - self.squared) * w[0] - w[F - 1];
        for f in 1..F - 1 {
            work = work + self.velocity[f] * w[f];
            strengths[f] = w[f] - self.velocity[f] * w[0];
        }
        let entropy = work * (self.heat_ratio - V::Scalar::of(1.0)) / (c * c);
        strengths[along] = entropy;
        strengths[0] = ((u + c) * w[0] - w[along] - c * entropy) * V::Scalar::of(0.5) / c;
        strengths[F - 1] = w[0] - (strengths[0] + entropy);
        strengths
    }

    /// The sum of waves of these strengths, by the right eigenvectors (Toro, eq. 11.59).
    #[inline(always)]
    pub fn sum(&self, strengths: [V; F]) -> [V; F] {
        let along = 1 + self.axis;
        let (against, entropy, with) = (strengths[0], strengths[along], strengths[F - 1]);
        let density = against + entropy + with;
        let sound = (with - against) * self.sound;
        let mut sum = strengths;
        sum[0] = density;
        sum[F - 1] = (against + with) * self.enthalpy
            + sound * self.velocity[along]
            + entropy * self.squared * V::Scalar::of(0.5);
        for f in 1..F - 1 {
            sum[f] = density * self.velocity[f];
            if f == along {
                sum[f] = sum[f] + sound;
            } else {
                sum[f] = sum[f] + strengths[f];
                sum[F - 1] = sum[F - 1] + strengths[f] * self.velocity[f];
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use finegrain_framework::pack::{Pack, Packed};
    use pulp::Scalar;

    use super::super::Conservation;
    use super::*;

    type One = <f64 as Packed>::Pack<Scalar>;

    const HEAT_RATIO: f64 = 1.4;

    fn number(one: One) -> f64 {
        let mut number = [0.0];
        one.store(&mut number);
        number[0]
    }

    /// Conserved quantities of a gas in the plane.
    fn gas(density: f64, [u, v]: [f64; 2], pressure: f64) -> [One; 4] {
        let energy = pressure / (HEAT_RATIO - 1.0) + 0.5 * density * (u * u + v * v);
        [density, density * u, density * v, energy].map(|x| One::splat(Scalar, x))
    }

    /// Roe's property U: what two states differ by, taken apart into waves of which each goes at its own speed, is what
    /// their fluxes differ by. It holds for the eigenvectors of no other mean.
    #[test]
    fn waves_and_their_speeds_make_up_jumps_of_the_flux() {
        let pairs = [
            [gas(1.0, [0.3, -0.2], 1.0), gas(0.125, [-0.4, 0.7], 0.1)],
            [gas(5.99924, [19.5975, 2.0], 460.894), gas(5.99242, [-6.19633, -1.0], 46.095)],
            [gas(1.0, [-2.0, -0.5], 0.4), gas(1.0, [2.0, 0.5], 0.4)],
        ];
        let equation = Conservation { heat_ratio: HEAT_RATIO };
        for [a, b] in pairs {
            for axis in 0..2 {
                let flows = [a, b].map(|u| equation.flow(u, axis));
                let [left, right] = [(a, flows[0]), (b, flows[1])]
                    .map(|(unknowns, flow)| Side { unknowns, sound: flow.sound });
                let waves = Waves::between(left, right, axis, HEAT_RATIO);
                let states: [One; 4] = std::array::from_fn(|f| b[f] - a[f]);
                let fluxes: [One; 4] = std::array::from_fn(|f| flows[1].flux[f] - flows[0].flux[f]);
                let speeds = waves.speeds(waves.velocity[1 + axis], waves.sound).map(number);
                let strengths = waves.strengths(states).map(number);
                let carried = waves.strengths(fluxes).map(number);
                let scale = carried.iter().fold(0.0f64, |most, x| most.max(x.abs()));
                for k in 0..4 {
                    let error = (carried[k] - speeds[k] * strengths[k]).abs();
                    assert!(error < 1e-13 * scale, "axis {axis}, wave {k}: {error} of {scale}");
                }
                for (sum, state) in waves.sum(waves.strengths(states)).into_iter().zip(states) {
                    let (sum, state) = (number(sum), number(state));
                    assert!((sum - state).abs() < 1e-13 * scale, "axis {axis}: {sum} {state}");
                }
            }
        }
    }
}
