//! A square patch of inviscid fluid, free on all sides, that rotates as if it were solid at the
//! beginning (Colagrossi 2005; Le Touze et al. 2013). The pressure is negative throughout: methods
//! of particles tear it apart unless they do something about it.

use std::f64::consts::PI;

use super::parameter::{Parameter, Parameters};

/// Density, kg/m^3.
pub const DENSITY: f64 = 1000.0;
/// Side of the square, m; its centre is the origin.
pub const SIDE: f64 = 1.0;
/// Angular velocity at the beginning, 1/s, clockwise.
pub const ANGULAR_VELOCITY: f64 = 1.0;
/// Pressure at the centre at the beginning over `rho omega^2 L^2` (from the double Fourier series).
pub const CENTRE_PRESSURE: f64 = -0.14734271;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 1] =
    [Parameter::integer("resolution", 60, [10, 2000], "points along a side of the square")];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotatingPatch {
    /// Points along a side.
    pub resolution: f64,
}

impl RotatingPatch {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self { resolution: parameters.number("resolution") }
    }

    /// Velocity at the beginning.
    pub fn velocity(&self, [x, y, _]: [f64; 3]) -> [f64; 3] {
        [ANGULAR_VELOCITY * y, -ANGULAR_VELOCITY * x, 0.0]
    }

    /// Pressure at the beginning, Pa: the solution of `laplace p = 2 rho omega^2` with `p = 0` on
    /// the surface, as a sum over odd n of `sin(n pi s) cosh(n pi y / L)`, `s = x / L + 1/2`.
    pub fn pressure(&self, [x, y, _]: [f64; 3]) -> f64 {
        let (s, t) = (x / SIDE + 0.5, y / SIDE);
        let series: f64 = (0..60)
            .map(|k| {
                let n = f64::from(2 * k + 1) * PI;
                // cosh(n t) / cosh(n / 2) without overflow.
                let ratio = ((n * (t.abs() - 0.5)).exp() + (-n * (t.abs() + 0.5)).exp())
                    / (1.0 + (-n).exp());
                (n * s).sin() * ratio / n.powi(3)
            })
            .sum();
        let scale = DENSITY * (ANGULAR_VELOCITY * SIDE).powi(2);
        -scale * (s * (1.0 - s) - 8.0 * series)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a table from the double Fourier series, x and y from a corner.
    #[test]
    fn pressure_follows_the_table() {
        let patch = RotatingPatch { resolution: 60.0 };
        for (x, y, expected) in [
            (0.5, 0.5, CENTRE_PRESSURE),
            (0.05, 0.1, -0.01485351278),
            (0.25, 0.25, -0.09057231052),
            (0.4, 0.1, -0.05643419566),
        ] {
            let p = patch.pressure([x - 0.5, y - 0.5, 0.0]) / DENSITY;
            assert!((p - expected).abs() < 1e-7, "{p} at {x}, {y}");
        }
    }
}
