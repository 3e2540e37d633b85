//! A standing gravity wave in a closed tank, half of a wave long, from the velocity of the linear
//! theory over a flat surface (Antuono, Colagrossi, Marrone & Lugni 2011).

use std::f64::consts::TAU;

use super::parameter::{Parameter, Parameters};
use super::tank::{DENSITY, GRAVITY, Tank};

/// Depth of the water, m.
pub const DEPTH: f64 = 1.0;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 3] = [
    Parameter::integer("resolution", 40, [8, 1000], "points along the depth of the water"),
    Parameter::number("wavelength", 2.0, [0.5, 20.0], "m", "the tank is half as long"),
    Parameter::number("steepness", 0.1, [1e-4, 0.3], "", "wave height over depth, 2 A / H"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingWave {
    /// The tank.
    pub tank: Tank,
    /// Wave number, 1/m.
    pub wave_number: f64,
    /// Amplitude of the surface, m.
    pub amplitude: f64,
    /// Points along the depth.
    pub resolution: f64,
}

impl StandingWave {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        let wavelength = parameters.number("wavelength");
        Self {
            tank: Tank { width: 0.5 * wavelength, height: 1.3 * DEPTH },
            wave_number: TAU / wavelength,
            amplitude: 0.5 * parameters.number("steepness") * DEPTH,
            resolution: parameters.number("resolution"),
        }
    }

    /// Angular frequency of the linear theory, 1/s: `omega^2 = g k tanh(k H)`.
    pub fn frequency(&self) -> f64 {
        (GRAVITY * self.wave_number * (self.wave_number * DEPTH).tanh()).sqrt()
    }

    /// Period of the linear theory, s.
    pub fn period(&self) -> f64 {
        TAU / self.frequency()
    }

    /// Velocity at the beginning: the gradient of
    /// `-A g / omega cosh(k y) / cosh(k H) cos(k x)`.
    pub fn velocity(&self, [x, y, _]: [f64; 3]) -> [f64; 3] {
        let k = self.wave_number;
        let scale = self.amplitude * GRAVITY * k / (self.frequency() * (k * DEPTH).cosh());
        [scale * (k * y).cosh() * (k * x).sin(), -scale * (k * y).sinh() * (k * x).cos(), 0.0]
    }

    /// Energy of the wave, J (per m): half of `rho g A^2 / 2` times the length of the tank.
    pub fn energy(&self) -> f64 {
        0.25 * DENSITY * GRAVITY * self.amplitude.powi(2) * self.tank.width
    }

    /// Pressure at rest, Pa.
    pub fn pressure(&self, [_, y, _]: [f64; 3]) -> f64 {
        DENSITY * GRAVITY * (DEPTH - y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(wavelength: f64) -> StandingWave {
        StandingWave {
            tank: Tank { width: 0.5 * wavelength, height: 1.3 },
            wave_number: TAU / wavelength,
            amplitude: 0.05,
            resolution: 40.0,
        }
    }

    #[test]
    fn periods_are_those_of_the_table() {
        assert!((wave(1.0).period() - 0.8003076072).abs() < 1e-9);
        assert!((wave(2.0).period() - 1.133917478).abs() < 1e-9);
    }

    /// No divergence, nothing through the walls, and the kinetic energy that is said.
    #[test]
    fn the_velocity_is_that_of_a_wave() {
        let wave = wave(2.0);
        assert_eq!(wave.velocity([0.3, 0.0, 0.0])[1], 0.0);
        assert!(wave.velocity([1.0, 0.5, 0.0])[0].abs() < 1e-12);
        let n = 400;
        let at = |i: i32| (f64::from(i) + 0.5) / f64::from(n);
        let mut energy = 0.0;
        for j in 0..n {
            for i in 0..n {
                let [u, v, _] = wave.velocity([at(i), at(j), 0.0]);
                energy += 0.5 * DENSITY * (u * u + v * v) / f64::from(n * n);
            }
        }
        assert!((energy / wave.energy() - 1.0).abs() < 1e-3, "{energy} {}", wave.energy());
        let h = 1e-5;
        let [e, w] = [0.3 + h, 0.3 - h].map(|x| wave.velocity([x, 0.6, 0.0])[0]);
        let [n, s] = [0.6 + h, 0.6 - h].map(|y| wave.velocity([0.3, y, 0.0])[1]);
        assert!((e - w + n - s).abs() < 1e-9);
    }
}
