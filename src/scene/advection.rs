//! A shape carried at constant velocity through a periodic box of side 1, and once around: what it has
//! become in the end is all error. In the plane it goes along the diagonal.

use std::f64::consts::TAU;

use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// When it is back, s.
pub const TIME: f64 = 1.0;
/// Velocity, m/s.
pub const VELOCITY: f64 = 1.0;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 3] = [
    Parameter::integer("dim", 1, [1, 2], "dimensions"),
    Parameter::integer("resolution", 64, [9, 4000], "points across the box"),
    Parameter::choice(
        "shape",
        &["wave", "step"],
        "what is carried: a sine, or a square of height one",
    ),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carried {
    /// Dimensions.
    pub dims: usize,
    /// Points across.
    pub resolution: usize,
    /// Whether what is carried has a step.
    pub is_step: bool,
}

impl Carried {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            dims: parameters.number("dim") as usize,
            resolution: parameters.number("resolution") as usize,
            is_step: parameters.choice("shape") == "step",
        }
    }

    /// What is carried, at a point and time.
    pub fn quantity(&self, x: [f64; 3], time: f64) -> f64 {
        let along = x[..self.dims].iter().map(|x| (x - VELOCITY * time).rem_euclid(1.0));
        match self.is_step {
            true => along.map(|x| f64::from((0.25..0.75).contains(&x))).product(),
            false => along.map(|x| (TAU * x).sin()).product(),
        }
    }

    /// Judges what is at points. `quantity_l1` and `quantity_l2`: norms of the difference from what should be
    /// there, over those of the latter; `overshoot`: by how much the range of values at the beginning is left.
    pub fn judge(
        &self,
        report: &mut Report,
        time: f64,
        quantities: impl Iterator<Item = ([f64; 3], f64)>,
    ) {
        let (mut l1, mut l2, mut over) = ([0.0; 2], [0.0; 2], 0.0f64);
        let low = if self.is_step { 0.0 } else { -1.0 };
        for (x, u) in quantities {
            let exact = self.quantity(x, time);
            l1[0] += (u - exact).abs();
            l1[1] += exact.abs();
            l2[0] += (u - exact).powi(2);
            l2[1] += exact * exact;
            over = over.max(u - 1.0).max(low - u);
        }
        report.error("quantity_l1", l1[0] / l1[1]);
        report.error("quantity_l2", (l2[0] / l2[1]).sqrt());
        report.result("overshoot", over, None);
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("A {} carried around", if self.is_step { "step" } else { "wave" })
    }
}
