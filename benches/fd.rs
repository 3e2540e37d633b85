//! Finite differences on a periodic cube: million points a second of whole steps, beside what memory copies.

mod samples;

use finegrain::fd::{Boundary, Compiled, Condition, Fd, FdError, Heat, Mesh, Order, Side, Wave};
use finegrain::framework::*;
use rayon::prelude::*;
use samples::{Case, sample};

/// Points along a side.
const SIDE: usize = 256;
/// Steps of a sample, and samples of each case.
const STEPS: u64 = 8;
const SAMPLES: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cores = std::thread::available_parallelism()?.get();
    println!("{}, points: {SIDE}^3", lanes::instruction_set());
    println!("| equation, scalar | workers | schedule | best | median | beside a copy |");
    println!("|---|---|---|---|---|---|");
    compare::<f64>("heat, order 2", cores, heat)?;
    compare::<f32>("heat, order 2", cores, heat)?;
    compare::<f64>("wave, order 8", cores, wave)?;
    compare::<f32>("wave, order 8", cores, wave)?;
    Ok(())
}

/// Prints the speed on one worker and on all, in turns with a copy of as many points by as many threads.
fn compare<T: Compiled>(
    name: &str,
    cores: usize,
    model: fn() -> Result<Fd<T>, FdError>,
) -> Result<(), Box<dyn std::error::Error>> {
    for workers in [1, cores] {
        let mut runs = Vec::new();
        for schedule in [Schedule::Lockstep, Schedule::PeerToPeer] {
            let settings = Settings { schedule, workers, ..Settings::default() };
            runs.push((schedule, Simulation::new(model()?.model, settings)?));
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(workers).build()?;
        let from = vec![T::one(); SIDE.pow(3)];
        let mut to = vec![T::zero(); SIDE.pow(3)];
        let mut cases = vec![Case::new("copy", || {
            for _ in 0..STEPS {
                let pieces = to.par_chunks_mut(1 << 15).zip(from.par_chunks(1 << 15));
                pool.install(|| pieces.for_each(|(to, from)| to.copy_from_slice(from)));
            }
        })];
        cases.extend(runs.iter_mut().map(|(schedule, simulation)| {
            let run = || simulation.advance(STEPS).expect("smooth fields stay finite");
            Case::new(schedule.name(), run)
        }));
        sample(&mut cases, SAMPLES);
        let speed = |seconds: f64| 1e-6 * (STEPS as usize * SIDE.pow(3)) as f64 / seconds;
        for case in &cases {
            let [best, median] = [case.best(), case.median()].map(speed);
            let (scalar, ratio) = (std::any::type_name::<T>(), case.speed_beside(&cases[0]));
            println!(
                "| {name}, {scalar} | {workers} | {} | {best:.0} | {median:.0} | {ratio:.2} |",
                case.name
            );
        }
    }
    Ok(())
}

fn cube() -> Mesh {
    Mesh::new([Side::periodic(SIDE, 0.0, 1.0); 3])
}

fn start(x: [f64; 3]) -> f64 {
    (20.0 * x[0]).sin() + (13.0 * x[1] * x[2]).cos()
}

/// By Euler's method, 7 points.
fn heat<T: Compiled>() -> Result<Fd<T>, FdError> {
    let boundary = Boundary::all(Condition::Outflow);
    let heat = Heat {
        diffusivity: 1.0,
        order: Order::Second,
        integrator: Integrator::Euler.into(),
        boundary,
    };
    heat.model(&cube(), 0.9 * heat.time_step_limit(&cube())?, &start)
}

/// By leapfrog, 25 points.
fn wave<T: Compiled>() -> Result<Fd<T>, FdError> {
    let boundary = Boundary::all(Condition::Outflow);
    let wave = Wave { speed: 1.0, order: Order::Eighth, boundary };
    wave.model(&cube(), 0.9 * wave.time_step_limit(&cube())?, &start, &|_| 0.0)
}
