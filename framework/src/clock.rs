//! Time, computed from the number of the step and never accumulated.

use crate::stage::Moment;

/// Where a run is in time.
///
/// While the time step stays the same, step `n` begins at `origin_time + (n - origin_step) dt`:
/// one rounding, however many steps. A step that is to hit a given time does so exactly.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Clock {
    step: u64,
    origin_step: u64,
    origin_time: f64,
    dt: f64,
    /// A step that begins at a given time, whatever rounding would make of it.
    aim: Option<(u64, f64)>,
}

impl Clock {
    /// Step 0 at time 0.
    pub fn new(dt: f64) -> Self {
        Self { step: 0, origin_step: 0, origin_time: 0.0, dt, aim: None }
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
        if let Some((aim, time)) = self.aim
            && aim == step
        {
            return time;
        }
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

    /// The step that follows `steps` more begins at `time`, which is what the time step gives but
    /// for rounding.
    pub fn aim(&mut self, steps: u64, time: f64) {
        self.aim = Some((self.step + steps, time));
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

    #[test]
    fn an_end_is_hit_to_the_bit() {
        for (end, steps) in [(1.1, 49), (1.0, 3), (0.7, 6)] {
            let mut clock = Clock::new(end / steps as f64);
            clock.aim(steps, end);
            clock.advance(steps);
            assert_eq!(clock.time(), end);
        }
    }
}
