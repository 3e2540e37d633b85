//! Time, computed from the number of the step; no rounding adds up.

use crate::stage::Moment;

/// Where a run is in time.
///
/// While the time step stays the same, step `n` begins at `origin_time + (n - origin_step) dt`:
/// one rounding, however many steps. Where the time step changes, the origin moves, and what its
/// rounding leaves over is kept. A step that is to hit a given time does so exactly.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Clock {
    step: u64,
    origin_step: u64,
    origin_time: f64,
    /// What rounding has left over of the origin's time.
    origin_rest: f64,
    dt: f64,
    /// A step that begins at a given time, whatever rounding would make of it.
    aim: Option<(u64, f64)>,
}

impl Clock {
    /// Step 0 at time 0.
    pub fn new(dt: f64) -> Self {
        Self { step: 0, origin_step: 0, origin_time: 0.0, origin_rest: 0.0, dt, aim: None }
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
        self.origin_time + (self.steps_since_origin(step) * self.dt + self.origin_rest)
    }

    /// The moment of a stage at `t + c dt` of step `step`.
    pub fn moment(&self, step: u64, c: f64) -> Moment {
        let time = self.time_at(step);
        Moment { step, time, dt: self.dt, stage_time: time + c * self.dt }
    }

    /// Goes on with another time step; the origin moves here only if it differs.
    pub fn set_dt(&mut self, dt: f64) {
        if dt != self.dt {
            self.move_origin();
            self.dt = dt;
        }
    }

    /// The present step becomes the origin.
    fn move_origin(&mut self) {
        let time = self.time();
        if self.aim == Some((self.step, time)) {
            self.origin_rest = 0.0;
        } else {
            // The rounding errors of product and sum, without error (Dekker 1971, Knuth's TAOCP 4.2.2).
            let steps = self.steps_since_origin(self.step);
            let span = steps * self.dt;
            let sum = self.origin_time + span;
            let added = sum - self.origin_time;
            let of_sum = (self.origin_time - (sum - added)) + (span - added);
            let rest = of_sum + (steps.mul_add(self.dt, -span) + self.origin_rest);
            self.origin_rest = (sum - time) + rest;
        }
        (self.origin_time, self.origin_step) = (time, self.step);
    }

    fn steps_since_origin(&self, step: u64) -> f64 {
        step as f64 - self.origin_step as f64
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

    /// Against sums of whole numbers of 2^-60.
    #[test]
    fn a_time_step_that_changes_rounds_once_too() {
        let mut clock = Clock::new(0.0);
        let mut exact = 0_i128;
        for pace in 0..100_000_u64 {
            let (unit, steps) = ((1 << 52) + pace.wrapping_mul(0x9e37_79b9) % (1 << 51), pace % 7);
            clock.set_dt(unit as f64 * 0.5_f64.powi(60));
            clock.advance(steps);
            exact += i128::from(unit * steps);
            let exact = exact as f64 * 0.5_f64.powi(60);
            assert!((clock.time() - exact).abs() <= f64::EPSILON * exact, "after pace {pace}");
        }
        let end = clock.time() + 0.1;
        clock.aim(3, end);
        clock.advance(3);
        clock.set_dt(0.25);
        assert_eq!((clock.time(), clock.origin_rest), (end, 0.0));
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
