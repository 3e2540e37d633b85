//! The benchmark of Holmes, Williams & Tilke (2011), section 5: 3-D flow past a rigid cylinder in a
//! periodic box, driven by a constant body acceleration.
//!
//! Spacing 0.0002 m, width from 0.001 to 0.007 m. The text does not give the other side lengths; a
//! box of 0.025 m x 0.025 m with a cylinder of radius 0.005 m in its middle (the ratio of Morris et
//! al. 1997) holds about as many particles as its Table 1 says. The box is fitted to whole layers
//! of the close packing, an even number where periodicity demands it, so that the packing is
//! periodic.

use std::path::{Path, PathBuf};

use finegrain_framework::run::{Dump, Every, Run, RunFailed, Until};
use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::Cells;
use finegrain_framework::{Real, Schedule, Settings, Simulation};
use finegrain_sph::{Fluid, Packing, Physics, Scheme, Sph, StateEquation, Viscosity, measure};

use super::memory;
use crate::scene::{Precision, SceneError, sph::cylinder::start};

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
    /// Numbers of workers; the first is what speed-up refers to if it is 1.
    pub workers: Vec<usize>,
    /// Steps of a sample.
    pub steps: u64,
    /// Samples of each. The numbers of workers take turns every few steps, so that a machine whose
    /// speed drifts slows all of them.
    pub repeats: usize,
    /// How workers meet.
    pub schedule: Schedule,
    /// Scalar type.
    pub precision: Precision,
    /// Form of the viscous term; the paper's is the strain-rate form.
    pub viscosity: Viscosity,
    /// Folder for results.
    pub out: PathBuf,
}

/// What was measured for one width and number of workers.
#[derive(Clone, Debug)]
pub struct Row {
    /// Width of the box as asked for, m.
    pub width: f64,
    /// Number of particles.
    pub particles: usize,
    /// Number of workers.
    pub workers: usize,
    /// Neighbours within range that a particle has on average.
    pub neighbours: f64,
    /// Sweeps over all pairs that a step makes.
    pub sweeps: usize,
    /// Seconds a step of every sample, results dumps included.
    pub seconds_per_step: Vec<f64>,
    /// Seconds a step with one worker, sample by sample; empty if that was not measured.
    pub alone: Vec<f64>,
    /// Largest resident memory of the process, bytes.
    pub peak_memory: Option<u64>,
}

/// Middle value, the lower one of two.
fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len().saturating_sub(1) / 2).copied().unwrap_or(f64::NAN)
}

impl Row {
    /// Median seconds a step.
    pub fn seconds(&self) -> f64 {
        median(&self.seconds_per_step)
    }

    /// Seconds a step of the best sample.
    pub fn best(&self) -> f64 {
        self.seconds_per_step.iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Speed-up over one worker (eq. 9) of every sample, each against its own turn's.
    pub fn speed_ups(&self) -> Vec<f64> {
        self.alone.iter().zip(&self.seconds_per_step).map(|(one, many)| one / many).collect()
    }

    /// Speed-up over one worker: median over the samples.
    pub fn speed_up(&self) -> Option<f64> {
        let ratios = self.speed_ups();
        (!ratios.is_empty()).then(|| median(&ratios))
    }

    /// Efficiency (eq. 10).
    pub fn efficiency(&self) -> Option<f64> {
        Some(self.speed_up()? / self.workers as f64)
    }

    /// Pairs of neighbours a second and worker in whole steps, each pair counted once a step from
    /// either side, however many sweeps visit it.
    pub fn pairs_per_second(&self) -> f64 {
        self.particles as f64 * self.neighbours / (self.seconds() * self.workers as f64)
    }

    /// Pair interactions a second and worker in whole steps: every sweep's visits count.
    pub fn interactions_per_second(&self) -> f64 {
        self.pairs_per_second() * self.sweeps as f64
    }

    /// Bytes a particle of the whole process.
    pub fn bytes_per_particle(&self) -> Option<f64> {
        Some(self.peak_memory? as f64 / self.particles as f64)
    }
}

/// Builds the paper's model for a width.
fn model<T: Real>(width: f64, viscosity: Viscosity) -> Result<Sph<T>, SceneError> {
    let lattice = Packing::HexagonalClosePacked.fit([SIDE, SIDE, width], SPACING)?;
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
        viscosity: Some(viscosity),
        body_acceleration: [1e-5, 0.0, 0.0],
        bodies: vec![body.into()],
        ..Physics::default()
    };
    Ok(Sph::new(&start(3, &lattice, SPACING), &fluid, &physics, &Scheme::default())?)
}

/// Measures everything in `plan`; `say` hears of every sample.
///
/// # Errors
/// If the model cannot be built or run, or results cannot be written.
pub fn measure(plan: &Plan, mut say: impl FnMut(&Row)) -> Result<Vec<Row>, SceneError> {
    match plan.precision {
        Precision::F32 => measure_in::<f32>(plan, &mut say),
        Precision::F64 => measure_in::<f64>(plan, &mut say),
    }
}

/// Steps after which the next number of workers has its turn.
const TURN: u64 = 10;

/// Steps before the clock starts: in the middle between two results dumps, so that a dump is written
/// while its own turn's steps go on.
const WARM_UP: u64 = 5;

fn measure_in<T: Real>(plan: &Plan, say: &mut impl FnMut(&Row)) -> Result<Vec<Row>, SceneError> {
    let mut rows = Vec::new();
    for &width in &plan.widths {
        let mut group = empty_rows::<T>(plan, width)?;
        for _ in 0..plan.repeats {
            let seconds = sample::<T>(plan, width)?;
            for (row, &own) in group.iter_mut().zip(&seconds) {
                row.seconds_per_step.push(own);
                if plan.workers[0] == 1 && row.workers > 1 {
                    row.alone.push(seconds[0]);
                }
                say(row);
            }
        }
        rows.extend(group);
    }
    Ok(rows)
}

/// A row for each number of workers without samples yet: what does not need a clock, from a run of
/// the first steps with nothing else in memory.
fn empty_rows<T: Real>(plan: &Plan, width: f64) -> Result<Vec<Row>, SceneError> {
    let mut rows = Vec::new();
    for &workers in &plan.workers {
        memory::reset_peak();
        let mut run = start_run::<T>(plan, width, workers)?;
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
                Viscosity::Morris | Viscosity::Adami => 1,
            },
            seconds_per_step: Vec::new(),
            alone: Vec::new(),
            peak_memory,
        });
    }
    Ok(rows)
}

/// Seconds a step of one sample for each number of workers, results dumps included, initial
/// preparations and the first steps not.
fn sample<T: Real>(plan: &Plan, width: f64) -> Result<Vec<f64>, SceneError> {
    let start = |&workers| start_run::<T>(plan, width, workers);
    let mut runs = plan.workers.iter().map(start).collect::<Result<Vec<_>, _>>()?;
    let mut seconds = vec![0.0; runs.len()];
    for run in &mut runs {
        run.run()?;
    }
    let mut done = 0;
    while done < plan.steps {
        done = (done + TURN).min(plan.steps);
        runs = runs.into_iter().map(|run| run.until(steps(WARM_UP + done))).collect();
        for (run, seconds) in runs.iter_mut().zip(&mut seconds) {
            *seconds += run.run()?.wall_clock.as_secs_f64() / plan.steps as f64;
        }
    }
    Ok(seconds)
}

fn steps(steps: u64) -> Until {
    Until { steps: Some(steps), ..Until::default() }
}

/// Where the results dumps of a number of workers go.
pub fn dump_folder(plan: &Plan, workers: usize) -> PathBuf {
    plan.out.join(format!("workers-{workers}"))
}

/// A run that is ready for its first step, and to end when it is warm.
fn start_run<T: Real>(
    plan: &Plan,
    width: f64,
    workers: usize,
) -> Result<Run<Cells<T>>, SceneError> {
    let sph = model::<T>(width, plan.viscosity)?;
    let settings = Settings { schedule: plan.schedule, workers, ..Settings::default() };
    let mut simulation = Simulation::new(sph.model, settings)
        .map_err(|cause| SceneError::Workers { workers, cause })?;
    simulation.begin().map_err(|cause| RunFailed { cause: cause.into(), last_checkpoint: None })?;
    let dump = Dump::new("results", Every::Steps(10))
        .scalar("identity")
        .scalar("density")
        .vector("velocity", ["velocity_x", "velocity_y", "velocity_z"]);
    // The runs of different numbers of workers are under way at the same time.
    Ok(Run::new(simulation).out(dump_folder(plan, workers)).dump(dump).until(steps(WARM_UP)))
}

/// Writes the numbers as CSV.
///
/// # Errors
/// If the file cannot be written.
pub fn write_csv(path: &Path, rows: &[Row]) -> std::io::Result<()> {
    let mut text = String::from(
        "width_m,particles,workers,neighbours,sweeps,seconds_per_step_median,\
         seconds_per_step_best,speed_up,efficiency,pairs_per_s_and_core,\
         pair_interactions_per_s_and_core,bytes_per_particle\n",
    );
    let optional = |x: Option<f64>| x.map_or_else(String::new, |x| format!("{x:.4}"));
    for row in rows {
        text += &format!(
            "{},{},{},{:.2},{},{:.6e},{:.6e},{},{},{:.4e},{:.4e},{}\n",
            row.width,
            row.particles,
            row.workers,
            row.neighbours,
            row.sweeps,
            row.seconds(),
            row.best(),
            optional(row.speed_up()),
            optional(row.efficiency()),
            row.pairs_per_second(),
            row.interactions_per_second(),
            optional(row.bytes_per_particle()),
        );
    }
    std::fs::write(path, text)
}
