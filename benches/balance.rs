//! Events balance the load: a dam break, whose sub-domains cost very different amounts, under every
//! schedule of our own, alone on the machine and with one core slowed by another process.
//!
//! Every run is traced; the table says how much of their time workers waited for one another.

use std::hint::black_box;
use std::io::Read;
use std::process::{Child, Command, Stdio};
use std::{env, io, process, thread};

use finegrain::bench::samples::median;
use finegrain::framework::Schedule;
use finegrain::framework::trace::{Shares, Summary};
use finegrain::scene::{Orders, Precision, Scene};

type Error = Box<dyn std::error::Error>;

/// Particles in the width of the dam.
const RESOLUTION: &str = "60";
/// Steps of a sample, and samples of each case.
const STEPS: u64 = 300;
const SAMPLES: usize = 7;
/// Argument with which this program is the other process.
const OTHER: &str = "--be-the-other-process";

const SCHEDULES: [Schedule; 3] = [Schedule::Fixed, Schedule::Lockstep, Schedule::PeerToPeer];

fn main() -> Result<(), Error> {
    if env::args().any(|argument| argument == OTHER) {
        keep_a_core_busy();
    }
    let cores = thread::available_parallelism()?.get();
    println!("dam-break by SPH, {RESOLUTION} particles in its width, workers: {cores}\n");
    println!("| machine | schedule | ms a step: best | median | speed beside fixed | waiting |");
    println!("|---|---|---|---|---|---|");
    for busy in [false, true] {
        let mut runs: [Vec<(f64, f64)>; 3] = Default::default();
        for _ in 0..SAMPLES {
            for (runs, schedule) in runs.iter_mut().zip(SCHEDULES) {
                let other = busy.then(Other::start).transpose()?;
                runs.push(run(schedule, cores)?);
                drop(other);
            }
        }
        let fixed = runs[0].clone();
        for (runs, schedule) in runs.into_iter().zip(SCHEDULES) {
            let ratios = fixed.iter().zip(&runs).map(|(fixed, own)| fixed.0 / own.0);
            let beside = median(ratios).expect("a sample");
            let best = runs.iter().map(|run| run.0).fold(f64::INFINITY, f64::min);
            let seconds = median(runs.iter().map(|run| run.0)).expect("a sample");
            let waiting = median(runs.iter().map(|run| run.1)).expect("a sample");
            let machine = if busy { "one core shared" } else { "alone" };
            println!(
                "| {machine} | {schedule} | {:.3} | {:.3} | {beside:.2} | {:.1} % |",
                1e3 * best,
                1e3 * seconds,
                100.0 * waiting
            );
        }
    }
    Ok(())
}

/// Seconds a step of a run, and the share of the workers' time that they waited.
fn run(schedule: Schedule, workers: usize) -> Result<(f64, f64), Error> {
    let scene = Scene::find("dam-break")?;
    let parameters = scene.set_for(Some("sph"), [("resolution", RESOLUTION)])?;
    let folder = tempfile::tempdir()?;
    let orders = Orders {
        schedule,
        workers: Some(workers),
        steps: Some(STEPS),
        trace: Some(folder.path().join("trace.json")),
        ..Orders::default()
    };
    let report = scene.prepare(Some("sph"), &parameters, Precision::F64)?.run(orders)?;
    let summary = report.trace.ok_or("no trace")?;
    Ok((report.wall_s / STEPS as f64, waiting(&summary)))
}

fn waiting(summary: &Summary) -> f64 {
    let sum = |part: fn(&Shares) -> f64| summary.workers.iter().map(part).sum::<f64>();
    sum(|shares| shares.waiting) / sum(|shares| shares.busy + shares.hand_out + shares.waiting)
}

/// Another process, with as much right to a core as a worker.
struct Other(Child);

impl Other {
    fn start() -> io::Result<Self> {
        Command::new(env::current_exe()?).arg(OTHER).stdin(Stdio::piped()).spawn().map(Self)
    }
}

impl Drop for Other {
    fn drop(&mut self) {
        // If it cannot be stopped, it has stopped already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Until nobody holds the other end of the standard input, however that came about.
fn keep_a_core_busy() -> ! {
    thread::spawn(|| {
        let _ = io::stdin().read_to_end(&mut Vec::new());
        process::exit(0);
    });
    let mut x = 0u64;
    loop {
        x = black_box(x.wrapping_mul(6364136223846793005).wrapping_add(1));
    }
}
