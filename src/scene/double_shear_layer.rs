//! Two layers of shear in a periodic unit box that roll up (Minion & Brown 1997):
//! `u = tanh(kappa (y - 1/4))` in the lower half, `tanh(kappa (3/4 - y))` in the upper one,
//! `v = 0.05 sin(2 pi (x + 1/4))`.
//!
//! Thin layers on a coarse mesh grow vortices that are not there, half-way between the two that are.

use std::f64::consts::TAU;

use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 3] = [
    Parameter::number("kappa", 30.0, [1.0, 1000.0], "", "steepness of the layers"),
    Parameter::number("reynolds", 1e4, [1.0, 1e7], "", "U L / nu"),
    Parameter::integer("resolution", 128, [8, 4000], "points across the box"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleShearLayer {
    /// Steepness of the layers.
    pub kappa: f64,
    /// Reynolds number.
    pub reynolds: f64,
    /// Points across the box.
    pub resolution: f64,
}

/// Velocity on a square lattice of points, x running fastest.
pub struct Plane {
    /// Points along a side.
    pub side: usize,
    /// Velocity of each.
    pub velocity: Vec<[f64; 2]>,
}

impl DoubleShearLayer {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            kappa: parameters.number("kappa"),
            reynolds: parameters.number("reynolds"),
            resolution: parameters.number("resolution"),
        }
    }

    /// Kinematic viscosity, m^2/s.
    pub fn viscosity(&self) -> f64 {
        1.0 / self.reynolds
    }

    /// Velocity at the start, m/s.
    pub fn velocity(&self, [x, y, _]: [f64; 3]) -> [f64; 3] {
        let y = y.rem_euclid(1.0);
        let from_layer = if y <= 0.5 { y - 0.25 } else { 0.75 - y };
        [(self.kappa * from_layer).tanh(), 0.05 * (TAU * (x + 0.25)).sin(), 0.0]
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Double shear layer, kappa = {}, Re = {}", self.kappa, self.reynolds)
    }

    /// Judges the velocity at the time `t`: `kinetic_energy` (mean of `u . u / 2`), `enstrophy` (mean of
    /// half of the squared vorticity) and the number of `vortices`, which should be two.
    pub fn judge(&self, report: &mut Report, t: f64, plane: &Plane) {
        let is_reference =
            self.kappa == 30.0 && self.reynolds == 1e4 && (t - 1.0).abs() < 0.5 / self.resolution;
        let reference = |value| is_reference.then_some(value);
        report.result("kinetic_energy", plane.kinetic_energy(), reference(KINETIC_ENERGY));
        report.result("enstrophy", plane.enstrophy(), reference(ENSTROPHY));
        report.result("vortices", plane.vortices() as f64, None);
    }
}

/// At t = 1 with kappa = 30, Re = 10^4: pseudo-spectral on 512^2 points, 3e-7 from 256^2
/// (`09_double_shear_layer.csv`).
const KINETIC_ENERGY: f64 = 0.42649076;
const ENSTROPHY: f64 = 34.190947;

impl Plane {
    fn at(&self, x: isize, y: isize) -> [f64; 2] {
        let n = self.side as isize;
        self.velocity[(y.rem_euclid(n) * n + x.rem_euclid(n)) as usize]
    }

    fn places(&self) -> impl Iterator<Item = (isize, isize)> + use<> {
        let n = self.side as isize;
        (0..n * n).map(move |i| (i % n, i / n))
    }

    fn kinetic_energy(&self) -> f64 {
        let sum: f64 = self.velocity.iter().map(|[u, v]| 0.5 * (u * u + v * v)).sum();
        sum / self.velocity.len() as f64
    }

    /// With derivatives by central differences of sixth order.
    fn enstrophy(&self) -> f64 {
        let derivative = |of: &dyn Fn(isize) -> f64| {
            let difference = |n: isize| of(n) - of(-n);
            let sum = 45.0 * difference(1) - 9.0 * difference(2) + difference(3);
            sum * self.side as f64 / 60.0
        };
        let vorticity = |(x, y): (isize, isize)| {
            derivative(&|n| self.at(x + n, y)[1]) - derivative(&|n| self.at(x, y + n)[0])
        };
        let sum: f64 = self.places().map(|place| 0.5 * vorticity(place).powi(2)).sum();
        sum / self.velocity.len() as f64
    }

    /// Closed eddies: places where the stream function is more extreme than at all within three points.
    fn vortices(&self) -> usize {
        let n = self.side as isize;
        let stream = self.stream_function();
        let value = |x: isize, y: isize| stream[(y.rem_euclid(n) * n + x.rem_euclid(n)) as usize];
        // Of equal neighbours, as symmetry makes them, the first is the extreme one.
        let is_most = |x: isize, y: isize, sign: f64| {
            let here = sign * value(x, y);
            (-3..=3).flat_map(|dy| (-3..=3).map(move |dx| (dy, dx))).all(|(dy, dx)| {
                let there = sign * value(x + dx, y + dy);
                if (dy, dx) < (0, 0) { there < here } else { there <= here }
            })
        };
        let is_extreme = |&(x, y): &(isize, isize)| is_most(x, y, 1.0) || is_most(x, y, -1.0);
        self.places().filter(is_extreme).count()
    }

    /// `psi` with `u = d psi / dy`, `v = - d psi / dx`, by sums along the lowest row and up from it.
    fn stream_function(&self) -> Vec<f64> {
        let (n, step) = (self.side as isize, 1.0 / self.side as f64);
        // What a mean of `v` or `u` would add once around is no eddy's.
        let mean_v = (0..n).map(|x| self.at(x, 0)[1]).sum::<f64>() / n as f64;
        let mut stream = vec![0.0; self.velocity.len()];
        let mut base = 0.0;
        for x in 0..n {
            let mean_u = (0..n).map(|y| self.at(x, y)[0]).sum::<f64>() / n as f64;
            let mut sum = base;
            for y in 0..n {
                stream[(y * n + x) as usize] = sum;
                sum += (0.5 * (self.at(x, y)[0] + self.at(x, y + 1)[0]) - mean_u) * step;
            }
            base -= (0.5 * (self.at(x, 0)[1] + self.at(x + 1, 0)[1]) - mean_v) * step;
        }
        stream
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(side: usize, velocity: impl Fn(f64, f64) -> [f64; 2]) -> Plane {
        let at = |i: usize| (i as f64 + 0.5) / side as f64;
        let places = (0..side * side).map(|i| (at(i % side), at(i / side)));
        Plane { side, velocity: places.map(|(x, y)| velocity(x, y)).collect() }
    }

    /// Rows of `09_double_shear_layer.csv` at t = 0.
    #[test]
    fn the_start_is_that_of_the_reference() {
        let scene = DoubleShearLayer { kappa: 30.0, reynolds: 1e4, resolution: 256.0 };
        let start = plane(256, |x, y| {
            let [u, v, _] = scene.velocity([x, y, 0.0]);
            [u, v]
        });
        assert!((start.kinetic_energy() / 0.43395837 - 1.0).abs() < 1e-6);
        assert!((start.enstrophy() / 40.024674 - 1.0).abs() < 1e-5, "{}", start.enstrophy());
        assert_eq!(start.vortices(), 2);
    }

    /// `psi = sin(4 pi x) sin(2 pi y)` has four eddies of each sense.
    #[test]
    fn eddies_are_counted() {
        let eddies = plane(64, |x, y| {
            let (a, b) = (2.0 * TAU * x, TAU * y);
            [TAU * a.sin() * b.cos(), -2.0 * TAU * a.cos() * b.sin()]
        });
        assert_eq!(eddies.vortices(), 8);
    }
}
