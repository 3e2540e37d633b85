//! Lid-driven cavity: a unit square of fluid under a lid at y = 1 that moves along x at speed 1.

use std::f64::consts::PI;

use finegrain_framework::run::History;

use profiles::{Profiles, RE_100, RE_1000};

use super::parameter::{Parameter, Parameters};
use super::report::Report;

mod profiles;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::number("reynolds", 100.0, [1.0, 1e4], "", "U L / nu"),
    Parameter::integer("resolution", 50, [8, 2000], "points across the cavity"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cavity {
    /// Reynolds number.
    pub reynolds: f64,
    /// Points across.
    pub resolution: f64,
}

/// Extrema of the velocity on the two lines through the middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extrema {
    /// Least velocity along x on x = 1/2.
    pub u_min: f64,
    /// Largest velocity along y on y = 1/2.
    pub v_max: f64,
    /// Least velocity along y on y = 1/2.
    pub v_min: f64,
}

impl Cavity {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            reynolds: parameters.number("reynolds"),
            resolution: parameters.number("resolution"),
        }
    }

    /// Kinematic viscosity.
    pub fn viscosity(&self) -> f64 {
        1.0 / self.reynolds
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Lid-driven cavity, Re = {}", self.reynolds)
    }

    /// Judges the extrema, against those of steady flow.
    pub fn judge(&self, report: &mut Report, found: &Extrema, is_steady: bool) {
        let reference = self.reference().filter(|_| is_steady);
        report.result("u_min", found.u_min, reference.map(|r| r.u_min));
        report.result("v_max", found.v_max, reference.map(|r| r.v_max));
        report.result("v_min", found.v_min, reference.map(|r| r.v_min));
    }

    /// Adds `profiles_l2`: L2 of the difference of the velocities on the lines through the middle, `u` on
    /// x = 1/2 as a function of y and `v` on y = 1/2 as one of x, from those of the reference at its
    /// stations, over the L2 of these, where there are some.
    pub fn judge_profiles(
        &self,
        report: &mut Report,
        u: impl Fn(f64) -> f64,
        v: impl Fn(f64) -> f64,
    ) {
        let Some(Profiles { upright, across }) = self.reference_profiles() else { return };
        let upright = upright.iter().map(|&(y, wanted)| (u(y), wanted));
        let across = across.iter().map(|&(x, wanted)| (v(x), wanted));
        let (mut difference, mut size) = (0.0, 0.0);
        for (found, wanted) in upright.chain(across) {
            difference += (found - wanted).powi(2);
            size += wanted * wanted;
        }
        report.error("profiles_l2", (difference / size).sqrt());
    }

    fn reference_profiles(&self) -> Option<Profiles> {
        let known = [(100.0, RE_100), (1000.0, RE_1000)];
        known.into_iter().find(|(reynolds, _)| *reynolds == self.reynolds).map(|(_, all)| all)
    }

    /// Whether the kinetic energy, sampled once in a unit of time, has come so near to that of steady flow that
    /// `tolerance` of it is missing at most: what is left decays as `exp(-2 pi^2 t / Re)` or faster.
    pub fn is_steady(&self, histories: &[History], tolerance: f64) -> bool {
        let energy: Vec<f64> =
            histories[0].column("kinetic_energy").map(Iterator::collect).unwrap_or_default();
        let most = tolerance * (2.0 * PI * PI / self.reynolds).min(1.0);
        let is_small = |change: f64, energy: f64| change.abs() < most * energy;
        // Twice, for it may turn.
        matches!(energy[..], [.., a, b, c] if is_small(b - a, c) && is_small(c - b, c))
    }

    /// The extrema from an independent solution, where there is one.
    pub fn reference(&self) -> Option<Extrema> {
        EXTREMA.iter().find(|(reynolds, _)| *reynolds == self.reynolds).map(|(_, extrema)| *extrema)
    }
}

/// Re = 100: streamfunction by finite differences on up to 256 x 256 points, extrapolated
/// (its stations nearest to the extrema are a part in a thousand lower). Re = 1000: Botella & Peyret
/// (1998), Comput. Fluids 27, 421, by a Chebyshev method.
const EXTREMA: [(f64, Extrema); 2] = [
    (100.0, Extrema { u_min: -0.21404, v_max: 0.17957, v_min: -0.25380 }),
    (1000.0, Extrema { u_min: -0.3885698, v_max: 0.3769447, v_min: -0.5270771 }),
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows (coordinate, value) of `04_cavity_check.csv` for Re = 100 about the extrema: u on x =
    /// 1/2, v on y = 1/2.
    const STATIONS_100: [[(f64, f64); 3]; 3] = [
        [(0.5, -0.209149), (0.453125, -0.213978), (0.28125, -0.157649)],
        [(0.234375, 0.17956), (0.2265625, 0.179356), (0.15625, 0.164805)],
        [(0.859375, -0.233713), (0.8046875, -0.253542), (0.5, 0.057537)],
    ];

    #[test]
    fn no_station_of_the_reference_is_beyond_the_extrema_and_the_next_is_near() {
        let extrema = Cavity { reynolds: 100.0, resolution: 50.0 }.reference().unwrap();
        let values = [extrema.u_min, extrema.v_max, extrema.v_min];
        for (stations, extremum) in STATIONS_100.iter().zip(values) {
            let most = stations.iter().map(|(_, v)| v / extremum).fold(0.0, f64::max);
            assert!((0.998..1.0).contains(&most), "{most} of {extremum}");
        }
        assert_eq!(Cavity { reynolds: 400.0, resolution: 50.0 }.reference(), None);
    }
}
