//! What the scheduler itself costs: handing out an empty task, and a meeting of all workers,
//! beside rayon and the standard library in the same run.

mod samples;

use std::hint::black_box;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Barrier, Mutex};

use finegrain::framework::dispatch::{Dispatch, Meeting, ReadyDispatch};
use finegrain::framework::space::Grid;
use finegrain::framework::{
    ColumnId, Columns, Fault, Handle, Model, Moment, Near, Rate, RateStage, Rates, Schedule,
    Settings, Simulation, Step, Team,
};
use rayon::prelude::*;
use samples::{Case, sample};

/// Tasks of a sample of hand-outs.
const TASKS: usize = 100_000;
/// Sub-domains that these are tasks of, where they become ready one by one.
const SUB_DOMAINS: usize = 1000;
/// Meetings of a sample.
const MEETINGS: usize = 1000;
/// Samples of each case; the best few are undisturbed even on a shared machine.
const SAMPLES: usize = 200;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let workers = std::thread::available_parallelism()?.get();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(workers).build()?;
    let mut teams = [Team::new(workers)?, Team::new(workers)?, Team::new(workers)?];
    let [first, second, third] = &mut teams;
    let mut peers = empty_parts(workers)?;
    let mut cases = [
        hand_out("Dispatch, chunks of 1", first, 1),
        hand_out("Dispatch, chunks of 16", second, 16),
        offer_and_request(third),
        Case::new("PeerToPeer, parts of sub-domains with two neighbours", || {
            peers.advance((TASKS / SUB_DOMAINS) as u64).expect("an empty stage does not fail");
        }),
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

/// What `PeerToPeer` does without a domain: every task makes the sub-domain's next one ready.
fn offer_and_request(team: &mut Team) -> Case<'_> {
    let (mut dispatch, servers) = ReadyDispatch::new(team.workers());
    let servers: Vec<_> = servers.into_iter().map(Mutex::new).collect();
    let done: Vec<_> = (0..SUB_DOMAINS).map(|_| AtomicUsize::new(0)).collect();
    Case::new("ReadyDispatch, offer and request", move || {
        done.iter().for_each(|done| done.store(0, Ordering::Relaxed));
        dispatch.open(SUB_DOMAINS);
        team.run(|worker| {
            let mut server = servers[worker].lock().expect("nobody panics");
            while let Some(task) = dispatch.request(&mut server, |place| place as u32) {
                let before = done[black_box(task) as usize].fetch_add(1, Ordering::Relaxed);
                if before + 1 < TASKS / SUB_DOMAINS {
                    dispatch.offer(&mut server, task);
                } else {
                    dispatch.finish();
                }
            }
        });
    })
}

/// A ring of sub-domains with nothing to do.
fn empty_parts(workers: usize) -> std::io::Result<Simulation<Grid>> {
    let domain = Grid::builder([1, SUB_DOMAINS]).periodic([true, true]).tile(1, 1).build();
    let mut columns = Columns::new(domain.points());
    let step = Step::builder().rate(Nothing { rate: columns.rate("nothing") }).build();
    let settings = Settings {
        schedule: Schedule::PeerToPeer,
        workers,
        check_every: None,
        steps_ahead: Some((TASKS / SUB_DOMAINS) as u64),
        ..Settings::default()
    };
    Simulation::new(Model::with_fixed_dt("nothing", domain, columns, step, 1.0), settings)
}

struct Nothing {
    rate: Rate<f64>,
}

impl RateStage<Grid> for Nothing {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.rate.id()]
    }

    fn rate(
        &self,
        near: &Near<Grid>,
        _: &mut Rates<Grid>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        black_box(near.id());
        Ok(())
    }
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
