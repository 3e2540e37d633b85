//! Riemann problems that are hard on a method (Toro 1999, table 4.1): gas parted at 0.5 in a tube from 0
//! to 1, with a heat ratio of 1.4. 1 is Sod's; 2 draws the gas apart until hardly any is left; 3 and 4 are the
//! two halves of the blast waves of Woodward & Colella; 5 is where these collide.

use super::parameter::{Parameter, Parameters};
use super::report::Report;
use super::riemann::{Gas, Riemann};

/// Where the gases are parted, m.
pub const DIAPHRAGM: f64 = 0.5;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::integer("test", 2, [1, 5], "number of the problem"),
    Parameter::integer("resolution", 400, [20, 100_000], "points along the tube"),
];

const fn gas(density: f64, velocity: f64, pressure: f64) -> Gas {
    Gas { density, velocity, pressure }
}

/// The gases of each problem, left and right, and when they are looked at, s.
const PROBLEMS: [(Gas, Gas, f64); 5] = [
    (gas(1.0, 0.0, 1.0), gas(0.125, 0.0, 0.1), 0.25),
    (gas(1.0, -2.0, 0.4), gas(1.0, 2.0, 0.4), 0.15),
    (gas(1.0, 0.0, 1000.0), gas(1.0, 0.0, 0.01), 0.012),
    (gas(1.0, 0.0, 0.01), gas(1.0, 0.0, 100.0), 0.035),
    (gas(5.99924, 19.5975, 460.894), gas(5.99242, -6.19633, 46.0950), 0.035),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Toro {
    /// Number of the problem.
    pub test: usize,
    /// Points along the tube.
    pub resolution: usize,
    /// The gases.
    pub tube: Riemann,
    /// When they are looked at, s.
    pub end_time: f64,
}

impl Toro {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        let test = parameters.number("test") as usize;
        let (left, right, end_time) = PROBLEMS[test - 1];
        let resolution = parameters.number("resolution") as usize;
        Self { test, resolution, tube: Riemann { heat_ratio: 1.4, left, right }, end_time }
    }

    /// The gas at `x`, m, and a time, s.
    pub fn exact(&self, x: f64, time: f64) -> Gas {
        self.tube.around(x - DIAPHRAGM, time)
    }

    /// Judges the gas at evenly spaced places at a time, s, and the smallest density and pressure at any time.
    /// `density_l1`, `velocity_l1` and `pressure_l1`: the integral of the error over that of the exact
    /// profile; `least_density` and `least_pressure`.
    pub fn judge(
        &self,
        report: &mut Report,
        time: f64,
        gas: impl Iterator<Item = (f64, Gas)>,
        least: [f64; 2],
    ) {
        self.tube.judge(report, gas.map(|(x, gas)| (1.0, gas, self.exact(x, time))));
        report.result("least_density", least[0], None);
        report.result("least_pressure", least[1], None);
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Toro's test {}", self.test)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pressure and velocity between the waves (Toro 1999, table 4.2).
    #[test]
    fn star_states_are_those_of_the_book() {
        let star = [
            (0.30313, 0.92745),
            (0.00189, 0.0),
            (460.894, 19.5975),
            (46.0950, -6.19633),
            (1691.64, 8.68975),
        ];
        for ((left, right, _), (pressure, velocity)) in PROBLEMS.into_iter().zip(star) {
            let (p, u) = Riemann { heat_ratio: 1.4, left, right }.star();
            let close = |a: f64, b: f64| (a - b).abs() < 1e-5 * b.abs().max(1.0);
            assert!(close(p, pressure) && close(u, velocity), "{p} {u}");
        }
    }
}
