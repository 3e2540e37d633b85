//! Where the time of the cylinder's benchmark goes, beside what the machine could do.

use std::path::Path;
use std::time::{Duration, Instant};

use finegrain_framework::run::RunFailed;
use finegrain_framework::{Real, RunError, Settings, Simulation};
use finegrain_sph::{Pairs, SweepPart, Viscosity, measure};

use super::cylinder::{Plan, model};
use super::limits;
use crate::scene::{Precision, SceneError};

/// Time between two looks at what the worker is doing.
const INTERVAL: Duration = Duration::from_micros(100);
/// Parts that the trace remembers: more than any size of the paper has in a benchmark's steps.
const TRACE: usize = 1 << 18;

/// One part of a step.
#[derive(Clone, Debug)]
pub struct Part {
    /// What it is called.
    pub name: &'static str,
    /// Seconds of a step.
    pub seconds: f64,
    /// Floating-point operations a step, a multiply-add being two, as counted in the source; where that
    /// was done.
    pub flops: Option<f64>,
    /// Bytes loaded and stored a step, wherever they come from, counted likewise.
    pub bytes: Option<f64>,
    /// Measured limits of this machine for them: operations and bytes a second.
    pub limits: [f64; 2],
}

/// A step of one worker, part by part.
#[derive(Clone, Debug)]
pub struct Breakdown {
    /// Number of particles.
    pub particles: usize,
    /// Seconds a step.
    pub seconds: f64,
    /// What it is made of.
    pub parts: Vec<Part>,
}

/// Measures a breakdown of the first size of `plan`.
///
/// # Errors
/// If the model cannot be built or run.
pub fn measure(plan: &Plan) -> Result<Breakdown, SceneError> {
    match plan.precision {
        Precision::F32 => measure_in::<f32, f32>(plan),
        Precision::F64 => measure_in::<f64, f64>(plan),
        Precision::Mixed => measure_in::<f32, f64>(plan),
    }
}

fn measure_in<T: Real, P: Real>(plan: &Plan) -> Result<Breakdown, SceneError> {
    let sph = model::<T, P>(plan.widths[0], plan)?;
    let settings =
        Settings { schedule: plan.schedule, workers: 1, trace: TRACE, ..Settings::default() };
    let mut simulation = Simulation::new(sph.model, settings)
        .map_err(|cause| SceneError::Workers { workers: 1, cause })?;
    let failed = |cause: RunError| RunFailed { cause: cause.into(), last_checkpoint: None };
    simulation.begin().map_err(failed)?;
    let effort = measure::search_effort(&mut simulation.whole());
    let neighbours = 1.0 + measure::mean_neighbours(&mut simulation.whole());
    let particles = simulation.columns().points();
    let began = Instant::now();
    let (outcome, seen) =
        simulation.activities().sample(INTERVAL, || simulation.advance(plan.steps));
    let seconds = began.elapsed().as_secs_f64() / plan.steps as f64;
    outcome.map_err(failed)?;
    let between = simulation.trace().map_or(0.0, |trace| trace.summary().between);
    let between = between / plan.steps as f64;

    let limit = |error| SceneError::Workers { workers: 1, cause: error };
    let peak = limits::multiply_adds::<T>();
    let single = limits::multiply_adds::<f32>();
    let in_cache = limits::copy_bandwidth(32 << 10, 1).map_err(limit)?;
    let in_memory = limits::copy_bandwidth(512 << 20, 1).map_err(limit)?;

    // The counts are those of the paper's formulation.
    let counts = |count: Count, times: f64| {
        let counts = (plan.viscosity == Viscosity::StrainRate).then_some(count);
        let all = particles as f64 * times;
        counts.map(|count| (all * count.flops, all * count.bytes::<T, P>())).unzip()
    };
    let samples = seen.iter().sum::<u64>() as f64;
    let mut rest = seconds - between;
    let mut parts = Vec::new();
    for part in SweepPart::ALL {
        let share = seen[part as usize] as f64 / samples;
        rest -= share * seconds;
        let ((flops, bytes), peak) = match part {
            SweepPart::Collect => (counts(COLLECT, effort.seen), peak),
            SweepPart::Search => {
                let (searches, listed) = match plan.pairs {
                    Pairs::Kept => (1.0, neighbours),
                    Pairs::Searched => (2.0, 0.0),
                };
                let (tests, candidates) = (searches * effort.tested, searches * effort.candidates);
                let parts = [(TEST, tests), (CANDIDATE, candidates), (LISTED, listed)];
                let [tests, candidates, lists] = parts.map(|(count, times)| counts(count, times));
                let sum = |[a, b, c]: [Option<f64>; 3]| Some(a? + b? + c?);
                let flops = sum([tests.0, candidates.0, lists.0]);
                ((flops, sum([tests.1, candidates.1, lists.1])), single)
            }
            SweepPart::Gather => (counts(gather::<T>(), neighbours), peak),
            SweepPart::Kernel => (counts(kernel::<T>(), neighbours), peak),
            SweepPart::Terms => (counts(TERMS, neighbours), peak),
        };
        let limits = [peak, in_cache];
        parts.push(Part { name: part.name(), seconds: share * seconds, flops, bytes, limits });
    }
    let (flops, bytes) = counts(UPDATE, 1.0);
    let limits = [peak, in_memory];
    parts.push(Part { name: "updates, checks", seconds: rest.max(0.0), flops, bytes, limits });
    let sort = "re-sort, time step";
    parts.push(Part { name: sort, seconds: between, flops: None, bytes: None, limits });
    Ok(Breakdown { particles, seconds, parts })
}

/// What one passage of a loop computes, and loads and stores, in both sweeps together.
#[derive(Clone, Copy)]
struct Count {
    flops: f64,
    /// Values of the type that rates are computed in.
    values: f64,
    /// Values of the type of positions.
    positions: f64,
    /// Other bytes.
    others: f64,
}

impl Count {
    fn bytes<T, P>(self) -> f64 {
        self.values * size_of::<T>() as f64 + self.positions * size_of::<P>() as f64 + self.others
    }
}

/// A particle that a sub-domain sees: its position is shifted, put in place and scaled; 5 quantities in the
/// first sweep and 8 in the second are put with it into records of 8 and 16 values.
const COLLECT: Count = Count { flops: 24.0, values: 49.0, positions: 6.0, others: 24.0 };
/// A particle is tested against the box of a cell's particles, once.
const TEST: Count = Count { flops: 17.0, values: 0.0, positions: 0.0, others: 12.0 };
/// A particle near the box is tested against a particle, once.
const CANDIDATE: Count = Count { flops: 8.0, values: 0.0, positions: 0.0, others: 12.0 };
/// The place of a neighbour is put on a list, which is copied, and looked up there.
const LISTED: Count = Count { flops: 0.0, values: 0.0, positions: 0.0, others: 20.0 };
/// Continuity (9 operations) and strain rate (24); pressure gradient (7) and divergence of stress (27).
const TERMS: Count = Count { flops: 67.0, values: 49.0, positions: 0.0, others: 0.0 };
/// Drift, prediction and correction of position, velocity and density, equation of state, and twice the
/// check that nothing has left its cell.
const UPDATE: Count = Count { flops: 70.0, values: 31.0, positions: 18.0, others: 0.0 };

/// Records of 8 and 16 values, of which a vector of the second holds all that is in use, are written to as many
/// lanes; three of these become differences, and their squares a distance.
fn gather<T: Real>() -> Count {
    let in_use = if size_of::<T>() == 4 { 8.0 + 16.0 } else { 8.0 + 12.0 };
    Count { flops: 16.0, values: 2.0 * in_use + 22.0, positions: 0.0, others: 12.0 }
}

/// The Gaussian by a polynomial of degree 12 or, in single precision, 6; and the gradient.
fn kernel<T: Real>() -> Count {
    let degree = if size_of::<T>() == 4 { 6.0 } else { 12.0 };
    let flops = 2.0 * (2.0 * degree + 10.0 + 3.0);
    Count { flops, values: 22.0, positions: 0.0, others: 0.0 }
}

impl Breakdown {
    /// Writes it as CSV.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_csv(&self, path: &Path) -> std::io::Result<()> {
        let mut text = String::from(
            "part,share,seconds_per_step,flops_per_step,bytes_per_step,peak_flops_per_s,copy_bytes_per_s\n",
        );
        let optional = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.4e}"));
        for part in &self.parts {
            text += &format!(
                "\"{}\",{:.4},{:.4e},{},{},{:.4e},{:.4e}\n",
                part.name,
                part.seconds / self.seconds,
                part.seconds,
                optional(part.flops),
                optional(part.bytes),
                part.limits[0],
                part.limits[1],
            );
        }
        std::fs::write(path, text)
    }
}
