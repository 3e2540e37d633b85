//! Collapse of a column of water, twice as high as wide (Martin & Moyce 1952).

use super::parameter::{Parameter, Parameters};
use super::tank::{GRAVITY, Tank};

/// Width of the column, m.
pub const WIDTH: f64 = 1.0;
/// Height of the column, m.
pub const HEIGHT: f64 = 2.0;

/// Front of the water over the width of the column against time times `sqrt(2 g / width)`, in the
/// experiment (Martin & Moyce 1952, n^2 = 2, columns 2.25 in wide; as stored with DualSPHysics,
/// file `EXP_X-DamTipPosition_Koshizula&Oka1996.txt`, which agrees with their table within 1.5 %).
pub const FRONT: [(f64, f64); 15] = [
    (0.4076491003, 1.128),
    (0.8446945262, 1.244),
    (1.17975269, 1.464),
    (1.42692183, 1.695),
    (1.630296435, 1.903),
    (1.833571053, 2.123),
    (1.978152998, 2.365),
    (2.196125779, 2.584),
    (2.311511375, 2.804),
    (2.500987717, 3.034),
    (2.631171461, 3.219),
    (2.819747912, 3.462),
    (2.964429847, 3.704),
    (3.110111659, 3.9),
    (3.32798445, 4.132),
];

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::integer("resolution", 30, [8, 1000], "points along the width of the column"),
    Parameter::number("length", 5.0, [4.5, 20.0], "m", "length of the tank"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DamBreak {
    /// The tank.
    pub tank: Tank,
    /// Points along the width of the column.
    pub resolution: f64,
}

impl DamBreak {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        // Spray of the impact on the far wall leaves it at 1.5 times the speed of the front: it goes
        // over walls of three times this height and comes down outside of them.
        let tank = Tank { width: parameters.number("length"), height: 6.0 * HEIGHT };
        Self { tank, resolution: parameters.number("resolution") }
    }

    /// Largest speed of the flow, m/s, about: `2 sqrt(g H)`, of a dry front (Ritter 1892).
    pub fn speed(&self) -> f64 {
        2.0 * (GRAVITY * HEIGHT).sqrt()
    }

    /// Unit of time of the experiment, s.
    pub fn time(&self) -> f64 {
        (WIDTH / (2.0 * GRAVITY)).sqrt()
    }

    /// Pressure over the density at the beginning, before the gate is gone, m^2/s^2: that of a
    /// column with pressure zero on its free sides, as half a Fourier series in x:
    /// `laplace p = 0`, `p = 0` above and on the right, `dp/dy = -rho g` below, `dp/dx = 0` left.
    pub fn pressure(&self, [x, y, _]: [f64; 3]) -> f64 {
        let series = |n: u32| {
            // Odd modes cos(k x) that vanish at the gate.
            let k = (f64::from(n) + 0.5) * std::f64::consts::PI / WIDTH;
            let sign = if n.is_multiple_of(2) { 1.0 } else { -1.0 };
            let below = (-k * y).exp() - (-k * (2.0 * HEIGHT - y)).exp();
            2.0 * sign * (k * x).cos() * below / (k * k * WIDTH * (1.0 + (-2.0 * k * HEIGHT).exp()))
        };
        GRAVITY * (0..200).map(series).sum::<f64>()
    }

    /// Largest relative difference of the front from the experiment, after the shift in time, of
    /// at most half a unit either way, that makes it least: the gate takes its time. `front` gives
    /// time and position in the experiment's units, and must reach beyond its end.
    ///
    /// Rows before `since`, by the time of the experiment, do not count: while the gate still
    /// rises, water shoots out under it, which no shift in time makes up for.
    pub fn front_error(front: &[(f64, f64)], since: f64) -> Option<FrontError> {
        let shifts = (-100..=100).map(|k| 0.005 * f64::from(k));
        let error_at = |shift: f64| {
            let mut most = 0.0f64;
            for (time, position) in FRONT.into_iter().filter(|&(time, _)| time >= since) {
                most = most.max((interpolate(front, time + shift)? / position - 1.0).abs());
            }
            Some(FrontError { error: most, shift })
        };
        shifts.filter_map(error_at).min_by(|a, b| a.error.total_cmp(&b.error))
    }
}

/// How well a front follows the experiment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontError {
    /// Largest relative difference.
    pub error: f64,
    /// The front is later than that of the experiment by this time, in its units.
    pub shift: f64,
}

/// Piecewise linear; before the beginning the first value, after the end nothing.
fn interpolate(points: &[(f64, f64)], at: f64) -> Option<f64> {
    let next = points.iter().position(|&(time, _)| time >= at)?;
    let (t1, x1) = points[next];
    if next == 0 {
        return Some(x1);
    }
    let (t0, x0) = points[next - 1];
    Some(x0 + (x1 - x0) * (at - t0) / (t1 - t0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_of_the_experiment_itself_has_no_error() {
        let late: Vec<_> = [(0.0, 1.0)]
            .into_iter()
            .chain(FRONT.map(|(time, x)| (time + 0.1, x)))
            .chain([(4.0, 5.0)])
            .collect();
        let found = DamBreak::front_error(&late, 0.0).unwrap();
        assert!(found.error < 1e-9 && (found.shift - 0.1).abs() < 1e-9, "{found:?}");
        assert_eq!(DamBreak::front_error(&late[..5], 0.0), None);
    }

    #[test]
    fn the_pressure_at_the_start_solves_laplaces_equation() {
        let dam = DamBreak { tank: Tank { width: 5.0, height: 4.0 }, resolution: 30.0 };
        let p = |x: f64, y: f64| dam.pressure([x, y, 0.0]);
        assert!(p(0.4, HEIGHT).abs() < 1e-9 && p(WIDTH, 0.7).abs() < 1e-9);
        let h = 1e-3;
        let slope = (p(0.4, h) - p(0.4, 0.0)) / h;
        assert!((slope / -GRAVITY - 1.0).abs() < 0.02, "{slope}");
        let sum = p(0.4 + h, 0.7) + p(0.4 - h, 0.7) + p(0.4, 0.7 + h) + p(0.4, 0.7 - h);
        assert!((sum - 4.0 * p(0.4, 0.7)).abs() < 1e-6 * h);
    }
}
