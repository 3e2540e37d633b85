//! Heat that spreads in a box of side 1, from a wave that keeps its shape: in a periodic box a product
//! of `sin(2 pi x)`, between ends of temperature zero one of `sin(pi x)`, between insulated ends one of
//! `cos(pi x)`. Its amplitude falls as `exp(-kappa k^2 t)` exactly, k^2 being that of all directions.

use std::f64::consts::{PI, TAU};

use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// Diffusivity, m^2/s.
pub const DIFFUSIVITY: f64 = 0.01;
/// When the temperature is looked at, s.
pub const TIME: f64 = 1.0;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 3] = [
    Parameter::integer("dim", 2, [1, 3], "dimensions"),
    Parameter::integer("resolution", 32, [9, 4000], "points across the box"),
    Parameter::choice(
        "ends",
        &["periodic", "cold", "insulated"],
        "what is at the ends: the other one, temperature zero, or nothing that heat could pass",
    ),
];

/// What is at the ends of the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxEnds {
    /// The other end.
    Periodic,
    /// The value zero.
    Fixed,
    /// The slope zero.
    Free,
}

impl BoxEnds {
    /// The wave along one direction that keeps its shape.
    pub fn shape(self, x: f64) -> f64 {
        match self {
            Self::Periodic => (TAU * x).sin(),
            Self::Fixed => (PI * x).sin(),
            Self::Free => (PI * x).cos(),
        }
    }

    /// Its wave number, 1/m.
    pub fn wave_number(self) -> f64 {
        if self == Self::Periodic { TAU } else { PI }
    }
}

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatBox {
    /// Dimensions.
    pub dims: usize,
    /// Points across.
    pub resolution: usize,
    /// What is at the ends.
    pub ends: BoxEnds,
}

impl HeatBox {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            dims: parameters.number("dim") as usize,
            resolution: parameters.number("resolution") as usize,
            ends: match parameters.choice("ends") {
                "cold" => BoxEnds::Fixed,
                "insulated" => BoxEnds::Free,
                _ => BoxEnds::Periodic,
            },
        }
    }

    /// Temperature, K, at a point and time.
    pub fn temperature(&self, x: [f64; 3], time: f64) -> f64 {
        let shape: f64 = x[..self.dims].iter().map(|&x| self.ends.shape(x)).product();
        shape * self.amplitude(time)
    }

    /// What is left of the amplitude.
    pub fn amplitude(&self, time: f64) -> f64 {
        (-DIFFUSIVITY * self.dims as f64 * self.ends.wave_number().powi(2) * time).exp()
    }

    /// Judges temperatures at points. `temperature_l2`: L2 norm of the difference from the exact ones, over
    /// theirs.
    pub fn judge(
        &self,
        report: &mut Report,
        time: f64,
        temperatures: impl Iterator<Item = ([f64; 3], f64)>,
    ) {
        let (mut difference, mut norm) = (0.0, 0.0);
        for (x, t) in temperatures {
            let exact = self.temperature(x, time);
            difference += (t - exact).powi(2);
            norm += exact * exact;
        }
        report.error("temperature_l2", (difference / norm).sqrt());
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Heat in a box, {}-D", self.dims)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows `heat_1D` and `heat_2D` of `08_linear_modes.csv`.
    #[test]
    fn amplitudes_are_those_of_the_reference() {
        for (dims, amplitude) in [(1, 0.6738254512), (2, 0.4540407387)] {
            let scene = HeatBox { dims, resolution: 32, ends: BoxEnds::Periodic };
            assert!((scene.amplitude(1.0) - amplitude).abs() < 1e-10);
        }
    }
}
