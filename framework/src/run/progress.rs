//! How far a run is, and how fast.

use std::time::{Duration, Instant};

use super::Until;
use crate::clock::Clock;

/// How far a run is; an event that the run posts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Number of steps done since the beginning of time.
    pub step: u64,
    /// Time.
    pub time: f64,
    /// Steps per second of wall clock since the last such event.
    pub steps_per_second: f64,
    /// How much of the run is done, 0 to 1; `None` if only a criterion or a request ends it.
    pub fraction: Option<f64>,
    /// How long it will take at this speed; `None` as for the fraction.
    pub remaining: Option<Duration>,
}

/// How long the workers run without coming back, if nothing else wants them to: short for a
/// person who asks to stop, long against a meeting.
const LEG: Duration = Duration::from_millis(50);

/// Wall-clock time of a run, read once a leg.
#[derive(Debug)]
pub(super) struct Stopwatch {
    begun: Instant,
    elapsed: Duration,
    /// Steps of a leg that takes some [`LEG`].
    stride: u64,
    steps: u64,
    /// `elapsed` and `steps` at the last report.
    reported: (Duration, u64),
}

impl Stopwatch {
    pub fn start() -> Self {
        let (begun, elapsed) = (Instant::now(), Duration::ZERO);
        Self { begun, elapsed, stride: 1, steps: 0, reported: (elapsed, 0) }
    }

    pub fn elapsed(&self) -> Duration {
        self.elapsed
    }

    /// Steps done since the start.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Reads the clock, without a leg.
    pub fn read(&mut self) -> Duration {
        self.elapsed = self.begun.elapsed();
        self.elapsed
    }

    /// Most steps of the next leg: of a schedule that meets every `meeting` steps, whole meetings.
    pub fn stride(&self, meeting: u64) -> u64 {
        (self.stride / meeting).max(1).saturating_mul(meeting)
    }

    /// A leg of `steps` steps is done.
    pub fn lap(&mut self, steps: u64) {
        let before = self.elapsed;
        let leg = (self.read() - before).as_secs_f64();
        self.steps += steps;
        // A float too large for an integer becomes the largest one.
        let affordable = (steps as f64 * LEG.as_secs_f64() / leg) as u64;
        self.stride = affordable.min(self.stride.saturating_mul(2)).max(1);
    }

    /// The progress, if the last report was `at_least` ago.
    pub fn report(&mut self, at_least: Duration, clock: &Clock, until: &Until) -> Option<Progress> {
        let (elapsed, steps) = self.reported;
        let seconds = self.elapsed.saturating_sub(elapsed);
        if self.steps == steps || seconds < at_least {
            return None;
        }
        self.reported = (self.elapsed, self.steps);
        let speed = (self.steps - steps) as f64 / seconds.as_secs_f64().max(1e-9);
        let step = clock.step();
        // How much is done, and how many seconds the rest takes.
        let limits = [
            until.steps.map(|end| (step as f64 / end as f64, (end as f64 - step as f64) / speed)),
            until.time.map(|end| (clock.time() / end, (end - clock.time()) / clock.dt() / speed)),
            until.wall_clock.map(|end| {
                let (end, now) = (end.as_secs_f64(), self.elapsed.as_secs_f64());
                (now / end, end - now)
            }),
        ];
        let limits = limits.into_iter().flatten();
        let first = limits.min_by(|a, b| a.1.total_cmp(&b.1));
        Some(Progress {
            step,
            time: clock.time(),
            steps_per_second: speed,
            fraction: first.map(|(fraction, _)| fraction.clamp(0.0, 1.0)),
            remaining: first
                .and_then(|(_, seconds)| Duration::try_from_secs_f64(seconds.max(0.0)).ok()),
        })
    }
}
