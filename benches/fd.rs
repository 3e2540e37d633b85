//! Finite differences on a periodic cube, and on a plane far larger than the caches: million points a second of
//! whole steps, beside what memory copies.
//!
//! Usage: `cargo bench --bench fd -- [SIDE]` prints a table of all cases, with one worker and with all, the cubes of
//! `SIDE` (256) points along a side. `-- SIDE CASE` (such as `448 wave-f32`) takes a sample of each way to run the
//! case for each line it reads, to be run in turns with somebody else, and prints `way speed`.

mod samples;

use std::io::{BufRead, Write};

use finegrain::fd::{Boundary, Compiled, Condition, Fd, FdError, Heat, Mesh, Order, Side, Wave};
use finegrain::framework::space::Grid;
use finegrain::framework::*;
use rayon::prelude::*;
use samples::{Case, sample};

/// Points along a side of a cube, where nothing else is asked for.
const SIDE: usize = 256;
/// Samples of each way.
const SAMPLES: usize = 7;
/// Steps of a sample.
const STEPS: u64 = 8;
/// Rows long enough that a tile has two; see `docs/performance.md`.
const PLANE: [usize; 2] = [4096, 16384];

/// An equation on a mesh.
#[derive(Clone, Copy)]
enum Problem {
    /// By Euler's method, 7 points.
    Heat { side: usize },
    /// By Euler's method, 5 points, on [`PLANE`].
    Plane,
    /// By leapfrog, 25 points.
    Wave { side: usize },
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Cargo adds an option of its own.
    let arguments: Vec<_> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let side = arguments.first().map_or(Ok(SIDE), |side| side.parse())?;
    let cores = std::thread::available_parallelism()?.get();
    if let Some(case) = arguments.get(1) {
        return match case.as_str() {
            "heat-f64" => in_turns::<f64>(Problem::Heat { side }, cores),
            "heat-f32" => in_turns::<f32>(Problem::Heat { side }, cores),
            "plane-f64" => in_turns::<f64>(Problem::Plane, cores),
            "wave-f64" => in_turns::<f64>(Problem::Wave { side }, cores),
            "wave-f32" => in_turns::<f32>(Problem::Wave { side }, cores),
            _ => Err(format!("no case {case:?}").into()),
        };
    }
    println!("{}", lanes::instruction_set());
    println!("| equation, points, scalar | workers | way | best | median | beside a copy |");
    println!("|---|---|---|---|---|---|");
    for workers in [1, cores] {
        table::<f64>(Problem::Heat { side }, workers)?;
        table::<f32>(Problem::Heat { side }, workers)?;
        table::<f64>(Problem::Plane, workers)?;
        table::<f64>(Problem::Wave { side }, workers)?;
        table::<f32>(Problem::Wave { side }, workers)?;
    }
    Ok(())
}

/// Prints the speed of all ways to run a problem.
fn table<T: Compiled>(problem: Problem, workers: usize) -> Result<(), Box<dyn std::error::Error>> {
    let mut contest = Contest::<T>::new(problem, workers)?;
    let mut cases = contest.cases();
    sample(&mut cases, SAMPLES);
    for case in &cases {
        let [best, median] = [case.best(), case.median()].map(|s| problem.speed(s));
        let (name, scalar) = (problem.name(), std::any::type_name::<T>());
        let ratio = case.speed_beside(&cases[0]);
        println!(
            "| {name}, {scalar} | {workers} | {} | {best:.0} | {median:.0} | {ratio:.2} |",
            case.name
        );
    }
    drop(cases);
    contest.check();
    Ok(())
}

/// Takes a sample of each way for each line read.
fn in_turns<T: Compiled>(
    problem: Problem,
    workers: usize,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut contest = Contest::<T>::new(problem, workers)?;
    let mut cases = contest.cases();
    sample(&mut cases, 0);
    println!("ready");
    for line in std::io::stdin().lock().lines() {
        line?;
        for case in &mut cases {
            let seconds = case.take();
            println!("{} {:.1}", case.name, problem.speed(seconds));
        }
        println!("done");
        std::io::stdout().flush()?;
    }
    drop(cases);
    contest.check();
    Ok(())
}

/// Ways to run a problem, and a copy of as many points by as many threads.
struct Contest<T> {
    problem: Problem,
    pool: rayon::ThreadPool,
    from: Vec<T>,
    to: Vec<T>,
    runs: Vec<(Schedule, Simulation<Grid>)>,
}

impl<T: Compiled> Contest<T> {
    fn new(problem: Problem, workers: usize) -> Result<Self, Box<dyn std::error::Error>> {
        let mut runs = Vec::new();
        for schedule in [Schedule::Lockstep, Schedule::PeerToPeer] {
            let settings = Settings { schedule, workers, ..Settings::default() };
            runs.push((schedule, Simulation::new(problem.model::<T>()?.model, settings)?));
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(workers).build()?;
        let from = vec![T::one(); problem.points()];
        let to = vec![T::zero(); problem.points()];
        Ok(Self { problem, pool, from, to, runs })
    }

    fn cases(&mut self) -> Vec<Case<'_>> {
        let Self { problem, pool, from, to, runs } = self;
        let steps = problem.steps();
        let mut cases = vec![Case::new("copy", move || {
            for _ in 0..steps {
                let pieces = to.par_chunks_mut(1 << 15).zip(from.par_chunks(1 << 15));
                pool.install(|| pieces.for_each(|(to, from)| to.copy_from_slice(from)));
            }
        })];
        cases.extend(runs.iter_mut().map(|(schedule, simulation)| {
            let run = move || simulation.advance(steps).expect("smooth fields stay finite");
            Case::new(schedule.name(), run)
        }));
        cases
    }

    /// All have taken the same steps, so they must have come to the same bits.
    fn check(&self) {
        for (schedule, simulation) in &self.runs {
            let expected = self.runs[0].1.state_hash();
            assert!(simulation.state_hash() == expected, "{schedule} has other bits");
        }
    }
}

impl Problem {
    fn name(self) -> String {
        match self {
            Self::Heat { side } => format!("heat, order 2, {side}^3"),
            Self::Plane => format!("heat, order 2, {} x {}", PLANE[0], PLANE[1]),
            Self::Wave { side } => format!("wave, order 8, {side}^3"),
        }
    }

    fn points(self) -> usize {
        self.mesh().shape().iter().product()
    }

    /// Steps of a sample.
    fn steps(self) -> u64 {
        match self {
            // As many as peers run ahead.
            Self::Plane => 32,
            _ => STEPS,
        }
    }

    /// Million points a second, of a sample.
    fn speed(self, seconds: f64) -> f64 {
        1e-6 * (self.steps() as usize * self.points()) as f64 / seconds
    }

    fn mesh(self) -> Mesh {
        match self {
            Self::Heat { side } | Self::Wave { side } => {
                Mesh::new([Side::periodic(side, 0.0, 1.0); 3])
            }
            Self::Plane => Mesh::new(PLANE.map(|points| Side::periodic(points, 0.0, 1.0))),
        }
    }

    fn model<T: Compiled>(self) -> Result<Fd<T>, FdError> {
        let (mesh, boundary) = (self.mesh(), Boundary::all(Condition::Outflow));
        match self {
            Self::Heat { .. } | Self::Plane => {
                let (order, integrator) = (Order::Second, Integrator::Euler.into());
                let heat = Heat { diffusivity: 1.0, order, integrator, boundary };
                heat.model(&mesh, 0.9 * heat.time_step_limit(&mesh)?, &start)
            }
            Self::Wave { .. } => {
                let wave = Wave { speed: 1.0, order: Order::Eighth, boundary };
                wave.model(&mesh, 0.9 * wave.time_step_limit(&mesh)?, &start, &|_| 0.0)
            }
        }
    }
}

fn start(x: [f64; 3]) -> f64 {
    (20.0 * x[0]).sin() + (13.0 * x[1] * x[2]).cos()
}
