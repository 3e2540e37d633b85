//! Flow between two plates that a body force moves to and fro, `G cos(omega t)` along x (Womersley 1955, in
//! the plane): the force and viscosity decide in turn, `Wo = h sqrt(omega / nu)` with half of the gap
//! `h`.
//!
//! The gap is 1 m, the viscosity 1 m^2/s, and the force such that the velocity is 0.1 m/s at most.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// Distance of the plates, m.
pub const GAP: f64 = 1.0;
/// Density of the fluid, kg/m^3.
pub const DENSITY: f64 = 1.0;
/// Kinematic viscosity, m^2/s.
pub const VISCOSITY: f64 = 1.0;
/// Bound of the velocity, m/s.
pub const SPEED: f64 = 0.1;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::number("womersley", 4.0, [0.1, 50.0], "", "h sqrt(omega / nu)"),
    Parameter::integer("resolution", 32, [4, 2000], "points from plate to plate"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Womersley {
    /// Womersley number.
    pub womersley: f64,
    /// Points from plate to plate.
    pub resolution: f64,
}

impl Womersley {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            womersley: parameters.number("womersley"),
            resolution: parameters.number("resolution"),
        }
    }

    /// Angular frequency, 1/s.
    pub fn frequency(&self) -> f64 {
        4.0 * VISCOSITY * self.womersley.powi(2) / (GAP * GAP)
    }

    /// Body acceleration along x, m/s^2, at a time, s.
    pub fn acceleration(&self, t: f64) -> f64 {
        self.amplitude() * (self.frequency() * t).cos()
    }

    /// That of a slow or a fast force which alone would make the largest velocity.
    fn amplitude(&self) -> f64 {
        SPEED * (8.0 * VISCOSITY / (GAP * GAP)).max(0.5 * self.frequency())
    }

    /// When the flow is looked at, s: after two periods and an eighth.
    pub fn end_time(&self) -> f64 {
        2.125 * TAU / self.frequency()
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Flow that a force moves to and fro, Wo = {}", self.womersley)
    }

    /// Velocity along x, m/s, at the height `y` above the lower plate: `u = Re(-i G / omega
    /// e^(i omega t) (1 - cosh(sqrt(i) Wo eta) / cosh(sqrt(i) Wo)))` with `eta` from -1 to 1.
    pub fn velocity(&self, y: f64, t: f64) -> f64 {
        let eta = 2.0 * y / GAP - 1.0;
        let root = Complex64::I.sqrt() * self.womersley;
        let profile = 1.0 - (root * eta).cosh() / root.cosh();
        let turned = -Complex64::I * Complex64::cis(self.frequency() * t) * profile;
        turned.re * self.amplitude() / self.frequency()
    }

    /// Judges pairs of height, m, and velocity, m/s, at the time `t`, s: `velocity_l2`, relative to the
    /// norm of the exact profile.
    pub fn judge(&self, report: &mut Report, t: f64, profile: impl Iterator<Item = (f64, f64)>) {
        let (mut difference, mut norm) = (0.0, 0.0);
        for (y, u) in profile {
            let exact = self.velocity(y, t);
            difference += (u - exact).powi(2);
            norm += exact * exact;
        }
        report.error("velocity_l2", (difference / norm).sqrt());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows (Wo, phase, y / h, u omega / G) of `09_womersley_plane_channel.csv`.
    const ROWS: [(f64, f64, f64, f64); 7] = [
        (1.0, 0.0, -0.5, 0.3234947867),
        (1.0, 0.25, 0.0, 0.1788295756),
        (4.0, 0.0, -0.5, 0.2267507169),
        (4.0, 0.25, 0.9, 0.2759331744),
        (4.0, 0.75, 0.0, -1.112218333),
        (10.0, 0.0, 0.9, 0.3203164831),
        (10.0, 0.25, -0.5, 1.026920321),
    ];

    #[test]
    fn the_velocity_is_that_of_the_references() {
        for (womersley, phase, eta, expected) in ROWS {
            let scene = Womersley { womersley, resolution: 32.0 };
            let t = phase * TAU / scene.frequency();
            let y = 0.5 * GAP * (1.0 + eta);
            let found = scene.velocity(y, t) * scene.frequency() / scene.amplitude();
            assert!((found - expected).abs() < 1e-9, "{womersley} {phase} {eta}: {found}");
        }
    }

    #[test]
    fn the_velocity_keeps_to_its_bound() {
        for womersley in [0.1, 1.0, 2.0, 4.0, 50.0] {
            let scene = Womersley { womersley, resolution: 32.0 };
            let period = TAU / scene.frequency();
            let at = |i: i32, j: i32| {
                scene.velocity(f64::from(i) / 20.0, f64::from(j) / 40.0 * period).abs()
            };
            let most = (0..=20).flat_map(|i| (0..40).map(move |j| at(i, j))).fold(0.0, f64::max);
            assert!((0.3 * SPEED..1.01 * SPEED).contains(&most), "{womersley}: {most}");
        }
    }
}
