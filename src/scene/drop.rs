//! A round drop of inviscid fluid in the plane, with a free surface and a velocity that draws it
//! out to an ellipse: alone (Monaghan 1994), or held together by a central force
//! `-omega^2 (x, y)`, in which it swings (Monaghan & Rafiee 2013).
//!
//! The velocity stays `u = -A x`, `v = A y` and the drop an ellipse with semi-axes `a` and `b`:
//! an exact solution, with three ordinary differential equations for `A`, `a` and `b`. From the
//! momentum equation the pressure is
//! `rho/2 (A^2 - A' + omega^2) a^2 (1 - (x/a)^2 - (y/b)^2)`; that it must be the same along both
//! axes gives `A' = (A^2 + omega^2) (a^2 - b^2) / (a^2 + b^2)`.

use super::parameter::{Parameter, Parameters};

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 1] =
    [Parameter::integer("resolution", 40, [8, 1000], "points along the radius of the drop")];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    /// Density, kg/m^3.
    pub density: f64,
    /// Radius at the beginning, m.
    pub radius: f64,
    /// `A` at the beginning, 1/s.
    pub strain_rate: f64,
    /// `omega` of the central force, 1/s; 0 without.
    pub frequency: f64,
    /// Points along the radius.
    pub resolution: f64,
}

/// The drop at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// `A`, 1/s.
    pub strain_rate: f64,
    /// Semi-axes along x and y, m.
    pub semi_axes: [f64; 2],
}

impl Drop {
    /// Water without a force (Monaghan 1994, section 5.1).
    pub fn elliptic(parameters: &Parameters) -> Self {
        Self {
            density: 1000.0,
            radius: 1.0,
            strain_rate: 100.0,
            frequency: 0.0,
            resolution: parameters.number("resolution"),
        }
    }

    /// In scaled units, with as much kinetic energy at the beginning as potential energy.
    pub fn oscillating(parameters: &Parameters) -> Self {
        Self {
            density: 1.0,
            radius: 1.0,
            strain_rate: 1.0,
            frequency: 1.0,
            resolution: parameters.number("resolution"),
        }
    }

    /// Velocity at the beginning.
    pub fn velocity(&self, [x, y, _]: [f64; 3]) -> [f64; 3] {
        [-self.strain_rate * x, self.strain_rate * y, 0.0]
    }

    /// Acceleration by the central force.
    pub fn acceleration(&self, [x, y, _]: [f64; 3]) -> [f64; 3] {
        let factor = -self.frequency * self.frequency;
        [factor * x, factor * y, 0.0]
    }

    /// Potential of the central force, J/kg.
    pub fn potential(&self, [x, y, _]: [f64; 3]) -> f64 {
        0.5 * self.frequency * self.frequency * (x * x + y * y)
    }

    /// Pressure at the beginning, Pa.
    pub fn pressure(&self, [x, y, _]: [f64; 3]) -> f64 {
        let squares = self.strain_rate.powi(2) + self.frequency.powi(2);
        0.5 * self.density * squares * (self.radius * self.radius - x * x - y * y)
    }

    /// The exact ellipse at a time.
    pub fn ellipse(&self, time: f64) -> Ellipse {
        let omega2 = self.frequency * self.frequency;
        let slope = |[rate, a, b]: [f64; 3]| {
            let (a2, b2) = (a * a, b * b);
            [(rate * rate + omega2) * (a2 - b2) / (a2 + b2), -rate * a, rate * b]
        };
        let steps = (time * self.strain_rate.max(self.frequency) * 1000.0).ceil().max(1.0);
        let dt = time / steps;
        let mut y = [self.strain_rate, self.radius, self.radius];
        for _ in 0..steps as u64 {
            let along = |k: [f64; 3], dt: f64| [0, 1, 2].map(|n| y[n] + dt * k[n]);
            let k1 = slope(y);
            let k2 = slope(along(k1, 0.5 * dt));
            let k3 = slope(along(k2, 0.5 * dt));
            let k4 = slope(along(k3, dt));
            y = [0, 1, 2].map(|n| y[n] + dt / 6.0 * (k1[n] + 2.0 * (k2[n] + k3[n]) + k4[n]));
        }
        Ellipse { strain_rate: y[0], semi_axes: [y[1], y[2]] }
    }

    /// Period of the drop in the central force with `A = omega` at the beginning, s.
    pub fn period(&self) -> f64 {
        PERIOD / self.frequency
    }
}

/// `omega` times the period for `A = omega` at the beginning, computed from the equations above
/// by an independent integration (eighth order, tolerance 1e-12); the literature has 4.827.
const PERIOD: f64 = 4.827343;

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of tables computed independently (eighth-order integration, tolerance 1e-12).
    #[test]
    fn it_follows_the_tables() {
        let alone = Drop {
            density: 1000.0,
            radius: 1.0,
            strain_rate: 100.0,
            frequency: 0.0,
            resolution: 40.0,
        };
        let swings = Drop { density: 1.0, strain_rate: 1.0, frequency: 1.0, ..alone };
        for (drop, time, rate, a, b) in [
            (alone, 0.004, 87.5101223, 0.6826992589, 1.464773818),
            (alone, 0.007, 72.95235205, 0.5368476123, 1.86272599),
            (swings, 1.2, 0.005919981077, 0.517648564, 1.931812564),
            (swings, 3.6, -0.01776104963, 1.931499877, 0.5177323652),
        ] {
            let ellipse = drop.ellipse(time);
            assert!((ellipse.strain_rate - rate).abs() < 1e-6 * drop.strain_rate);
            assert!((ellipse.semi_axes[0] / a - 1.0).abs() < 1e-8);
            assert!((ellipse.semi_axes[1] / b - 1.0).abs() < 1e-8);
        }
        assert!((alone.pressure([0.0; 3]) - 5e6).abs() < 1e-6);
        let [a, b] = swings.ellipse(swings.period()).semi_axes;
        assert!((a - 1.0).abs() < 1e-5 && (b - 1.0).abs() < 1e-5);
    }
}
