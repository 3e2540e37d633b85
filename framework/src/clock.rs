//! Time, computed from the number of the step and never accumulated.

use crate::stage::Moment;

/// Where a run is in time.
///
/// While the time step stays the same, step `n` begins at `origin_time + (n - origin_step) dt`:
/// one rounding, however many steps.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Clock {
    step: u64,
    origin_step: u64,
    origin_time: f64,
    dt: f64,
}

impl Clock {
    /// Step 0 at time 0.
    pub fn new(dt: f64) -> Self {
        Self { step: 0, origin_step: 0, origin_time: 0.0, dt }
    }

    /// Number of steps done.
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Present time step.
    pub fn dt(&self) -> f64 {
        self.dt
    }

    /// Present time.
    pub fn time(&self) -> f64 {
        self.time_at(self.step)
    }

    /// Time at the beginning of step `step`, if dt stays as it is.
    pub fn time_at(&self, step: u64) -> f64 {
        self.origin_time + (step as f64 - self.origin_step as f64) * self.dt
    }

    /// The moment of a stage at `t + c dt` of step `step`.
    pub fn moment(&self, step: u64, c: f64) -> Moment {
        let time = self.time_at(step);
        Moment { step, time, dt: self.dt, stage_time: time + c * self.dt }
    }

    /// Goes on with another time step; the origin moves here only if it differs.
    pub fn set_dt(&mut self, dt: f64) {
        if dt != self.dt {
            self.origin_time = self.time();
            self.origin_step = self.step;
            self.dt = dt;
        }
    }

    /// `steps` steps have been done.
    pub fn advance(&mut self, steps: u64) {
        self.step += steps;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_steps_round_once() {
        let mut clock = Clock::new(0.1);
        clock.advance(1_000_000);
        assert_eq!(clock.time(), 100_000.0);
        clock.set_dt(0.25);
        clock.advance(2);
        assert_eq!(clock.time(), 100_000.5);
        assert_eq!(clock.moment(clock.step(), 0.5).stage_time, 100_000.625);
    }
}
