//! Flow through a square array of cylinders, driven by a body force: one periodic cell.
//!
//! The cylinder fills the fraction phi of an L x L cell, L = 0.1 m, and the flow is along x. In 3-D
//! the cell is extruded along z, a few layers thick, as in Holmes et al. (2011); the solution does
//! not depend on z. The defaults are those of Morris, Fox & Zhu (1997) at Re = 0.03.

use std::f64::consts::PI;

use finegrain_framework::run::History;
use finegrain_framework::shape::{Axis, Shape};

use profiles::{RE_0_03, RE_1, Station};

use super::parameter::{Parameter, Parameters};
use super::report::Report;

mod profiles;

/// Side of the cell, m.
pub const SIDE: f64 = 0.1;
/// Density of the fluid, kg/m^3.
pub const DENSITY: f64 = 1000.0;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 5] = [
    Parameter::integer("dim", 2, [2, 3], "dimensions"),
    Parameter::number(
        "solid_fraction",
        PI * 0.04,
        [0.001, 0.5],
        "",
        "part of the cell that the cylinder fills",
    ),
    Parameter::integer("resolution", 50, [10, 4000], "points across the cell"),
    Parameter::number("viscosity", 1e-4, [1e-9, 1e3], "m^2/s", "kinematic viscosity"),
    Parameter::number("body_acceleration", 5e-5, [1e-15, 1e6], "m/s^2", "drives the flow along x"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Dimensions.
    pub dims: usize,
    /// Part of the cell that is solid.
    pub solid_fraction: f64,
    /// Points across the cell.
    pub resolution: f64,
    /// Kinematic viscosity, m^2/s.
    pub viscosity: f64,
    /// Body acceleration along x, m/s^2.
    pub body_acceleration: f64,
}

impl Cylinder {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            dims: parameters.number("dim") as usize,
            solid_fraction: parameters.number("solid_fraction"),
            resolution: parameters.number("resolution"),
            viscosity: parameters.number("viscosity"),
            body_acceleration: parameters.number("body_acceleration"),
        }
    }

    /// Radius of the cylinder, m, of which a cell with these side lengths is filled to the solid fraction.
    pub fn radius(&self, [x, y, _]: [f64; 3]) -> f64 {
        (self.solid_fraction * x * y / PI).sqrt()
    }

    /// The cylinder, in the middle of a cell with these side lengths.
    pub fn body(&self, sides: [f64; 3]) -> Shape {
        let [x, y, _] = sides;
        let centre = [0.5 * x, 0.5 * y, 0.0];
        Shape::Cylinder { axis: Axis::Z, centre, radius: self.radius(sides) }
    }

    /// Superficial mean velocity of creeping flow, m/s, from the drag of a dilute array (Sangani &
    /// Acrivos 1982, eq. 41): an estimate, to choose a sound speed with.
    pub fn creeping_velocity(&self) -> f64 {
        let phi = self.solid_fraction;
        let series = -0.5 * phi.ln() - 0.738 + phi - 0.887 * phi * phi + 2.038 * phi.powi(3);
        let drag = 4.0 * PI / series;
        self.body_acceleration * SIDE * SIDE / (self.viscosity * drag)
    }

    /// Time in which a disturbance of the mean flow decays by a factor e, s: `L^2 / (nu k)`.
    pub fn relaxation_time(&self) -> f64 {
        self.creeping_velocity() / self.body_acceleration
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Flow through a square array of cylinders, phi = {:.3}", self.solid_fraction)
    }

    /// Judges the superficial mean velocity, m/s, in a cell with these sides across the cylinder, m.
    /// The reference of `drag_k` is of steady flow through a square array.
    pub fn judge(
        &self,
        report: &mut Report,
        [x, y, z]: [f64; 3],
        [length, width]: [f64; 2],
        is_steady: bool,
    ) {
        if !is_steady {
            report.notes.push("not steady: the drag is not that of steady flow".to_owned());
        }
        let is_square = (length / width - 1.0).abs() < 1e-9;
        let reference = self.reference_drag().filter(|_| is_steady && is_square);
        report.result("drag_k", self.drag(x, length * width), reference);
        report.result("superficial_velocity", x, None);
        report.result("cross_flow", y.hypot(z) / x, None);
    }

    /// `k = f L^2 / (nu U)`, with `L^2` the area of the cell and `U` the superficial mean velocity:
    /// averaged over the whole cell, zero in the cylinder.
    pub fn drag(&self, superficial_velocity: f64, area: f64) -> f64 {
        self.body_acceleration * area / (self.viscosity * superficial_velocity)
    }

    /// Velocities for these parameters from an independent solution, where there is one.
    pub fn reference_profiles(&self) -> &'static [Station] {
        if !is(self.solid_fraction, PI * 0.04) {
            return &[];
        }
        let cases: [(f64, f64, &[Station]); 2] = [(1e-4, 5e-5, &RE_0_03), (1e-6, 1.5e-7, &RE_1)];
        let own =
            |&&(nu, f, _): &&(f64, f64, _)| is(self.viscosity, nu) && is(self.body_acceleration, f);
        cases.iter().find(own).map_or(&[], |&(_, _, stations)| stations)
    }

    /// Adds `profiles_l2`: L2 of the difference of the velocities `found` at the stations of the
    /// reference from those of the reference, over the L2 of these, where there are some.
    pub fn judge_profiles(&self, report: &mut Report, found: impl Iterator<Item = [f64; 2]>) {
        let (mut difference, mut size) = (0.0, 0.0);
        for (station, velocity) in self.reference_profiles().iter().zip(found) {
            for a in 0..2 {
                difference += (velocity[a] - station.velocity[a]).powi(2);
                size += station.velocity[a].powi(2);
            }
        }
        if size > 0.0 {
            report.error("profiles_l2", (difference / size).sqrt());
        }
    }

    /// The drag for these parameters in a square cell from an independent solution, where there is
    /// one.
    pub fn reference_drag(&self) -> Option<f64> {
        // f L^3 / nu^2 decides between creeping and inertial flow.
        let forcing = self.body_acceleration * SIDE.powi(3) / self.viscosity.powi(2);
        let inertial = INERTIAL.iter().find(|(g, _)| is(forcing, *g));
        if let (Some(&(_, drag)), true) = (inertial, is(self.solid_fraction, PI * 0.04)) {
            return Some(drag);
        }
        // Inertia adds a part in 1e5 at forcing 5 and grows with its square (and the product that
        // the defaults come to rounds to a little more than 5).
        let creeping = CREEPING.iter().find(|(phi, _)| is(self.solid_fraction, *phi))?;
        (forcing < 5.001).then_some(creeping.1)
    }
}

/// Whether the mean velocity, three samples a relaxation time, has twice changed by less than
/// `tolerance` of itself: it is then within some three times that of its final value.
pub fn is_steady(histories: &[History], tolerance: f64) -> bool {
    let mean: Vec<f64> =
        histories[0].column("velocity_x").map(Iterator::collect).unwrap_or_default();
    match mean[..] {
        [.., first, second, third] if mean.len() > 4 => {
            let change = (second - first).abs().max((third - second).abs());
            change < tolerance * third.abs()
        }
        _ => false,
    }
}

/// Adds `momentum_balance`: the `force` on the cylinder over the `driving` one on the fluid, less one,
/// which is an error where the flow is steady.
pub fn judge_momentum(report: &mut Report, force: f64, driving: f64, is_steady: bool) {
    let excess = force / driving - 1.0;
    if is_steady {
        report.error("momentum_balance", excess);
    } else {
        report.result("momentum_balance", excess, None);
    }
}

/// Largest relative difference of two parameters that count as the same.
fn is(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < 1e-6
}

/// Solid fraction and `k` of creeping flow along an axis of a square array: streamfunction series
/// that satisfies no slip exactly, converged to nine digits; agrees with Sangani & Acrivos (1982),
/// Table 1, where that has the fraction.
const CREEPING: [(f64, f64); 5] = [
    (0.01, 7.982041463),
    (0.1, 24.83167525),
    (0.125663706144, 30.35063565),
    (0.2, 51.52694896),
    (0.4, 217.8943147),
];

/// `f L^3 / nu^2` and `k` at phi = 0.04 pi: steady Navier-Stokes by finite elements (Q2-Q1, 128 x
/// 40 elements), for Morris, Fox & Zhu (1997) at Re = 0.03 and Re = 1.
const INERTIAL: [(f64, f64); 2] = [(5.0, 30.35096428), (150.0, 30.61015867)];

#[cfg(test)]
mod tests {
    use super::*;

    fn morris(viscosity: f64, body_acceleration: f64) -> Cylinder {
        Cylinder {
            dims: 2,
            solid_fraction: PI * 0.04,
            resolution: 50.0,
            viscosity,
            body_acceleration,
        }
    }

    #[test]
    fn references_are_those_of_the_parameters() {
        assert_eq!(morris(1e-4, 5e-5).reference_drag(), Some(30.35096428));
        assert_eq!(morris(1e-6, 1.5e-7).reference_drag(), Some(30.61015867));
        assert_eq!(morris(1e-4, 1e-6).reference_drag(), Some(30.35063565));
        assert_eq!(morris(1e-6, 1.5e-6).reference_drag(), None);
        for (phi, drag) in [CREEPING[0], CREEPING[1], CREEPING[3], CREEPING[4]] {
            let scene = Cylinder { solid_fraction: phi, ..morris(1e-4, 5e-5) };
            assert_eq!(scene.reference_drag(), Some(drag));
        }
    }

    #[test]
    fn the_estimate_is_near_the_reference_where_the_array_is_dilute() {
        for (phi, drag) in &CREEPING[..3] {
            let scene = Cylinder { solid_fraction: *phi, ..morris(1e-4, 5e-5) };
            assert!((scene.drag(scene.creeping_velocity(), SIDE * SIDE) / drag - 1.0).abs() < 0.01);
        }
    }
}
