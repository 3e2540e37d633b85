//! Runs a scene under all schedules on more and more workers, and forecasts what more cores would do.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use finegrain_framework::format::AtomicFile;
use finegrain_framework::{PartCost, Schedule, Workload};

use super::forecast::{Overheads, seconds_per_step};
use crate::bench::{limits, overheads, workers};
use crate::scene::{Orders, Parameters, Precision, Report, Scene, SceneError};

/// What to run.
#[derive(Clone)]
pub struct Plan {
    /// The scene.
    pub scene: &'static Scene,
    /// The method.
    pub method: &'static str,
    /// Its parameters.
    pub parameters: Parameters,
    /// Scalar type.
    pub precision: Precision,
    /// Steps of a run.
    pub steps: u64,
    /// Runs of every schedule and number of workers.
    pub repeats: usize,
    /// Most workers: as many as there are cores, for a fair answer.
    pub workers: usize,
    /// Folder for traces.
    pub out: PathBuf,
}

/// Runs of one schedule with some workers.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// How workers meet.
    pub schedule: Schedule,
    /// Number of workers.
    pub workers: usize,
    /// Seconds a step of every run.
    pub seconds: Vec<f64>,
}

impl Measurement {
    /// Seconds a step: the best of the runs.
    pub fn best(&self) -> f64 {
        self.seconds.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// What one schedule would do with some workers.
#[derive(Clone, Copy, Debug)]
pub struct Forecast {
    /// How workers meet.
    pub schedule: Schedule,
    /// Number of workers.
    pub workers: usize,
    /// Seconds a step if every core brought as much memory bandwidth as here.
    pub seconds: f64,
    /// Seconds a step if all cores shared the bandwidth measured here.
    pub seconds_here: f64,
}

impl Forecast {
    /// Whether the bandwidth measured here would bind.
    pub fn is_bound(&self) -> bool {
        self.seconds_here > self.seconds
    }
}

/// What was measured of a scene, and what follows.
#[derive(Clone, Debug)]
pub struct Scaling {
    /// Number of points.
    pub points: usize,
    /// Number of sub-domains.
    pub sub_domains: usize,
    /// Size of all fields, bytes.
    pub bytes: usize,
    /// All runs.
    pub measured: Vec<Measurement>,
    /// What more cores would do, and what these should.
    pub forecasts: Vec<Forecast>,
    /// Cost of scheduling with all workers.
    pub overheads: Overheads,
    /// Bytes a second that all workers copy together, in arrays of the size of the fields.
    pub bandwidth: f64,
}

/// Numbers of workers that are forecast at most.
const MOST: usize = 128;

/// Schedules that are measured.
const SCHEDULES: [Schedule; 4] =
    [Schedule::Lockstep, Schedule::PeerToPeer, Schedule::Fixed, Schedule::ForkJoin];

impl Scaling {
    /// Runs a plan; `say` hears of every run.
    ///
    /// # Errors
    /// If a run fails, or is too short to tell what a step costs.
    pub fn run(plan: &Plan, mut say: impl FnMut(&str)) -> Result<Self, SceneError> {
        let mut measured: Vec<Measurement> = Vec::new();
        let mut points = 0;
        for repeat in 0..plan.repeats {
            for (k, (schedule, workers)) in cases(plan.workers).enumerate() {
                let report = plan.run(schedule, workers, None)?;
                let seconds = report.wall_s / report.steps_done as f64;
                say(&format!("{schedule}, workers {workers}: {:.3} ms a step", 1e3 * seconds));
                points = report.points;
                if repeat == 0 {
                    measured.push(Measurement { schedule, workers, seconds: vec![seconds] });
                } else {
                    measured[k].seconds.push(seconds);
                }
            }
        }
        let workers = plan.workers;
        let overhead = |cause| SceneError::Workers { workers, cause };
        let overheads = Overheads {
            workers,
            hand_out: overheads::hand_out(workers).map_err(overhead)?,
            meeting: overheads::meeting(workers).map_err(overhead)?,
        };
        let alone = plan.workload(Schedule::Lockstep, 1)?;
        let bandwidth = limits::copy_bandwidth(alone.bytes, workers).map_err(overhead)?;
        let mut forecasts = Vec::new();
        for schedule in SCHEDULES.into_iter().filter(|&schedule| schedule != Schedule::ForkJoin) {
            say(&format!("{schedule}: forecast up to {MOST} workers"));
            let together = plan.workload(schedule, workers)?;
            forecasts.extend((0..).map(|k| 1 << k).take_while(|&n| n <= MOST).filter_map(|n| {
                let load = if n == 1 { &alone } else { &together };
                let mut load = load.clone();
                load.between = with_workers(alone.between, together.between, workers, n);
                for (part, one) in load.parts.iter_mut().zip(&alone.parts) {
                    if let (PartCost::Whole(cost), PartCost::Whole(alone)) = (part, one) {
                        *cost = with_workers(*alone, *cost, workers, n);
                    }
                }
                let seconds = seconds_per_step(&load, schedule, n, &overheads)? + load.between;
                let brought =
                    if schedule == Schedule::PeerToPeer { load.steps_per_leg } else { 1.0 };
                let seconds_here = seconds.max(load.bytes as f64 / (bandwidth * brought.max(1.0)));
                Some(Forecast { schedule, workers: n, seconds, seconds_here })
            }));
        }
        let (sub_domains, bytes) = (alone.neighbours.len(), alone.bytes);
        Ok(Self { points, sub_domains, bytes, measured, forecasts, overheads, bandwidth })
    }

    /// Best seconds a step of what was measured.
    pub fn seconds(&self, schedule: Schedule, workers: usize) -> Option<f64> {
        let is_it = |m: &&Measurement| m.schedule == schedule && m.workers == workers;
        self.measured.iter().find(is_it).map(Measurement::best)
    }

    /// Writes measurements and forecasts as CSV, times in seconds a step.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_csv(&self, path: &Path) -> io::Result<()> {
        let mut text = String::from(
            "schedule,workers,measured_best_s,measured_worst_s,forecast_s,forecast_this_memory_s\n",
        );
        let number = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.6e}"));
        for schedule in SCHEDULES {
            let of_forecast = |f: &&Forecast| f.schedule == schedule;
            let forecast = |n| self.forecasts.iter().filter(of_forecast).find(|f| f.workers == n);
            let measured =
                |n| self.measured.iter().find(|m| m.schedule == schedule && m.workers == n);
            for n in (1..=MOST).filter(|&n| forecast(n).is_some() || measured(n).is_some()) {
                let worst = measured(n).map(|m| m.seconds.iter().copied().fold(0.0, f64::max));
                text += &format!(
                    "{schedule},{n},{},{},{},{}\n",
                    number(measured(n).map(Measurement::best)),
                    number(worst),
                    number(forecast(n).map(|f| f.seconds)),
                    number(forecast(n).map(|f| f.seconds_here)),
                );
            }
        }
        let mut file = AtomicFile::create(path)?;
        file.write_all(text.as_bytes())?;
        file.commit()
    }
}

/// Schedules and numbers of workers to measure: powers of two, and all.
fn cases(most: usize) -> impl Iterator<Item = (Schedule, usize)> {
    workers::doubling(most)
        .into_iter()
        .flat_map(|workers| SCHEDULES.into_iter().map(move |schedule| (schedule, workers)))
}

/// Time of whole-domain work with `n` workers, of which one share goes as many times as fast with them
/// and the other does not: from what it takes with one and with `all` workers.
fn with_workers(alone: f64, together: f64, all: usize, n: usize) -> f64 {
    if all == 1 {
        return alone;
    }
    let shared = (alone - together) / (1.0 - 1.0 / all as f64);
    let shared = shared.clamp(0.0, alone);
    alone - shared + shared / n as f64
}

impl Plan {
    fn run(
        &self,
        schedule: Schedule,
        workers: usize,
        trace: Option<PathBuf>,
    ) -> Result<Report, SceneError> {
        let prepared = self.scene.prepare(Some(self.method), &self.parameters, self.precision)?;
        let (steps, workers) = (Some(self.steps), Some(workers));
        prepared.run(Orders { schedule, workers, steps, trace, ..Orders::default() })
    }

    /// What a step costs under a schedule with some workers.
    fn workload(&self, schedule: Schedule, workers: usize) -> Result<Workload, SceneError> {
        let path = self.out.join(format!("trace-{schedule}-{workers}.json"));
        let report = self.run(schedule, workers, Some(path))?;
        report.workload.ok_or(SceneError::TooShort { steps: self.steps })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_domain_work_is_shared_as_far_as_it_was() {
        // All of it, half of it, none.
        let on_eight = |together| with_workers(1.0, together, 2, 8);
        assert!((on_eight(0.5) - 0.125).abs() < 1e-12);
        assert!((on_eight(0.75) - (0.5 + 0.0625)).abs() < 1e-12);
        assert_eq!(on_eight(1.0), 1.0);
        // Slower with more workers is not extrapolated, and what was measured comes back.
        assert_eq!(on_eight(1.3), 1.0);
        assert!((with_workers(1.0, 0.75, 2, 2) - 0.75).abs() < 1e-12);
        assert_eq!(with_workers(1.0, 0.6, 1, 8), 1.0);
    }
}
