//! Shock tube of Sod (1978): a diaphragm at x = 0.5 parts dense gas of density and pressure 1 from
//! thin gas of density 0.125 and pressure 0.1, both at rest, until t = 0; gamma = 1.4. A shock runs
//! into the thin gas, a contact follows it, a rarefaction runs back.
//!
//! The tube is doubled: the dense gas from x = -0.5 to 0.5, the thin gas from 0.5 to 1.5, periodic.
//! Until t = 0.28 nothing from the second diaphragm gets to where errors are measured, from 0 to 1.

use super::parameter::{Parameter, Parameters};
use super::report::Report;
use super::riemann::{Gas, Riemann};

/// Where the diaphragm is, m.
pub const DIAPHRAGM: f64 = 0.5;

/// The tube.
pub const TUBE: Riemann = Riemann {
    heat_ratio: 1.4,
    left: Gas { density: 1.0, velocity: 0.0, pressure: 1.0 },
    right: Gas { density: 0.125, velocity: 0.0, pressure: 0.1 },
};

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::integer("dim", 1, [1, 2], "dimensions"),
    Parameter::integer(
        "resolution",
        400,
        [36, 100_000],
        "points along the tube from 0 to 1; of particles eight ninths are in the dense gas (2-D: eight \
         elevenths)",
    ),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sod {
    /// Dimensions.
    pub dims: usize,
    /// Points along the tube.
    pub resolution: f64,
}

impl Sod {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            dims: parameters.number("dim") as usize,
            resolution: parameters.number("resolution"),
        }
    }

    /// The gas at `x` in [0, 1], m, at `time`.
    pub fn exact(&self, x: f64, time: f64) -> Gas {
        TUBE.around(x - DIAPHRAGM, time)
    }

    /// Judges gas from 0 to 1 at a time, s: where it is, m, the length that it stands for, m, and what it is;
    /// see [`Riemann::judge`].
    pub fn judge(
        &self,
        report: &mut Report,
        time: f64,
        gas: impl Iterator<Item = (f64, f64, Gas)>,
    ) {
        TUBE.judge(report, gas.map(|(x, length, gas)| (length, gas, self.exact(x, time))));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The profile of an independent solver.
    #[test]
    fn it_is_the_reference_profile() {
        let scene = Sod { dims: 1, resolution: 400.0 };
        let table = include_str!("../../tests/references/sod_profile.csv");
        let mut rows = 0;
        for line in table.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit())) {
            let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let gas = scene.exact(numbers[0], 0.2);
            for (a, b) in [gas.density, gas.velocity, gas.pressure].iter().zip(&numbers[1..]) {
                assert!((a - b).abs() < 1e-8, "{gas:?} at {line}");
            }
            rows += 1;
        }
        assert!(rows > 100);
    }
}
