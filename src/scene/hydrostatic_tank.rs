//! Water at rest in a tank with a free surface, which must stay at rest.

use super::parameter::{Parameter, Parameters};
use super::tank::{DENSITY, GRAVITY, Tank};

/// Depth of the water, m.
pub const DEPTH: f64 = 1.0;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::integer("resolution", 30, [8, 1000], "points along the depth of the water"),
    Parameter::number("width", 1.0, [0.2, 10.0], "m", "width of the tank"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HydrostaticTank {
    /// The tank.
    pub tank: Tank,
    /// Points along the depth.
    pub resolution: f64,
}

impl HydrostaticTank {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        let tank = Tank { width: parameters.number("width"), height: 1.2 * DEPTH };
        Self { tank, resolution: parameters.number("resolution") }
    }

    /// `sqrt(g H)`, m/s.
    pub fn speed(&self) -> f64 {
        (GRAVITY * DEPTH).sqrt()
    }

    /// `sqrt(H / g)`, s.
    pub fn time(&self) -> f64 {
        (DEPTH / GRAVITY).sqrt()
    }

    /// Pressure at a height above the bottom, Pa.
    pub fn pressure(&self, y: f64) -> f64 {
        DENSITY * GRAVITY * (DEPTH - y)
    }
}
