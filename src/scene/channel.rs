//! Flow between two plates that starts from rest, after Morris, Fox & Zhu (1997, sections 4.1 and
//! 4.2): Couette flow, where the upper plate starts to move along x at time 0, and Poiseuille flow,
//! where a body force along x sets in.
//!
//! The plates are 1 mm apart, the fluid is water, and in both the largest velocity is 1.25e-5 m/s,
//! Re = 0.0125: the flow stays plane, along x, and is known as a series.

use std::f64::consts::PI;

use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// Distance of the plates, m.
pub const GAP: f64 = 1e-3;
/// Density of the fluid, kg/m^3.
pub const DENSITY: f64 = 1000.0;
/// Kinematic viscosity, m^2/s.
pub const VISCOSITY: f64 = 1e-6;
/// Largest velocity of the steady flow, m/s.
pub const SPEED: f64 = 1.25e-5;
/// The time at which the flow is looked at, s, well before it is steady: a tenth of `L^2 / nu`.
pub const TIME: f64 = 0.1125;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 1] =
    [Parameter::integer("resolution", 50, [8, 2000], "points from plate to plate")];

/// What moves the fluid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// The upper plate.
    Couette,
    /// A body force.
    Poiseuille,
}

impl Drive {
    /// Name of the scene.
    pub fn scene(self) -> &'static str {
        match self {
            Self::Couette => "couette",
            Self::Poiseuille => "poiseuille",
        }
    }
}

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// What moves the fluid.
    pub drive: Drive,
    /// Points from plate to plate.
    pub resolution: f64,
}

impl Channel {
    /// From the scene's parameters.
    pub fn new(drive: Drive, parameters: &Parameters) -> Self {
        Self { drive, resolution: parameters.number("resolution") }
    }

    /// Velocity of the upper plate along x, m/s.
    pub fn plate_velocity(&self) -> f64 {
        if self.drive == Drive::Couette { SPEED } else { 0.0 }
    }

    /// Body acceleration along x, m/s^2.
    pub fn body_acceleration(&self) -> f64 {
        if self.drive == Drive::Poiseuille { 8.0 * VISCOSITY * SPEED / (GAP * GAP) } else { 0.0 }
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        let name = match self.drive {
            Drive::Couette => "Couette",
            Drive::Poiseuille => "Poiseuille",
        };
        format!("{name} flow that starts from rest, t = {TIME} s")
    }

    /// Judges pairs of height, m, and velocity, m/s, at the time `t` > 0, s. `velocity_l2`: the L2 norm
    /// of the difference of the profile from the series, relative to that of the series;
    /// `cross_flow`: largest velocity across over the largest along.
    pub fn judge(
        &self,
        report: &mut Report,
        t: f64,
        profile: impl Iterator<Item = (f64, [f64; 2])>,
    ) {
        let (mut difference, mut norm, mut across, mut along) = (0.0, 0.0, 0.0f64, 0.0f64);
        for (y, [u, v]) in profile {
            let exact = self.velocity(y, t);
            difference += (u - exact).powi(2);
            norm += exact * exact;
            across = across.max(v.abs());
            along = along.max(u.abs());
        }
        report.error("velocity_l2", (difference / norm).sqrt());
        report.result("cross_flow", across / along, None);
        report.result("largest_velocity", along, None);
    }

    /// Velocity along x, m/s, at the height `y` above the lower plate and the time `t` > 0 (Morris
    /// et al. 1997, eqs. 33 and 35).
    pub fn velocity(&self, y: f64, t: f64) -> f64 {
        let decay = |n: f64| (-VISCOSITY * (n * PI / GAP).powi(2) * t).exp();
        // Terms fall by exp(-n^2) once the profile has begun to spread.
        let orders = (1..2000).map(f64::from);
        match self.drive {
            Drive::Couette => {
                let series = orders.map(|n| {
                    let sign = if n % 2.0 == 0.0 { 1.0 } else { -1.0 };
                    2.0 * SPEED / (n * PI) * sign * (n * PI * y / GAP).sin() * decay(n)
                });
                SPEED * y / GAP + series.sum::<f64>()
            }
            Drive::Poiseuille => {
                let force = self.body_acceleration();
                let series = orders.filter(|n| n % 2.0 == 1.0).map(|n| {
                    let amplitude = 4.0 * force * GAP * GAP / (VISCOSITY * (n * PI).powi(3));
                    amplitude * (n * PI * y / GAP).sin() * decay(n)
                });
                force / (2.0 * VISCOSITY) * y * (GAP - y) - series.sum::<f64>()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows (t, y, u) of `02_couette_transient_morris1997.csv`, from the series with 2000 terms.
    const COUETTE: [(f64, f64, f64); 3] = [
        (0.0225, 0.5e-3, 2.302765682e-07),
        (0.0225, 0.95e-3, 1.017079645e-05),
        (0.045, 0.1e-3, 3.067579104e-08),
    ];
    /// Rows of `02_poiseuille_transient_morris1997.csv`.
    const POISEUILLE: [(f64, f64, f64); 3] = [
        (0.0225, 0.5e-3, 2.232737507e-06),
        (0.0225, 0.05e-3, 7.290974015e-07),
        (0.045, 0.1e-3, 1.936029065e-06),
    ];

    #[test]
    fn the_series_is_that_of_the_references() {
        for (drive, rows) in [(Drive::Couette, COUETTE), (Drive::Poiseuille, POISEUILLE)] {
            let scene = Channel { drive, resolution: 50.0 };
            for (t, y, u) in rows {
                let computed = scene.velocity(y, t);
                assert!((computed - u).abs() < 1e-9 * u, "{drive:?}: {computed} for {u}");
            }
        }
    }

    #[test]
    fn at_last_it_is_linear_and_parabolic() {
        let at = |drive, y| Channel { drive, resolution: 50.0 }.velocity(y, 10.0);
        assert!((at(Drive::Couette, 0.25 * GAP) / (0.25 * SPEED) - 1.0).abs() < 1e-12);
        assert!((at(Drive::Poiseuille, 0.5 * GAP) / SPEED - 1.0).abs() < 1e-12);
        assert!((at(Drive::Poiseuille, 0.25 * GAP) / (0.75 * SPEED) - 1.0).abs() < 1e-12);
    }
}
