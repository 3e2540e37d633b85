//! Taylor-Green vortices decaying in a periodic unit box, with density 1 and largest speed 1.
//!
//! In 2-D this is an exact solution of the Navier-Stokes equations:
//! `u = -e(t) cos(2 pi x) sin(2 pi y)`, `v = e(t) sin(2 pi x) cos(2 pi y)` with
//! `e = exp(-8 pi^2 t / Re)`. In 3-D (Taylor & Green 1937) only the beginning is known.

use std::f64::consts::{PI, TAU};

use super::parameter::{Parameter, Parameters};
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

    /// Rate at which the exact velocity decays in 2-D.
    pub fn decay_rate(&self) -> f64 {
        8.0 * PI * PI / self.reynolds
    }
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
