//! The slotted disk of Zalesak (1979), which a flow that rotates as a whole carries around the middle of a
//! box of side 1, once a second.

use std::f64::consts::TAU;

use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// Centre of the disk at the beginning, m.
pub const CENTRE: [f64; 2] = [0.5, 0.75];
/// Radius of the disk, m.
pub const RADIUS: f64 = 0.15;
/// Width of the slot, m.
pub const SLOT_WIDTH: f64 = 0.05;
/// Upper end of the slot, m.
pub const SLOT_TOP: f64 = 0.85;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::integer("resolution", 100, [20, 4000], "points across the box"),
    Parameter::integer("turns", 1, [1, 100], "how often it goes around"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zalesak {
    /// Points across.
    pub resolution: usize,
    /// How often it goes around.
    pub turns: f64,
}

impl Zalesak {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            resolution: parameters.number("resolution") as usize,
            turns: parameters.number("turns"),
        }
    }

    /// Velocity at a point, m/s.
    pub fn velocity(&self, [x, y, _]: [f64; 3]) -> [f64; 3] {
        [TAU * (0.5 - y), TAU * (x - 0.5), 0.0]
    }

    /// One in the disk and zero outside, after whole turns.
    pub fn disk(&self, [x, y, _]: [f64; 3]) -> f64 {
        let from_centre = (x - CENTRE[0]).hypot(y - CENTRE[1]);
        let is_slot = (x - CENTRE[0]).abs() < 0.5 * SLOT_WIDTH && y < SLOT_TOP;
        f64::from(from_centre < RADIUS && !is_slot)
    }

    /// Judges what is at points after whole turns. `shape`: the integral of the difference from the disk, over
    /// the disk's area; `area`: where more than one half is left; `overshoot` beyond 0 and 1.
    pub fn judge(&self, report: &mut Report, values: impl Iterator<Item = ([f64; 3], f64)>) {
        let (mut difference, mut disk, mut half, mut over) = (0.0, 0.0, 0.0, 0.0f64);
        for (x, c) in values {
            let exact = self.disk(x);
            difference += (c - exact).abs();
            disk += exact;
            half += f64::from(c > 0.5);
            over = over.max(c - 1.0).max(-c);
        }
        report.error("shape", difference / disk);
        report.result("area", half / disk, Some(1.0));
        report.result("overshoot", over, None);
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        let plural = if self.turns == 1.0 { "" } else { "s" };
        format!("Zalesak's disk after {} turn{plural}", self.turns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `08_zalesak.csv`.
    #[test]
    fn the_area_is_that_of_the_reference() {
        let scene = Zalesak { resolution: 100, turns: 1.0 };
        let n = 2000;
        let at = |i: usize| (i as f64 + 0.5) / n as f64;
        let cells: f64 = (0..n * n).map(|i| scene.disk([at(i % n), at(i / n), 0.0])).sum();
        let area = cells / (n * n) as f64;
        assert!((area - 0.05822070306).abs() < 2e-5, "{area}");
    }
}
