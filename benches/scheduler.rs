//! What the scheduler itself costs: handing out an empty task, and a meeting of all workers,
//! beside rayon and the standard library in the same run.

mod samples;

use std::hint::black_box;
use std::sync::Barrier;

use finegrain::framework::Team;
use finegrain::framework::dispatch::{Dispatch, Meeting};
use rayon::prelude::*;
use samples::{Case, sample};

/// Tasks of a sample of hand-outs.
const TASKS: usize = 100_000;
/// Meetings of a sample.
const MEETINGS: usize = 1000;
/// Samples of each case; the best few are undisturbed even on a shared machine.
const SAMPLES: usize = 200;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let workers = std::thread::available_parallelism()?.get();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(workers).build()?;
    let mut teams = [Team::new(workers)?, Team::new(workers)?];
    let [first, second] = &mut teams;
    let mut cases = [
        hand_out("Dispatch, chunks of 1", first, 1),
        hand_out("Dispatch, chunks of 16", second, 16),
        Case::new("rayon, one item at a time", || {
            let tasks = (0..TASKS).into_par_iter().with_max_len(1);
            pool.install(|| tasks.for_each(|task| _ = black_box(task)));
        }),
    ];
    sample(&mut cases, SAMPLES);
    let unit = format!("hand-out of an empty task to {workers} workers, core-ns");
    print(&unit, 1e9 * workers as f64 / TASKS as f64, &cases);
    drop(cases);

    let mut teams =
        [Team::new(workers)?, Team::new(workers)?, Team::new(workers)?, Team::new(workers)?];
    let [first, second, third, fourth] = &mut teams;
    let meeting = Meeting::new(workers);
    let dispatch = Dispatch::new(0, 1, workers);
    let barrier = Barrier::new(workers);
    let mut cases = [
        Case::new("Meeting", || first.run(|_| repeat(|| meeting.arrive(|| {})))),
        Case::new("Dispatch of nothing", || {
            second.run(|_| {
                repeat(|| {
                    black_box(dispatch.request());
                    dispatch.complete(|| {});
                });
            });
        }),
        Case::new("Team::run (two meetings)", || repeat(|| third.run(|_| {}))),
        Case::new("rayon broadcast", || repeat(|| _ = pool.broadcast(|_| {}))),
        Case::new("std::sync::Barrier", || {
            fourth.run(|_| repeat(|| _ = barrier.wait()));
        }),
    ];
    sample(&mut cases, SAMPLES);
    print(&format!("meeting of {workers} workers, microseconds"), 1e6 / MEETINGS as f64, &cases);
    Ok(())
}

fn hand_out<'a>(name: &str, team: &'a mut Team, chunk: usize) -> Case<'a> {
    let dispatch = Dispatch::new(TASKS, chunk, team.workers());
    Case::new(name, move || {
        team.run(|_| {
            while let Some(tasks) = dispatch.request() {
                for task in tasks {
                    black_box(task);
                }
            }
            dispatch.complete(|| {});
        });
    })
}

fn repeat(mut meet: impl FnMut()) {
    for _ in 0..MEETINGS {
        meet();
    }
}

fn print(title: &str, unit: f64, cases: &[Case<'_>]) {
    let last = &cases[cases.len() - 1];
    println!("| {title} | best | median | speed beside {} |\n|---|---|---|---|", last.name);
    for case in cases {
        let [best, median] = [case.best(), case.median()].map(|seconds| unit * seconds);
        println!("| {} | {best:.2} | {median:.2} | {:.2} |", case.name, case.speed_beside(last));
    }
    println!();
}
