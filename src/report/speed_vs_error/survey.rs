//! Runs what is compared, the cheapest first, each run a process of its own.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

use finegrain_framework::run::Stopped;
use serde::Deserialize;

use super::comparison::{Comparison, Line};

/// What to run.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The `finegrain` program.
    pub program: PathBuf,
    /// What is compared.
    pub comparisons: Vec<&'static Comparison>,
    /// Only lines of this method, if there is one.
    pub method: Option<String>,
    /// No run is begun that is expected to end after this time.
    pub budget: Duration,
    /// Number of workers; all cores if `None`.
    pub workers: Option<usize>,
}

/// One way to run a scene, at one resolution.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// What it is compared in.
    pub comparison: &'static Comparison,
    /// The way.
    pub line: &'static Line,
    /// Points across.
    pub resolution: u32,
}

/// A case that was run to its end.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// What was run.
    pub case: Case,
    /// Number of points.
    pub points: usize,
    /// Number of steps.
    pub steps: u64,
    /// Wall-clock time of every run without its preparation, s.
    pub walls: Vec<f64>,
    /// Largest resident memory of the process, bytes, where the system tells.
    pub memory: Option<u64>,
    /// The error, without its sign.
    pub error: f64,
    /// Hash of the state's bits at the end.
    pub state_hash: String,
}

impl Measurement {
    /// Wall-clock time, s: the best of the runs.
    pub fn wall_s(&self) -> f64 {
        self.walls.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// What came of a plan.
#[derive(Clone, Debug, Default)]
pub struct Survey {
    /// What was run to its end, in the order of the comparisons, their lines and resolutions.
    pub measurements: Vec<Measurement>,
    /// What failed, and why.
    pub failures: Vec<(Case, String)>,
    /// What was not run, or not to its end, for want of time.
    pub left_out: Vec<Case>,
}

/// Runs are repeated while all of a case took less than this, s.
const REPEATED_BELOW: f64 = 3.0;
/// No run is expected to take less than this, s.
const SHORTEST: f64 = 0.01;
/// What is expected may be wrong by so much, s: no run is ended before.
const PATIENCE: f64 = 1.0;
/// Runs of a case at most.
const MOST_RUNS: usize = 5;

impl Survey {
    /// Runs a plan; `say` hears of every case and what became of it.
    ///
    /// # Errors
    /// If the program cannot be run or does not say what is expected of it.
    pub fn run(plan: &Plan, mut say: impl FnMut(&Case, &str)) -> io::Result<Self> {
        let begun = Instant::now();
        let mut survey = Self::default();
        let mut tracks: Vec<Track> = tracks(plan);
        while let Some(track) = next(&mut tracks) {
            let Some(case) = track.case() else { break };
            let left = plan.budget.saturating_sub(begun.elapsed()).as_secs_f64();
            if track.expected_s > left {
                say(&case, "not run, for want of time");
                survey.left_out.extend(track.rest());
                track.done = track.line.resolutions.len();
                continue;
            }
            let limit = (2.0 * track.expected_s).max(PATIENCE).min(left);
            match measure(plan, case, limit)? {
                // It takes longer than expected: others may be cheaper.
                None => track.expected_s = 2.0 * limit,
                Some(Err(why)) => {
                    say(&case, &format!("failed: {why}"));
                    survey.failures.push((case, why));
                    track.done += 1;
                }
                Some(Ok(measurement)) => {
                    let (wall_s, error) = (measurement.wall_s(), measurement.error);
                    say(&case, &format!("{wall_s:.3} s, error {:.4} %", 100.0 * error));
                    track.ran(wall_s);
                    survey.measurements.push(measurement);
                }
            }
        }
        survey.measurements.sort_by_key(|m| m.case.order());
        Ok(survey)
    }

    /// The measurements of a line of a comparison, the coarsest first.
    pub fn of(&self, comparison: &Comparison, line: &Line) -> Vec<&Measurement> {
        let is_its = |case: &Case| {
            case.comparison.name == comparison.name && case.line.title() == line.title()
        };
        self.measurements.iter().filter(|m| is_its(&m.case)).collect()
    }
}

impl Case {
    fn order(&self) -> (usize, usize, u32) {
        let at = super::COMPARISONS.iter().position(|c| c.name == self.comparison.name);
        let line = self.comparison.lines.iter().position(|l| l.title() == self.line.title());
        (at.unwrap_or(usize::MAX), line.unwrap_or(usize::MAX), self.resolution)
    }

    /// Arguments of `finegrain` that run it.
    pub fn arguments(&self) -> Vec<String> {
        let Self { comparison, line, resolution } = self;
        let mut words = vec!["run".to_owned(), comparison.scene.to_owned()];
        words.extend(["--method".to_owned(), line.method.to_owned()]);
        let settings = comparison.settings.iter().chain(line.settings);
        let settings = settings.map(|(key, value)| format!("{key}={value}"));
        for setting in settings.chain([format!("resolution={resolution}")]) {
            words.extend(["--set".to_owned(), setting]);
        }
        words.extend(["--precision".to_owned(), line.precision.name().to_owned()]);
        words.extend(["--schedule".to_owned(), line.schedule.name().to_owned()]);
        if let Some(until) = comparison.until {
            words.extend(["--until".to_owned(), until.to_string()]);
        }
        words
    }
}

/// How far a line has come.
struct Track {
    comparison: &'static Comparison,
    line: &'static Line,
    /// Number of resolutions that are done.
    done: usize,
    /// Points across and wall-clock time, s, of those that ran.
    walls: Vec<[f64; 2]>,
    /// Wall-clock time that the next one is expected to take, s.
    expected_s: f64,
}

fn tracks(plan: &Plan) -> Vec<Track> {
    let is_asked_for =
        |line: &&Line| plan.method.as_ref().is_none_or(|method| line.method == method);
    let of = |&comparison: &&'static Comparison| {
        let lines = comparison.lines.iter().filter(is_asked_for);
        lines.map(move |line| Track {
            comparison,
            line,
            done: 0,
            walls: Vec::new(),
            expected_s: SHORTEST,
        })
    };
    plan.comparisons.iter().flat_map(of).collect()
}

/// The track whose next case is expected to be the cheapest.
fn next(tracks: &mut [Track]) -> Option<&mut Track> {
    let open = tracks.iter_mut().filter(|track| track.case().is_some());
    open.min_by(|a, b| a.expected_s.total_cmp(&b.expected_s))
}

impl Track {
    fn case(&self) -> Option<Case> {
        let &resolution = self.line.resolutions.get(self.done)?;
        Some(Case { comparison: self.comparison, line: self.line, resolution })
    }

    fn rest(&self) -> impl Iterator<Item = Case> + use<> {
        let (comparison, line) = (self.comparison, self.line);
        let rest = line.resolutions[self.done..].iter();
        rest.map(move |&resolution| Case { comparison, line, resolution })
    }

    /// Goes on to the next case, which is expected to take a time by a power law through the last two, or
    /// by one more time for every point and a shorter time step.
    fn ran(&mut self, wall_s: f64) {
        self.walls.push([f64::from(self.line.resolutions[self.done]), wall_s]);
        self.done += 1;
        let next = self.case().map_or(f64::INFINITY, |case| f64::from(case.resolution));
        let by_points = f64::from(self.comparison.dims) + 1.0;
        let power = match *self.walls.as_slice() {
            [.., [coarse, before], [fine, wall]] => {
                let power = (wall / before).ln() / (fine / coarse).ln();
                power.clamp(by_points - 1.0, by_points + 2.0)
            }
            _ => by_points,
        };
        let [resolution, wall] = self.walls[self.walls.len() - 1];
        self.expected_s = (wall * (next / resolution).powf(power)).max(SHORTEST);
    }
}

/// What a run prints as JSON, as far as it is of interest here.
#[derive(Deserialize)]
struct Printed {
    stopped: String,
    steps: u64,
    wall_s: f64,
    peak_memory: Option<u64>,
    points: usize,
    state_hash: String,
    /// What is not a number is printed as null.
    errors: BTreeMap<String, Option<f64>>,
    notes: Vec<String>,
}

/// Runs a case, several times if it is short; `None` if it did not end within `limit` seconds, the inner
/// error is what a run that failed says.
fn measure(plan: &Plan, case: Case, limit: f64) -> io::Result<Option<Result<Measurement, String>>> {
    let mut walls = Vec::new();
    loop {
        let printed = match run(&plan.program, case, plan.workers, limit)? {
            Ok(printed) => printed,
            Err(why) => return Ok(Some(Err(why))),
        };
        if printed.stopped == Stopped::WallClock.to_string() {
            return Ok(None);
        }
        walls.push(printed.wall_s);
        if walls.iter().sum::<f64>() < REPEATED_BELOW && walls.len() < MOST_RUNS {
            continue;
        }
        let mut error: f64 = 0.0;
        for &name in case.comparison.errors {
            match printed.errors.get(name) {
                Some(&Some(part)) => error = error.max(part.abs()),
                _ => {
                    let notes = printed.notes.join("; ");
                    return Ok(Some(Err(format!("it ended without {name:?}: {notes}"))));
                }
            }
        }
        let Printed { points, steps, peak_memory: memory, state_hash, .. } = printed;
        let measurement = Measurement { case, points, steps, walls, memory, error, state_hash };
        return Ok(Some(Ok(measurement)));
    }
}

fn run(
    program: &Path,
    case: Case,
    workers: Option<usize>,
    left: f64,
) -> io::Result<Result<Printed, String>> {
    let mut command = Command::new(program);
    command.args(case.arguments()).arg("--json");
    command.args(["--wall-clock", &left.to_string()]);
    if let Some(workers) = workers {
        command.args(["--workers", &workers.to_string()]);
    }
    let output = command.output()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let error = said.lines().rev().find_map(|line| line.strip_prefix("error: "));
        return Ok(Err(error.unwrap_or("it ended without saying why").to_owned()));
    }
    let said = String::from_utf8_lossy(&output.stdout);
    let line = said.lines().last().unwrap_or_default();
    Ok(Ok(serde_json::from_str(line)?))
}
