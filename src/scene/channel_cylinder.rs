//! Flow past a cylinder in a channel (Schaefer & Turek 1996): 2.2 m x 0.41 m, a cylinder of diameter 0.1 m
//! a little below the middle, a parabola at the inlet, walls above and below.
//!
//! At Re = 20 the flow becomes steady (their case 2D-1), at Re = 100 it sheds vortices (2D-2, but from
//! the parabola at the start and without a ramp).

use finegrain_framework::run::History;
use finegrain_framework::shape::{Axis, Shape};

use super::parameter::{Parameter, Parameters};
use super::peak;
use super::report::Report;

/// Height of the channel, m.
pub const HEIGHT: f64 = 0.41;
/// Its length, m.
pub const LENGTH: f64 = 2.2;
/// Diameter of the cylinder, m.
pub const DIAMETER: f64 = 0.1;
/// Its centre, m.
pub const CENTRE: [f64; 2] = [0.2, 0.2];
/// Kinematic viscosity, m^2/s.
pub const VISCOSITY: f64 = 1e-3;
/// Density, kg/m^3.
pub const DENSITY: f64 = 1.0;

/// Parameters that every method shares.
pub const PARAMETERS: [Parameter; 2] = [
    Parameter::number("reynolds", 20.0, [0.1, 1e4], "", "mean velocity x diameter / viscosity"),
    Parameter::integer("resolution", 82, [20, 4000], "points across the channel"),
];

/// The scene with its parameters set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChannelCylinder {
    /// Reynolds number.
    pub reynolds: f64,
    /// Points across the channel.
    pub resolution: f64,
}

/// Histories of what acts on the cylinder, each sample [`ChannelCylinder::sampling`] later than the one
/// before, or as much more as time steps are longer.
pub struct Loads {
    /// When, s.
    pub time: Vec<f64>,
    /// Drag coefficient.
    pub drag: Vec<f64>,
    /// Lift coefficient.
    pub lift: Vec<f64>,
    /// Pressure before the cylinder less that behind it, Pa.
    pub pressure_difference: Vec<f64>,
}

impl Loads {
    /// Names of the columns of a history that has them.
    pub const COLUMNS: [&'static str; 3] = ["drag", "lift", "pressure_difference"];

    /// From a history.
    pub fn new(history: &History) -> Self {
        let [drag, lift, pressure_difference] = Self::COLUMNS
            .map(|name| history.column(name).map(Iterator::collect).unwrap_or_default());
        Self { time: history.times().to_vec(), drag, lift, pressure_difference }
    }

    /// The means over the time that the mean flow needs for so many `diameters`, ending at each sample.
    #[must_use]
    pub fn averaged(&self, diameters: f64) -> Self {
        let count = ((diameters * SAMPLES as f64) as usize).max(1);
        let means = |values: &[f64]| {
            values.windows(count).map(|late| late.iter().sum::<f64>() / count as f64).collect()
        };
        Self {
            time: self.time.iter().skip(count - 1).copied().collect(),
            drag: means(&self.drag),
            lift: means(&self.lift),
            pressure_difference: means(&self.pressure_difference),
        }
    }

    /// Whether drag and lift have changed by less than the part `tolerance` of the drag in the time that
    /// the mean flow needs for ten diameters.
    pub fn are_steady(&self, tolerance: f64) -> bool {
        let count = 10 * SAMPLES;
        let is_still = |values: &[f64]| {
            let late = &values[values.len() - count..];
            let range = peak::largest(late).1 - peak::least(late).1;
            range < tolerance * self.drag[self.drag.len() - 1].abs()
        };
        self.drag.len() > count && is_still(&self.drag) && is_still(&self.lift)
    }
}

/// Samples of the loads in the time that the mean flow needs for a diameter.
const SAMPLES: usize = 40;

impl ChannelCylinder {
    /// From the scene's parameters.
    pub fn new(parameters: &Parameters) -> Self {
        Self {
            reynolds: parameters.number("reynolds"),
            resolution: parameters.number("resolution"),
        }
    }

    /// Mean velocity at the inlet, m/s.
    pub fn mean_velocity(&self) -> f64 {
        self.reynolds * VISCOSITY / DIAMETER
    }

    /// Velocity at the inlet, m/s, and everywhere at the start.
    pub fn inflow(&self, [_, y, _]: [f64; 3]) -> [f64; 3] {
        [6.0 * self.mean_velocity() * y * (HEIGHT - y) / (HEIGHT * HEIGHT), 0.0, 0.0]
    }

    /// The largest speed anywhere, about, m/s: beside the cylinder.
    pub fn largest_speed(&self) -> f64 {
        2.25 * self.mean_velocity()
    }

    /// The cylinder.
    pub fn body(&self) -> Shape {
        let centre = [CENTRE[0], CENTRE[1], 0.0];
        Shape::Cylinder { axis: Axis::Z, centre, radius: 0.5 * DIAMETER }
    }

    /// Whether the wake sheds vortices.
    pub fn is_unsteady(&self) -> bool {
        self.reynolds > UNSTEADY
    }

    /// When the flow should be steady, or periodic for long, s: 60 diameters, or 80 if it must become
    /// unsteady first.
    pub fn end_time(&self) -> f64 {
        let diameters = if self.is_unsteady() { 80.0 } else { 60.0 };
        diameters * DIAMETER / self.mean_velocity()
    }

    /// Time between samples of the loads, s.
    pub fn sampling(&self) -> f64 {
        DIAMETER / (self.mean_velocity() * SAMPLES as f64)
    }

    /// Drag or lift coefficient of a force, N/m.
    pub fn coefficient(&self, force: f64) -> f64 {
        2.0 * force / (DENSITY * self.mean_velocity().powi(2) * DIAMETER)
    }

    /// Of pictures.
    pub fn title(&self) -> String {
        format!("Flow past a cylinder in a channel, Re = {}", self.reynolds)
    }

    /// Judges the loads; they are steady if they change by less than the part `tolerance`. Steady: `drag`, `lift` and `pressure_difference`. Periodic: `largest_drag`,
    /// `largest_lift` and `strouhal` (frequency x diameter / mean velocity) of the last quarter.
    pub fn judge(&self, report: &mut Report, loads: &Loads, tolerance: f64) {
        let (Some(&drag), Some(&lift), Some(&difference)) =
            (loads.drag.last(), loads.lift.last(), loads.pressure_difference.last())
        else {
            return;
        };
        if self.is_unsteady() {
            let late = |values: &[f64]| values[values.len() * 3 / 4..].to_vec();
            let (time, drag, lift) = (late(&loads.time), late(&loads.drag), late(&loads.lift));
            report.result("largest_drag", peak::largest(&drag).1, None);
            report.result("largest_lift", peak::largest(&lift).1, None);
            let turnover = DIAMETER / self.mean_velocity();
            match period(&time, &lift) {
                Some(period) => report.result("strouhal", turnover / period, None),
                None => report.notes.push("not periodic: there is no frequency".to_owned()),
            }
            return;
        }
        let is_steady = loads.are_steady(tolerance);
        if !is_steady {
            report.notes.push("not steady: no errors are given".to_owned());
        }
        let reference = |value| (is_steady && self.reynolds == 20.0).then_some(value);
        report.result("drag", drag, reference(DRAG));
        report.result("lift", lift, reference(LIFT));
        report.result("pressure_difference", difference, reference(PRESSURE_DIFFERENCE));
    }
}

/// Above this Reynolds number the wake is not steady: the onset is near 49 without walls (Williamson
/// 1996), and later between these walls.
const UNSTEADY: f64 = 60.0;

/// Case 2D-1 (`05_schaefer_turek.csv`): spectral by Nabh (1998), the drag and lift also by Hron.
const DRAG: f64 = 5.57953523384;
const LIFT: f64 = 0.010618948146;
const PRESSURE_DIFFERENCE: f64 = 0.11752016697;

/// Mean time between upward passages through the mean, of samples at these times; `None` if there are fewer than three
/// passages, or they are not within 5 % as far from each other.
fn period(times: &[f64], values: &[f64]) -> Option<f64> {
    let middle = 0.5 * (peak::largest(values).1 + peak::least(values).1);
    let mut passages = Vec::new();
    for (pair, time) in values.windows(2).zip(times.windows(2)) {
        let [before, after] = [pair[0] - middle, pair[1] - middle];
        if before < 0.0 && after >= 0.0 {
            passages.push(time[0] - (time[1] - time[0]) * before / (after - before));
        }
    }
    let gaps: Vec<f64> = passages.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
    let is_even = gaps.iter().all(|gap| (gap / mean - 1.0).abs() < 0.05);
    (gaps.len() >= 2 && is_even).then_some(mean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_flow_is_that_of_the_benchmark() {
        // u = 4 U_m y (H - y) / H^2 with U_m = 0.3 m/s (2D-1) and 1.5 m/s (2D-2).
        for (reynolds, top) in [(20.0, 0.3), (100.0, 1.5)] {
            let scene = ChannelCylinder { reynolds, resolution: 82.0 };
            let at = |y| scene.inflow([0.0, y, 0.0])[0];
            assert!((at(0.5 * HEIGHT) - top).abs() < 1e-15 && at(0.0) == 0.0 && at(HEIGHT) == 0.0);
            // c = 2 F / (rho U^2 D) with U = 2/3 U_m.
            let coefficient = 2.0 / (0.1 * (top * 2.0 / 3.0) * (top * 2.0 / 3.0));
            assert!((scene.coefficient(1.0) / coefficient - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn noise_is_averaged_away_and_a_drift_is_not() {
        let loads = |drift: f64| {
            let noise = |i: u32| if i.is_multiple_of(2) { 0.5 } else { -0.5 };
            let noisy = |i: u32| 5.0 + noise(i) + drift * f64::from(i);
            let drag: Vec<f64> = (0..2000).map(noisy).collect();
            let time = (0..2000).map(f64::from).collect();
            Loads { time, lift: drag.clone(), pressure_difference: drag.clone(), drag }
        };
        assert!(!loads(0.0).are_steady(0.02));
        let averaged = loads(0.0).averaged(10.0);
        assert!(averaged.are_steady(1e-12) && (averaged.drag[7] - 5.0).abs() < 1e-12);
        assert!(!loads(1e-3).averaged(10.0).are_steady(0.02));
    }

    #[test]
    fn a_period_is_found_between_samples() {
        // Not evenly apart.
        let times: Vec<f64> = (0..400).map(|i| f64::from(i) + 0.3 * f64::from(i % 3)).collect();
        let wave: Vec<f64> = times.iter().map(|time| 0.3 + (time * 0.0613).sin()).collect();
        let found = period(&times, &wave).unwrap();
        assert!((found / (std::f64::consts::TAU / 0.0613) - 1.0).abs() < 1e-4, "{found}");
        assert_eq!(period(&times, &wave[..150]), None);
        let chirp: Vec<f64> = times.iter().map(|time| (time * time * 0.0005).sin()).collect();
        assert_eq!(period(&times, &chirp), None);
    }
}
