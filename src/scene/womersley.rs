//! Flow that a body force moves to and fro, `G cos(omega t)` along x, in a pipe (Womersley 1955) or between
//! two plates: the force and viscosity decide in turn, `Wo = h sqrt(omega / nu)` with the radius, or half
//! of the gap, `h`.
//!
//! Pipe and gap are 1 m wide, the viscosity is 1 m^2/s, and the force such that the velocity is 0.1 m/s at most.

use std::f64::consts::TAU;

use num_complex::Complex64;

use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// Distance of the plates, or diameter of the pipe, m.
pub const GAP: f64 = 1.0;
/// Density of the fluid, kg/m^3.
pub const DENSITY: f64 = 1.0;
/// Kinematic viscosity, m^2/s.
pub const VISCOSITY: f64 = 1.0;
/// Bound of the velocity, m/s.
pub const SPEED: f64 = 0.1;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 3] = [
    Parameter::choice("section", &["plates", "pipe"], "what the flow is between; a pipe is in 3-D"),
    Parameter::number("womersley", 4.0, [0.1, 50.0], "", "h sqrt(omega / nu)"),
    Parameter::integer("resolution", 32, [4, 2000], "points from wall to wall"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Womersley {
    /// Whether it is in a pipe.
    pub is_pipe: bool,
    /// Womersley number.
    pub womersley: f64,
    /// Points from wall to wall.
    pub resolution: f64,
}

impl Womersley {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            is_pipe: parameters.choice("section") == "pipe",
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
        let slow = if self.is_pipe { 16.0 } else { 8.0 };
        SPEED * (slow * VISCOSITY / (GAP * GAP)).max(0.5 * self.frequency())
    }

    /// When the flow is looked at, s: after two periods and an eighth.
    pub fn end_time(&self) -> f64 {
        2.125 * TAU / self.frequency()
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Flow that a force moves to and fro, Wo = {}", self.womersley)
    }

    /// Velocity along x, m/s, at a distance from the middle, m: `u = Re(-i G / omega e^(i omega t)
    /// (1 - f(eta) / f(1)))` with `eta` the distance over half of the gap and `f(eta)` of the plates
    /// `cosh(sqrt(i) Wo eta)`, of the pipe `I_0(sqrt(i) Wo eta)`.
    pub fn velocity(&self, distance: f64, t: f64) -> f64 {
        let eta = 2.0 * distance / GAP;
        let root = Complex64::I.sqrt() * self.womersley;
        let profile = match self.is_pipe {
            true => 1.0 - bessel_i0(root * eta) / bessel_i0(root),
            false => 1.0 - (root * eta).cosh() / root.cosh(),
        };
        let turned = -Complex64::I * Complex64::cis(self.frequency() * t) * profile;
        turned.re * self.amplitude() / self.frequency()
    }

    /// Judges pairs of distance from the middle, m, and velocity, m/s, at the time `t`, s: `velocity_l2`, relative to the
    /// norm of the exact profile.
    pub fn judge(&self, report: &mut Report, t: f64, profile: impl Iterator<Item = (f64, f64)>) {
        let (mut difference, mut norm) = (0.0, 0.0);
        for (distance, u) in profile {
            let exact = self.velocity(distance, t);
            difference += (u - exact).powi(2);
            norm += exact * exact;
        }
        report.error("velocity_l2", (difference / norm).sqrt());
    }
}

/// The modified Bessel function of order 0 (Abramowitz & Stegun 1964, 9.6.12). At `sqrt(i)` times a real number up
/// to 50 the terms grow to at most e^15 times the sum: nine digits are left there, and 14 up to 10.
fn bessel_i0(z: Complex64) -> Complex64 {
    let square = 0.25 * z * z;
    let (mut sum, mut term) = (Complex64::ONE, Complex64::ONE);
    for k in 1..200 {
        term *= square / f64::from(k * k);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows (Wo, phase, y / h, u omega / G) of `09_womersley_plane_channel.csv`.
    const PLATES: [(f64, f64, f64, f64); 7] = [
        (1.0, 0.0, -0.5, 0.3234947867),
        (1.0, 0.25, 0.0, 0.1788295756),
        (4.0, 0.0, -0.5, 0.2267507169),
        (4.0, 0.25, 0.9, 0.2759331744),
        (4.0, 0.75, 0.0, -1.112218333),
        (10.0, 0.0, 0.9, 0.3203164831),
        (10.0, 0.25, -0.5, 1.026920321),
    ];
    /// Rows (Wo, phase, r / R, u omega / G) of `09_womersley_pipe.csv`.
    const PIPE: [(f64, f64, f64, f64); 7] = [
        (1.0, 0.0, 0.5, 0.1821068921),
        (1.0, 0.25, 0.0, 0.04548564079),
        (4.0, 0.0, 0.5, 0.3564464384),
        (4.0, 0.25, 0.9, 0.2392315369),
        (4.0, 0.75, 0.0, -1.21673298),
        (10.0, 0.0, 0.9, 0.3384173238),
        (10.0, 0.25, 0.5, 1.038230829),
    ];

    #[test]
    fn the_velocity_is_that_of_the_references() {
        for (is_pipe, rows) in [(false, PLATES), (true, PIPE)] {
            for (womersley, phase, eta, expected) in rows {
                let scene = Womersley { is_pipe, womersley, resolution: 32.0 };
                let t = phase * TAU / scene.frequency();
                let found = scene.velocity(0.5 * GAP * eta, t);
                let found = found * scene.frequency() / scene.amplitude();
                let case = format!("pipe: {is_pipe}, {womersley} {phase} {eta}");
                assert!((found - expected).abs() < 1e-9, "{case}: {found}");
            }
        }
    }

    #[test]
    fn the_velocity_keeps_to_its_bound() {
        for is_pipe in [false, true] {
            for womersley in [0.1, 1.0, 2.0, 4.0, 50.0] {
                let scene = Womersley { is_pipe, womersley, resolution: 32.0 };
                let period = TAU / scene.frequency();
                let at = |i: i32, j: i32| {
                    scene.velocity(f64::from(i) / 40.0, f64::from(j) / 40.0 * period).abs()
                };
                let all = (0..=20).flat_map(|i| (0..40).map(move |j| at(i, j)));
                let most = all.fold(0.0, f64::max);
                assert!((0.3 * SPEED..1.01 * SPEED).contains(&most), "{womersley}: {most}");
            }
        }
    }
}
