//! Creeping flow through a simple cubic array of spheres, driven by a body force: one periodic cell of
//! 0.1 m, the flow along an axis (Hasimoto 1959; Zick & Homsy 1982).

use std::f64::consts::PI;

use finegrain_framework::shape::Shape;

use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// Side of the cell, m.
pub const SIDE: f64 = 0.1;
/// Density of the fluid, kg/m^3.
pub const DENSITY: f64 = 1000.0;
/// Kinematic viscosity, m^2/s.
pub const VISCOSITY: f64 = 1e-4;
/// Body acceleration along x, m/s^2: so low that there is no inertia to see.
pub const BODY_ACCELERATION: f64 = 1e-6;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::number(
        "solid_fraction",
        0.125,
        [0.001, 0.5],
        "",
        "part of the cell that the sphere fills",
    ),
    Parameter::integer("resolution", 32, [8, 512], "points across the cell"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereArray {
    /// Part of the cell that is solid.
    pub solid_fraction: f64,
    /// Points across the cell.
    pub resolution: f64,
}

impl SphereArray {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            solid_fraction: parameters.number("solid_fraction"),
            resolution: parameters.number("resolution"),
        }
    }

    /// Radius of the sphere, m.
    pub fn radius(&self) -> f64 {
        SIDE * (3.0 * self.solid_fraction / (4.0 * PI)).cbrt()
    }

    /// The sphere, in the middle of the cell.
    pub fn body(&self) -> Shape {
        Shape::Sphere { centre: [0.5 * SIDE; 3], radius: self.radius() }
    }

    /// Superficial mean velocity, m/s, by the series of a dilute array (Sangani & Acrivos 1982): an
    /// estimate, to choose a time step with.
    pub fn creeping_velocity(&self) -> f64 {
        let c = self.solid_fraction;
        let series = 1.0 - 1.7601 * c.cbrt() + c - 1.5593 * c * c + 3.9799 * c.powf(8.0 / 3.0)
            - 3.0734 * c.powf(10.0 / 3.0);
        // Of dense arrays it would be negative.
        self.velocity_of_drag(1.0 / series.max(0.01))
    }

    fn velocity_of_drag(&self, k: f64) -> f64 {
        BODY_ACCELERATION * SIDE.powi(3) / (6.0 * PI * VISCOSITY * self.radius() * k)
    }

    /// Time in which a disturbance of the mean flow decays by a factor e, s.
    pub fn relaxation_time(&self) -> f64 {
        self.creeping_velocity() / BODY_ACCELERATION
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Flow through a cubic array of spheres, c = {}", self.solid_fraction)
    }

    /// Judges the superficial mean velocity, m/s: averaged over the whole cell, zero in the sphere.
    /// `drag_k` is `F / (6 pi mu a U)` with the force `F` that drives a cell, `rho f L^3`.
    pub fn judge(&self, report: &mut Report, [x, y, z]: [f64; 3], is_steady: bool) {
        if !is_steady {
            report.notes.push("not steady: the drag is not that of steady flow".to_owned());
        }
        let known = DRAG.iter().find(|(c, _)| *c == self.solid_fraction);
        let reference = known.map(|(_, k)| *k).filter(|_| is_steady);
        report.result("drag_k", self.velocity_of_drag(1.0) / x, reference);
        report.result("superficial_velocity", x, None);
        report.result("cross_flow", y.hypot(z) / x, None);
    }
}

/// Solid fraction and K: Zick & Homsy (1982), Table 2, to four digits; a least-squares solution in Lamb's
/// functions agrees (`09_stokes_sc_spheres.csv`).
const DRAG: [(f64, f64); 3] = [(0.027, 2.008), (0.125, 4.292), (0.216, 7.442)];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_estimate_is_near_the_references() {
        for (solid_fraction, k) in DRAG {
            let scene = SphereArray { solid_fraction, resolution: 32.0 };
            let estimate = scene.velocity_of_drag(1.0) / scene.creeping_velocity();
            assert!((estimate / k - 1.0).abs() < 0.01, "{solid_fraction}: {estimate} {k}");
        }
        // `a_over_L` of the reference.
        let scene = SphereArray { solid_fraction: 0.216, resolution: 32.0 };
        assert!((scene.radius() / SIDE - 0.372208).abs() < 1e-5);
    }
}
