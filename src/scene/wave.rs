//! A wave that stands in a box of side 1: the shapes of the [heat](super::heat) scene, which swing as
//! `cos(c k t)`.

use super::heat::BoxEnds;
use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// Speed of the waves, m/s.
pub const SPEED: f64 = 1.0;
/// When the displacement is looked at, s.
pub const TIME: f64 = 2.0;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 3] = [
    Parameter::integer("dim", 2, [1, 3], "dimensions"),
    Parameter::integer("resolution", 32, [9, 4000], "points across the box"),
    Parameter::choice(
        "ends",
        &["periodic", "fixed", "free"],
        "what is at the ends: the other one, displacement zero, or slope zero",
    ),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandingWaves {
    /// Dimensions.
    pub dims: usize,
    /// Points across.
    pub resolution: usize,
    /// What is at the ends.
    pub ends: BoxEnds,
}

impl StandingWaves {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            dims: parameters.number("dim") as usize,
            resolution: parameters.number("resolution") as usize,
            ends: match parameters.choice("ends") {
                "fixed" => BoxEnds::Fixed,
                "free" => BoxEnds::Free,
                _ => BoxEnds::Periodic,
            },
        }
    }

    /// Displacement at the beginning, when nothing moves, m.
    pub fn start(&self, x: [f64; 3]) -> f64 {
        x[..self.dims].iter().map(|&x| self.ends.shape(x)).product()
    }

    /// Displacement at a point and time, m.
    pub fn displacement(&self, x: [f64; 3], time: f64) -> f64 {
        let frequency = SPEED * self.ends.wave_number() * (self.dims as f64).sqrt();
        self.start(x) * (frequency * time).cos()
    }

    /// Judges displacements at points, and the energies at several times. `displacement_l2`: L2 norm of the
    /// difference from the exact ones, over that of the start; `energy_drift`: the largest change of the
    /// energy, over that at the beginning.
    pub fn judge(
        &self,
        report: &mut Report,
        time: f64,
        displacements: impl Iterator<Item = ([f64; 3], f64)>,
        energies: impl Iterator<Item = f64>,
    ) {
        let (mut difference, mut norm) = (0.0, 0.0);
        for (x, u) in displacements {
            difference += (u - self.displacement(x, time)).powi(2);
            norm += self.start(x).powi(2);
        }
        report.error("displacement_l2", (difference / norm).sqrt());
        let energies: Vec<f64> = energies.collect();
        let Some(first) = energies.first() else { return };
        let drift = energies.iter().map(|e| (e / first - 1.0).abs()).fold(0.0, f64::max);
        report.error("energy_drift", drift);
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Standing wave in a box, {}-D", self.dims)
    }
}
