//! When outputs are due.

use crate::clock::Clock;

/// How often something is done, counted from the beginning of time, which is the first time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Every {
    /// After every so many steps, at least 1.
    Steps(u64),
    /// At the first step that has reached each multiple of so much time, positive. The time step
    /// is not changed to hit them.
    Time(f64),
}

impl Every {
    /// How many times something should have been done by now, not counting the beginning.
    fn times(self, step: u64, time: f64) -> u64 {
        match self {
            Self::Steps(n) => step / n,
            // A time that misses a multiple by rounding has reached it.
            Self::Time(interval) => (time * (1.0 + 4.0 * f64::EPSILON) / interval) as u64,
        }
    }
}

/// Keeps track of when something is due.
///
/// It follows from step and time alone, so that a restarted run needs no memory of it.
#[derive(Clone, Debug)]
pub(super) struct Timetable {
    every: Every,
    /// [`Every::times`] when it was done last; `None` before the beginning.
    done: Option<u64>,
}

impl Timetable {
    /// Due at once.
    pub fn new(every: Every) -> Self {
        Self { every, done: None }
    }

    pub fn every(&self) -> Every {
        self.every
    }

    /// All that is due by now has been done.
    pub fn skip(&mut self, clock: &Clock) {
        self.done = Some(self.every.times(clock.step(), clock.time()));
    }

    /// All that was due before this step has been done; what is due at this very step is to be done again.
    pub fn skip_before(&mut self, clock: &Clock) {
        let last = clock.step().checked_sub(1);
        self.done = last.map(|step| self.every.times(step, clock.time_at(step)));
    }

    /// Whether it is due now; it is then taken to be done.
    pub fn take(&mut self, clock: &Clock) -> bool {
        let times = self.every.times(clock.step(), clock.time());
        let due = self.done.is_none_or(|done| times > done);
        self.done = self.done.max(Some(times));
        due
    }

    /// Steps until it is due, at least 1; `within` if that is earlier. The time step stays as it
    /// is for `within` steps.
    pub fn steps_left(&self, clock: &Clock, within: u64) -> u64 {
        // As far as floats count steps one by one.
        let within = within.min(1 << f64::MANTISSA_DIGITS);
        let next = self.done.map_or(0, |done| done + 1);
        let steps = match self.every {
            Every::Steps(n) => next.saturating_mul(n).saturating_sub(clock.step()),
            Every::Time(interval) => {
                let due = |steps: u64| {
                    let step = clock.step() + steps;
                    self.every.times(step, clock.time_at(step)) >= next
                };
                let guess = (next as f64 * interval - clock.time()) / clock.dt();
                if guess > within as f64 + 1.0 {
                    return within;
                }
                let mut steps = (guess.ceil() as u64).max(1);
                while steps > 1 && due(steps - 1) {
                    steps -= 1;
                }
                while !due(steps) {
                    steps += 1;
                }
                steps
            }
        };
        steps.clamp(1, within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Walks `steps` steps of length `dt`, stopping only where it must; the steps when it was due.
    fn walk(every: Every, dt: f64, steps: u64) -> Vec<u64> {
        let mut clock = Clock::new(dt);
        let mut table = Timetable::new(every);
        let mut due = Vec::new();
        loop {
            if table.take(&clock) {
                due.push(clock.step());
            }
            if clock.step() == steps {
                return due;
            }
            clock.advance(table.steps_left(&clock, steps - clock.step()));
        }
    }

    #[test]
    fn every_so_many_steps() {
        assert_eq!(walk(Every::Steps(3), 0.1, 10), [0, 3, 6, 9]);
    }

    #[test]
    fn what_was_due_at_a_step_is_due_there_again() {
        for every in [Every::Steps(3), Every::Time(0.3)] {
            let due = walk(every, 0.1, 10);
            for step in 0..=10 {
                let mut clock = Clock::new(0.1);
                clock.advance(step);
                let mut table = Timetable::new(every);
                table.skip_before(&clock);
                assert_eq!(table.take(&clock), due.contains(&step), "{every:?}, step {step}");
            }
        }
    }

    #[test]
    fn a_multiple_missed_by_rounding_counts() {
        // 3 * 0.1 > 0.3 and 30 * 0.01 == 0.3.
        let due: Vec<u64> = (0..=10).map(|k| 10 * k).collect();
        assert_eq!(walk(Every::Time(0.1), 0.01, 100), due);
    }

    #[test]
    fn the_first_step_past_each_multiple() {
        assert_eq!(walk(Every::Time(1.0), 0.4, 10), [0, 3, 5, 8, 10]);
        assert_eq!(walk(Every::Time(1.0), 2.5, 3), [0, 1, 2, 3]);
    }

    #[test]
    fn going_on_from_any_step_keeps_the_timetable() {
        for every in [Every::Steps(4), Every::Time(0.3)] {
            let all = walk(every, 0.07, 60);
            for step in 0..60 {
                let mut clock = Clock::new(0.07);
                clock.advance(step);
                let mut table = Timetable::new(every);
                table.skip(&clock);
                let next = step + table.steps_left(&clock, 1000);
                let expected = all.iter().find(|&&due| due > step);
                assert!(expected.is_none_or(|&expected| next == expected), "{every:?} {step}");
            }
        }
    }
}
