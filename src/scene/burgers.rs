//! Burgers' equation, `u_t + u u_x = nu u_xx` from `u = -sin(pi x)` between ends at rest, -1 and 1, with
//! `nu = 0.01 / pi`: a wave that steepens until viscosity holds it (Basdevant et al. 1986). The slope in the
//! middle becomes 152.00516 in size at `pi t = 1.6037`.

use std::f64::consts::PI;

use super::parameter::{Parameter, Parameters};
use super::report::Report;

/// Viscosity, m^2/s.
pub const VISCOSITY: f64 = 0.01 / PI;
/// The end, s: some time after the slope was largest.
pub const TIME: f64 = 0.6;
/// Size of the largest slope, 1/s, and when it is reached, s.
pub const LARGEST_SLOPE: [f64; 2] = [152.00516, 1.6037 / PI];

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 1] = [Parameter::integer(
    "resolution",
    1201,
    [21, 20_001],
    "points from -1 to 1; odd, to have one at 0",
)];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steepening {
    /// Points from -1 to 1.
    pub resolution: usize,
}

impl Steepening {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self { resolution: parameters.number("resolution") as usize }
    }

    /// Velocity at the beginning, m/s.
    pub fn start(&self, x: f64) -> f64 {
        -(PI * x).sin()
    }

    /// Velocity, m/s, at a time > 0: the integral of Cole & Hopf, by the trapezoidal rule, which converges
    /// faster than any power.
    pub fn velocity(&self, x: f64, time: f64) -> f64 {
        let width = (4.0 * VISCOSITY * time).sqrt();
        let (mut above, mut below) = (0.0, 0.0);
        let points = 4000;
        for k in -points..=points {
            // The integrand is widest where the potential, up to exp(100), outweighs the Gaussian.
            let eta = 12.0 * f64::from(k) / f64::from(points);
            let y = x - width * eta;
            let weight = (-eta * eta - ((PI * y).cos() + 1.0) / (2.0 * PI * VISCOSITY)).exp();
            above += (PI * y).sin() * weight;
            below += weight;
        }
        -above / below
    }

    /// Judges velocities at points, at a time > 0, and the history of the slope's size in the middle: times and
    /// values. `largest_slope` and `slope_time`; `velocity_l2`, relative to the exact velocity's norm.
    pub fn judge(
        &self,
        report: &mut Report,
        time: f64,
        velocities: impl Iterator<Item = (f64, f64)>,
        slopes: impl Iterator<Item = (f64, f64)>,
    ) {
        let (mut difference, mut norm) = (0.0, 0.0);
        for (x, u) in velocities {
            let exact = self.velocity(x, time);
            difference += (u - exact).powi(2);
            norm += exact * exact;
        }
        report.error("velocity_l2", (difference / norm).sqrt());
        let largest = slopes.max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((at, slope)) = largest.filter(|_| time > LARGEST_SLOPE[1]) {
            report.result("largest_slope", slope, Some(LARGEST_SLOPE[0]));
            report.result("slope_time", at, Some(LARGEST_SLOPE[1]));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows (t, x, u) of `08_burgers_basdevant.csv`.
    const ROWS: &[(f64, f64, f64)] = &[
        (0.1, 0.025, -0.113400464048),
        (0.1, 0.5, -0.952789795476),
        (0.25, 0.06, -0.601754698615),
        (0.25, 0.85, -0.26153498928),
        (0.5104735645, 0.095, -0.955327285995),
        (0.75, 0.015, -0.835050318698),
        (0.75, 0.4, -0.550380284581),
        (1.0, 0.05, -0.700027080879),
        (1.0, 0.75, -0.188998095308),
    ];

    #[test]
    fn the_integral_is_that_of_the_reference() {
        let scene = Steepening { resolution: 801 };
        for &(t, x, u) in ROWS {
            let computed = scene.velocity(x, t);
            assert!((computed - u).abs() < 1e-9, "{computed} for {u} at {x}, {t}");
        }
    }
}
