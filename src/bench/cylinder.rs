//! The benchmark of Holmes, Williams & Tilke (2011), section 5: 3-D flow past a rigid cylinder in a
//! periodic box, driven by a constant body acceleration.
//!
//! Spacing 0.0002 m, width from 0.001 to 0.007 m. The text does not give the other side lengths; a
//! box of 0.025 m x 0.025 m with a cylinder of radius 0.005 m in its middle (the ratio of Morris et
//! al. 1997) holds about as many particles as its Table 1 says. The box is fitted to whole layers
//! of the close packing, an even number where periodicity demands it, so that the packing is
//! periodic.
//!
//! A model of every number of workers is in memory at the same time, and as many separate ones as the
//! most workers: what is needed grows with the number of cores.

use std::path::{Path, PathBuf};
use std::{fs, thread};

use finegrain_framework::run::{Dump, Every, Run, RunFailed, Until};
use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::Cells;
use finegrain_framework::trace::Trace;
use finegrain_framework::{Real, Schedule, Settings, Simulation};
use finegrain_sph::packing::{Lattice, PackingError};
use finegrain_sph::{
    Fields, Fluid, Packing, Pairs, Physics, Scheme, Sph, StateEquation, Viscosity, measure,
};

use super::memory;
use super::row::{Row, Turn};
use crate::figure::{Field, Outline};
use crate::scene::sph::{cylinder::start, picture};
use crate::scene::{Precision, SceneError};

/// Particle spacing of the paper, m.
pub const SPACING: f64 = 0.0002;
/// Sides of the box across the cylinder, before fitting, m.
pub const SIDE: f64 = 0.025;
/// Radius of the cylinder, m.
pub const RADIUS: f64 = 0.005;
/// Widths of the box along the cylinder in the paper's Table 1, m.
pub const WIDTHS: [f64; 7] = [0.001, 0.002, 0.003, 0.004, 0.005, 0.006, 0.007];

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Widths of the box, m.
    pub widths: Vec<f64>,
    /// Numbers of workers; speed-up refers to one, if it is among them.
    pub workers: Vec<usize>,
    /// Steps of a sample.
    pub steps: u64,
    /// Samples of each. The numbers of workers take turns every 10 steps, so that a machine whose speed
    /// drifts slows all of them.
    pub repeats: usize,
    /// How workers meet.
    pub schedule: Schedule,
    /// Scalar type.
    pub precision: Precision,
    /// Form of the viscous term; the paper's is the strain-rate form.
    pub viscosity: Viscosity,
    /// Whether sweeps share their lists of neighbours.
    pub pairs: Pairs,
    /// Folder for results.
    pub out: PathBuf,
}

impl Plan {
    fn most_workers(&self) -> usize {
        self.workers.iter().copied().max().unwrap_or(1)
    }
}

/// The particles, and the box that is fitted to them, for a width.
///
/// # Errors
/// If the width is less than a layer.
pub fn lattice(width: f64) -> Result<Lattice, PackingError> {
    Packing::HexagonalClosePacked.fit([SIDE, SIDE, width], SPACING)
}

/// Builds the paper's model for a width.
pub(super) fn model<T: Real, P: Real>(width: f64, plan: &Plan) -> Result<Sph<T, P>, SceneError> {
    let lattice = lattice(width)?;
    let lengths = lattice.lengths();
    let body = Shape::Cylinder {
        axis: Axis::Z,
        centre: [0.5 * lengths[0], 0.5 * lengths[1], 0.0],
        radius: RADIUS,
    };
    // Water, driven so that the Reynolds number with the radius is about 1: a mean velocity of
    // 2e-4 m/s and, in the gap, three times that; a sound speed ten times larger.
    let fluid = Fluid {
        density: 1000.0,
        sound_speed: 6e-3,
        kinematic_viscosity: 1e-6,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let physics = Physics {
        viscosity: Some(plan.viscosity),
        body_acceleration: [1e-5, 0.0, 0.0],
        bodies: vec![body.into()],
        ..Physics::default()
    };
    let scheme = Scheme { pairs: plan.pairs, ..Scheme::default() };
    Ok(Sph::new(&start(3, &lattice, SPACING), &fluid, &physics, &scheme)?)
}

/// What a plan comes to.
pub struct Measured {
    /// A row for each width and number of workers.
    pub rows: Vec<Row>,
    /// The flow at the end of the last run with the most workers.
    pub flow: Option<Field>,
}

/// Measures everything in `plan`; `say` hears of every sample.
///
/// # Errors
/// If the model cannot be built or run, or results cannot be written.
pub fn measure(plan: &Plan, mut say: impl FnMut(&Row)) -> Result<Measured, SceneError> {
    match plan.precision {
        Precision::F32 => measure_in::<f32, f32>(plan, &mut say),
        Precision::F64 => measure_in::<f64, f64>(plan, &mut say),
        Precision::Mixed => measure_in::<f32, f64>(plan, &mut say),
    }
}

/// Steps after which the next number of workers has its turn.
const TURN: u64 = 10;

/// Steps before the clock starts: in the middle between two results dumps, so that a dump is written
/// while its own turn's steps go on.
const WARM_UP: u64 = 5;

fn measure_in<T: Real, P: Real>(
    plan: &Plan,
    say: &mut impl FnMut(&Row),
) -> Result<Measured, SceneError> {
    // Memory before anything else: allocators keep some of what many runs at once have freed.
    let groups = plan.widths.iter().map(|&width| empty_rows::<T, P>(plan, width));
    let mut groups = groups.collect::<Result<Vec<_>, _>>()?;
    let mut flow = None;
    let one = plan.workers.iter().position(|&workers| workers == 1);
    for (group, &width) in groups.iter_mut().zip(&plan.widths) {
        for _ in 0..plan.repeats {
            let sample = sample::<T, P>(plan, width)?;
            for (row, turns) in group.iter_mut().zip(&sample.together) {
                row.turns.extend(turns);
                if let Some(one) = one.filter(|_| row.workers > 1) {
                    row.alone.extend(&sample.together[one]);
                }
                if row.workers == plan.most_workers() {
                    row.apart.extend(&sample.apart);
                }
                say(row);
            }
            flow = sample.flow;
        }
    }
    Ok(Measured { rows: groups.concat(), flow })
}

/// A row for each number of workers without samples yet: what does not need a clock, from a run of
/// the first steps with nothing else in memory.
fn empty_rows<T: Real, P: Real>(plan: &Plan, width: f64) -> Result<Vec<Row>, SceneError> {
    let mut rows = Vec::new();
    for &workers in &plan.workers {
        memory::reset_peak();
        let (mut run, _) = start_run::<T, P>(plan, width, workers, Tracing::Off)?;
        run.run()?;
        // Before anything else is allocated.
        let peak_memory = memory::peak();
        let simulation = run.simulation_mut();
        rows.push(Row {
            width,
            particles: simulation.columns().points(),
            workers,
            neighbours: measure::mean_neighbours(&mut simulation.whole()),
            sweeps: match plan.viscosity {
                Viscosity::StrainRate => 2,
                Viscosity::Morris | Viscosity::Adami | Viscosity::Monaghan => 1,
            },
            turns: Vec::new(),
            alone: Vec::new(),
            apart: Vec::new(),
            peak_memory,
        });
    }
    Ok(rows)
}

/// Turns of one sample, results dumps included, initial preparations and the first steps not.
struct Sample {
    /// Of every number of workers.
    together: Vec<Vec<Turn>>,
    /// Seconds a step of separate runs with one worker each, as many as the most workers.
    apart: Vec<f64>,
    /// The flow at the end.
    flow: Option<Field>,
}

/// Numbers of workers take turns, and the separate runs with them.
fn sample<T: Real, P: Real>(plan: &Plan, width: f64) -> Result<Sample, SceneError> {
    let start = |&workers| start_run::<T, P>(plan, width, workers, Tracing::On);
    let started = plan.workers.iter().map(start).collect::<Result<Vec<_>, _>>()?;
    let (mut together, fields): (Vec<_>, Vec<_>) = started.into_iter().unzip();
    let separate = plan.out.join("separate");
    let mut apart = start_apart::<T, P>(plan, width, &separate)?;
    for run in &mut together {
        run.run()?;
    }
    side_by_side(&mut apart)?;

    let mut sample =
        Sample { together: vec![Vec::new(); together.len()], apart: Vec::new(), flow: None };
    for begin in (0..plan.steps).step_by(TURN as usize) {
        let end = (begin + TURN).min(plan.steps);
        let count = (end - begin) as f64;
        let go_on = |run: Run<Cells<P>>| run.until(steps(WARM_UP + end));
        together = together.into_iter().map(go_on).collect();
        apart = apart.into_iter().map(go_on).collect();
        for (run, turns) in together.iter_mut().zip(&mut sample.together) {
            let seconds = run.run()?.wall_clock.as_secs_f64() / count;
            let trace = run.simulation().trace();
            let in_stages = trace.map_or(0.0, |trace| in_stages(trace, WARM_UP + begin)) / count;
            turns.push(Turn { seconds, in_stages });
        }
        if !apart.is_empty() {
            sample.apart.push(side_by_side(&mut apart)? / count);
        }
    }
    sample.flow = together.last().zip(fields.last()).map(|(run, fields)| {
        let steps = WARM_UP + plan.steps;
        let title = format!("Flow past the cylinder, {steps} steps after it was at rest");
        picture(run.simulation(), fields, title, SPACING).outline(outline(run.simulation()))
    });
    drop(apart);
    // Their dumps were only written because the others' are; what cannot be removed does no harm.
    let _ = fs::remove_dir_all(separate);
    Ok(sample)
}

/// Of the cylinder.
fn outline<P: Real>(simulation: &Simulation<Cells<P>>) -> Outline {
    let upper = &simulation.domain().region().upper;
    Outline::Circle { centre: [0.5 * upper[0], 0.5 * upper[1]], radius: RADIUS }
}

/// As many separate runs as the most workers, with what they write in `folder`; none where there is nothing to
/// compare them with.
fn start_apart<T: Real, P: Real>(
    plan: &Plan,
    width: f64,
    folder: &Path,
) -> Result<Vec<Run<Cells<P>>>, SceneError> {
    let most = plan.most_workers();
    if most == 1 || !plan.workers.contains(&1) {
        return Ok(Vec::new());
    }
    let started = at_the_same_time((0..most).map(|number| {
        move || {
            let (run, _) = start_run::<T, P>(plan, width, 1, Tracing::On)?;
            Ok(run.out(folder.join(number.to_string())))
        }
    }));
    started.into_iter().collect()
}

/// Runs all at the same time; mean wall-clock seconds that one took.
fn side_by_side<P: Real>(runs: &mut [Run<Cells<P>>]) -> Result<f64, SceneError> {
    let count = runs.len().max(1) as f64;
    let mut seconds = 0.0;
    for summary in at_the_same_time(runs.iter_mut().map(|run| || run.run())) {
        seconds += summary?.wall_clock.as_secs_f64() / count;
    }
    Ok(seconds)
}

/// What tasks return that run at the same time, each on a thread of its own.
fn at_the_same_time<R: Send>(tasks: impl Iterator<Item = impl FnOnce() -> R + Send>) -> Vec<R> {
    thread::scope(|scope| {
        let threads: Vec<_> = tasks.map(|task| scope.spawn(task)).collect();
        let ended = threads.into_iter().map(|thread| thread.join());
        ended.map(|end| end.unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
    })
}

/// Seconds that all workers together spent in stages from step `first` on.
fn in_stages(trace: &Trace, first: u64) -> f64 {
    let events = (0..trace.workers()).flat_map(|worker| trace.events(worker));
    let own = events.filter(|event| event.step >= first);
    own.map(|event| 1e-9 * (event.end - event.begin) as f64).sum()
}

fn steps(steps: u64) -> Until {
    Until { steps: Some(steps), ..Until::default() }
}

/// Where the results dumps of a number of workers go.
pub fn dump_folder(plan: &Plan, workers: usize) -> PathBuf {
    plan.out.join(format!("workers-{workers}"))
}

/// Whether a run remembers when its workers were in stages.
#[derive(Clone, Copy, PartialEq)]
enum Tracing {
    On,
    Off,
}

/// A run, and where its model keeps what.
type Started<T, P> = (Run<Cells<P>>, Fields<T, P>);

/// A run that is ready for its first step, and to end when it is warm; traced, it remembers as many
/// parts as there are particles, which is more than a turn's: a sub-domain has 256 particles.
fn start_run<T: Real, P: Real>(
    plan: &Plan,
    width: f64,
    workers: usize,
    tracing: Tracing,
) -> Result<Started<T, P>, SceneError> {
    let sph = model::<T, P>(width, plan)?;
    let trace = if tracing == Tracing::On { sph.model.columns.points() } else { 0 };
    let settings = Settings { schedule: plan.schedule, workers, trace, ..Settings::default() };
    let mut simulation = Simulation::new(sph.model, settings)
        .map_err(|cause| SceneError::Workers { workers, cause })?;
    simulation.begin().map_err(|cause| RunFailed { cause: cause.into(), last_checkpoint: None })?;
    let dump = Dump::new("results", Every::Steps(10))
        .scalar("identity")
        .scalar("density")
        .vector("velocity", ["velocity_x", "velocity_y", "velocity_z"]);
    // The runs of different numbers of workers are under way at the same time.
    let run = Run::new(simulation).out(dump_folder(plan, workers)).dump(dump);
    Ok((run.until(steps(WARM_UP)), sph.fields))
}
