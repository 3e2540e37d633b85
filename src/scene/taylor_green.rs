//! Taylor-Green vortices decaying in a periodic unit box, with density 1 and largest speed 1. In 3-D
//! references have a box 2 pi long, so that their Reynolds number is `reynolds` over 2 pi.
//!
//! In 2-D this is an exact solution of the Navier-Stokes equations:
//! `u = -e(t) cos(2 pi x) sin(2 pi y)`, `v = e(t) sin(2 pi x) cos(2 pi y)` with
//! `e = exp(-8 pi^2 t / Re)`. In 3-D (Taylor & Green 1937) only the beginning is known.

use std::f64::consts::{PI, TAU};

use super::parameter::{Parameter, Parameters};
use super::peak;
use super::report::Report;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 3] = [
    Parameter::integer("dim", 2, [2, 3], "dimensions"),
    Parameter::number("reynolds", 100.0, [0.01, 1e6], "", "U L / nu"),
    Parameter::integer("resolution", 50, [8, 4000], "points across the box"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaylorGreen {
    /// Dimensions.
    pub dims: usize,
    /// Reynolds number.
    pub reynolds: f64,
    /// Points across the box.
    pub resolution: f64,
}

impl TaylorGreen {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            dims: parameters.number("dim") as usize,
            reynolds: parameters.number("reynolds"),
            resolution: parameters.number("resolution"),
        }
    }

    /// Velocity at a point and time; in 3-D only at time 0.
    pub fn velocity(&self, [x, y, z]: [f64; 3], time: f64) -> [f64; 3] {
        if self.dims == 2 {
            let e = (-self.decay_rate() * time).exp();
            return [
                -e * (TAU * x).cos() * (TAU * y).sin(),
                e * (TAU * x).sin() * (TAU * y).cos(),
                0.0,
            ];
        }
        [
            (TAU * x).sin() * (TAU * y).cos() * (TAU * z).cos(),
            -(TAU * x).cos() * (TAU * y).sin() * (TAU * z).cos(),
            0.0,
        ]
    }

    /// Pressure that belongs to the velocity at time 0, over the density, mean zero.
    pub fn pressure(&self, [x, y, z]: [f64; 3]) -> f64 {
        let sum = (2.0 * TAU * x).cos() + (2.0 * TAU * y).cos();
        if self.dims == 2 { -0.25 * sum } else { sum * ((2.0 * TAU * z).cos() + 2.0) / 16.0 }
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Taylor-Green vortices, Re = {}", self.reynolds)
    }

    /// Judges the velocities at points, at the time `t` > 0, and the kinetic energies at the
    /// beginning and then. `decay_rate` of the velocity, from the energies; in 2-D `velocity_l1` and
    /// `velocity_l2`, relative to the norms of the exact velocity.
    pub fn judge(
        &self,
        report: &mut Report,
        t: f64,
        [first, last]: [f64; 2],
        velocities: impl Iterator<Item = ([f64; 3], [f64; 2])>,
    ) {
        let is_plane = self.dims == 2;
        let rate = (first / last).ln() / (2.0 * t);
        report.result("decay_rate", rate, is_plane.then(|| self.decay_rate()));
        if !is_plane {
            return;
        }
        let (mut l1, mut l2) = ([0.0; 2], [0.0; 2]);
        for (x, [u, v]) in velocities {
            let exact = self.velocity(x, t);
            let (dx, dy) = (u - exact[0], v - exact[1]);
            l1[0] += dx.hypot(dy);
            l1[1] += exact[0].hypot(exact[1]);
            l2[0] += dx * dx + dy * dy;
            l2[1] += exact[0] * exact[0] + exact[1] * exact[1];
        }
        report.error("velocity_l1", l1[0] / l1[1]);
        report.error("velocity_l2", (l2[0] / l2[1]).sqrt());
    }

    /// Judges the history of the kinetic energy per volume and mass in 3-D: `peak_dissipation`, the
    /// largest rate of its loss, and when, `peak_time`, in the units of the references, in which the
    /// box is 2 pi long. None if the peak is at an end.
    pub fn judge_dissipation(&self, report: &mut Report, times: &[f64], energy: &[f64]) {
        let Some((time, dissipation)) = peak_of_dissipation(times, energy) else { return };
        let is_reference = (self.reynolds / TAU / 100.0 - 1.0).abs() < 1e-3;
        let reference = |value| is_reference.then_some(value);
        report.result("peak_dissipation", dissipation / TAU, reference(PEAK_DISSIPATION));
        report.result("peak_time", time * TAU, reference(PEAK_TIME));
    }

    /// Rate at which the exact velocity decays in 2-D.
    pub fn decay_rate(&self) -> f64 {
        8.0 * PI * PI / self.reynolds
    }
}

/// Largest dissipation in 3-D where a box 2 pi long has a viscosity of 1/100 (here Re = 200 pi), and its
/// time: pseudo-spectral on 64^3 points, 3e-6 from 48^3 (`03_tgv3d_re100.csv`).
const PEAK_DISSIPATION: f64 = 0.0129751;
const PEAK_TIME: f64 = 4.884;

/// Time and value of the largest rate at which `energy` is lost, by differences over two samples; `None`
/// if that is at an end.
fn peak_of_dissipation(times: &[f64], energy: &[f64]) -> Option<(f64, f64)> {
    let spans = times.windows(3).zip(energy.windows(3));
    let rates: Vec<f64> = spans.map(|(t, e)| (e[0] - e[2]) / (t[2] - t[0])).collect();
    let (at, rate) = peak::largest(&rates);
    let before = at as usize;
    let is_inside = at > 0.0 && before + 1 < rates.len();
    let time = |i: usize| 0.5 * (times[i] + times[i + 2]);
    is_inside
        .then(|| (time(before) + (at - before as f64) * (time(before + 1) - time(before)), rate))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u_t + u . grad u + grad p - nu laplace u = 0 at time 0, by differences.
    #[test]
    fn it_solves_the_equations() {
        let scene = TaylorGreen { dims: 2, reynolds: 100.0, resolution: 50.0 };
        let (h, x) = (1e-4, [0.13, 0.37, 0.0]);
        let u = |dx: f64, dy: f64, t: f64| scene.velocity([x[0] + dx, x[1] + dy, 0.0], t);
        let p = |dx: f64, dy: f64| scene.pressure([x[0] + dx, x[1] + dy, 0.0]);
        let here = u(0.0, 0.0, 0.0);
        let pressure = [p(h, 0.0) - p(-h, 0.0), p(0.0, h) - p(0.0, -h)];
        for a in 0..2 {
            let time = (u(0.0, 0.0, h)[a] - u(0.0, 0.0, -h)[a]) / (2.0 * h);
            let along_x = (u(h, 0.0, 0.0)[a] - u(-h, 0.0, 0.0)[a]) / (2.0 * h);
            let along_y = (u(0.0, h, 0.0)[a] - u(0.0, -h, 0.0)[a]) / (2.0 * h);
            let around =
                u(h, 0.0, 0.0)[a] + u(-h, 0.0, 0.0)[a] + u(0.0, h, 0.0)[a] + u(0.0, -h, 0.0)[a];
            let laplacian = (around - 4.0 * here[a]) / (h * h);
            let residual = time + here[0] * along_x + here[1] * along_y + pressure[a] / (2.0 * h)
                - laplacian / scene.reynolds;
            assert!(residual.abs() < 1e-5, "{residual}");
        }
    }

    /// Kinetic energies of `03_tgv3d_re100.csv` from t = 4 to 5.8 every 0.2.
    const ENERGY: [f64; 10] = [
        8.68188451e-02,
        8.42872515e-02,
        8.17278930e-02,
        7.91486603e-02,
        7.65575726e-02,
        7.39628583e-02,
        7.13730075e-02,
        6.87967570e-02,
        6.62429904e-02,
        6.37205645e-02,
    ];

    #[test]
    fn the_peak_of_the_dissipation_is_found_between_samples() {
        let times: Vec<f64> = (0..10).map(|i| 4.0 + 0.2 * f64::from(i)).collect();
        let (time, dissipation) = peak_of_dissipation(&times, &ENERGY).unwrap();
        assert!((time - PEAK_TIME).abs() < 0.02, "{time}");
        // The differences take a mean over 0.4, which is a part in 2000 lower.
        assert!((dissipation / PEAK_DISSIPATION - 1.0).abs() < 1e-3, "{dissipation}");
        assert_eq!(peak_of_dissipation(&times[..4], &ENERGY[..4]), None);
        assert_eq!(peak_of_dissipation(&[], &[]), None);
    }

    /// laplace p = - du_i/dx_j du_j/dx_i in 3-D at time 0, by differences.
    #[test]
    fn the_pressure_in_space_is_that_of_the_velocity() {
        let scene = TaylorGreen { dims: 3, reynolds: 100.0, resolution: 50.0 };
        let (h, x) = (1e-3, [0.13, 0.37, 0.21]);
        let moved = |a: usize, by: f64| {
            let mut moved = x;
            moved[a] += by;
            moved
        };
        let gradient = [0, 1, 2].map(|a| {
            let [p, m] = [h, -h].map(|by| scene.velocity(moved(a, by), 0.0));
            [0, 1, 2].map(|i| (p[i] - m[i]) / (2.0 * h))
        });
        let (mut laplacian, mut source) = (0.0, 0.0);
        for a in 0..3 {
            let [p, m] = [h, -h].map(|by| scene.pressure(moved(a, by)));
            laplacian += (p - 2.0 * scene.pressure(x) + m) / (h * h);
            source -= (0..3).map(|b| gradient[a][b] * gradient[b][a]).sum::<f64>();
        }
        assert!((laplacian - source).abs() < 1e-2, "{laplacian} {source}");
    }
}
