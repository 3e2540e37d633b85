//! A wave of shear in a periodic unit box, `u = sin(2 pi y) exp(-4 pi^2 nu t)` along x: an exact
//! solution of the Navier-Stokes equations, by which to measure a viscosity.

use std::f64::consts::{PI, TAU};

use super::parameter::{Parameter, Parameters};

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::number("reynolds", 10.0, [0.01, 1e6], "", "U L / nu"),
    Parameter::integer("resolution", 32, [4, 4000], "points across the box"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShearWave {
    /// Reynolds number.
    pub reynolds: f64,
    /// Points across the box.
    pub resolution: f64,
}

impl ShearWave {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            reynolds: parameters.number("reynolds"),
            resolution: parameters.number("resolution"),
        }
    }

    /// Kinematic viscosity, m^2/s.
    pub fn viscosity(&self) -> f64 {
        1.0 / self.reynolds
    }

    /// Velocity at the beginning, m/s.
    pub fn velocity(&self, [_, y, _]: [f64; 3]) -> [f64; 3] {
        [(TAU * y).sin(), 0.0, 0.0]
    }

    /// Time in which the velocity decays by a factor e, s.
    pub fn decay_time(&self) -> f64 {
        self.reynolds / (4.0 * PI * PI)
    }
}
