//! What ends a run, and that it ends there.

mod run_models;

use std::time::Duration;

use finegrain_framework::port::Port;
use finegrain_framework::run::{Every, Run, RunFailure, Stopped, Until};
use finegrain_framework::*;
use run_models::{HEAT, LEAPFROG, checkpoints, plan, settings};

#[test]
fn at_a_step() {
    let folder = tempfile::tempdir().unwrap();
    let until = Until { steps: Some(7), time: Some(100.0), wall_clock: None };
    for number in 0..5 {
        let summary = plan(&HEAT, settings(number), folder.path()).until(until).run().unwrap();
        assert_eq!((summary.stopped, summary.step), (Stopped::Steps, 7));
        assert_eq!(summary.steps_done, 7);
    }
}

#[test]
fn at_a_time_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    for (number, end) in [0.3, 1.0, 1.0 / 3.0, 0.7777].into_iter().enumerate() {
        let until = Until { time: Some(end), ..Until::default() };
        let heat = plan(&HEAT, settings(number), folder.path()).until(until).run().unwrap();
        assert_eq!((heat.stopped, heat.time.to_bits()), (Stopped::Time, end.to_bits()));
        let points = plan(&LEAPFROG, settings(number), folder.path()).until(until).run().unwrap();
        assert_eq!((points.stopped, points.time.to_bits()), (Stopped::Time, end.to_bits()));
    }
}

/// Of a method with a fixed time step all steps are made shorter, alike: integrators that look back
/// several steps rely on that.
#[test]
fn at_a_time_that_no_whole_number_of_steps_reaches() {
    let start = || Simulation::new((LEAPFROG.model)(), settings(1)).unwrap();
    let mut free = start();
    free.begin().unwrap();
    let end = 40.5 * free.clock().dt();
    let mut bound = start();
    bound.end_at(end);
    for _ in 0..41 {
        bound.advance(1).unwrap();
        assert_eq!(bound.clock().dt(), end / 41.0);
    }
    assert_eq!(bound.clock().time(), end);
}

#[test]
fn without_wall_clock_time_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let until = Until { wall_clock: Some(Duration::ZERO), ..Until::default() };
    let summary = plan(&HEAT, settings(1), folder.path())
        .until(until)
        .checkpoint(Every::Steps(5), 1)
        .run()
        .unwrap();
    assert_eq!((summary.stopped, summary.step), (Stopped::WallClock, 0));
    // The beginning is shown, and can be gone on from.
    assert_eq!(summary.histories[0].len(), 1);
    assert_eq!(checkpoints(folder.path()), ["checkpoint-000000000.ckpt"]);
}

#[test]
fn after_some_wall_clock_time() {
    let folder = tempfile::tempdir().unwrap();
    let until = Until { wall_clock: Some(Duration::from_millis(1)), ..Until::default() };
    let summary = plan(&HEAT, settings(1), folder.path()).until(until).run().unwrap();
    assert_eq!(summary.stopped, Stopped::WallClock);
    assert!(summary.wall_clock >= Duration::from_millis(1));
}

/// The stop comes while the run goes on, and is seen when the workers come back.
#[test]
fn on_request() {
    let folder = tempfile::tempdir().unwrap();
    let (stop, stops) = Port::unbounded("stop");
    let summary = plan(&HEAT, settings(2), folder.path())
        .stop_on(stops)
        .stop_when(Every::Steps(6), move |whole, _| {
            if whole.step == 6 {
                stop.post(()).unwrap();
            }
            false
        })
        .checkpoint(Every::Steps(100), 1)
        .run()
        .unwrap();
    assert_eq!(summary.stopped, Stopped::Asked);
    assert!(summary.step >= 6);
    let file = format!("checkpoint-{:09}.ckpt", summary.step);
    assert_eq!(summary.last_checkpoint.unwrap(), folder.path().join(file));
}

/// A criterion sees the histories, a restarted one those from before the restart too.
#[test]
fn when_a_criterion_is_met() {
    let folder = tempfile::tempdir().unwrap();
    let steady = |number| {
        plan(&HEAT, settings(number), folder.path())
            .stop_when(Every::Steps(2), |_, histories| {
                histories[0].column("sum").unwrap().count() > 5
            })
            .until(Until { steps: Some(50), ..Until::default() })
            .checkpoint(Every::Steps(3), 10)
    };
    let all = steady(0).run().unwrap();
    assert_eq!((all.stopped, all.step), (Stopped::Criterion, 10));
    let checkpoint = folder.path().join("checkpoint-000000003.ckpt");
    let again = steady(1).restart_from(checkpoint).run().unwrap();
    assert_eq!((again.stopped, again.step), (Stopped::Criterion, 10));
    assert_eq!(again.state_hash, all.state_hash);
    // Where it was met, it is met still.
    let done = steady(2).restart_from(all.last_checkpoint.unwrap()).run().unwrap();
    assert_eq!((done.stopped, done.steps_done), (Stopped::Criterion, 0));
    assert_eq!(done.state_hash, all.state_hash);
}

#[test]
fn a_checkpoint_on_request() {
    let folder = tempfile::tempdir().unwrap();
    let (request, requests) = Port::unbounded("checkpoint");
    request.post(()).unwrap();
    let until = Until { steps: Some(4), ..Until::default() };
    let run = || plan(&LEAPFROG, settings(3), folder.path()).until(until);
    let summary = run().checkpoint_on(requests).run().unwrap();
    let names = ["checkpoint-000000000.ckpt", "checkpoint-000000004.ckpt"];
    assert_eq!(checkpoints(folder.path()), names);
    let again = run().restart_from(folder.path().join(names[0])).run().unwrap();
    assert_eq!(again.state_hash, summary.state_hash);
}

#[test]
fn progress_is_posted() {
    let folder = tempfile::tempdir().unwrap();
    let (port, mut inbox) = Port::unbounded("progress");
    let until = Until { steps: Some(10), ..Until::default() };
    plan(&HEAT, settings(0), folder.path())
        .until(until)
        .progress(port, Duration::ZERO)
        .run()
        .unwrap();
    let events: Vec<_> = std::iter::from_fn(|| inbox.try_take()).collect();
    assert!(events.windows(2).all(|pair| pair[0].step < pair[1].step));
    let last = events.last().unwrap();
    assert_eq!((last.step, last.fraction), (10, Some(1.0)));
    assert_eq!(last.remaining, Some(Duration::ZERO));
    assert!(events.iter().all(|event| event.steps_per_second > 0.0));
}

/// Whoever no longer listens does not stop the run, nor one who never takes.
#[test]
fn progress_that_nobody_takes() {
    let folder = tempfile::tempdir().unwrap();
    let until = Until { steps: Some(10), ..Until::default() };
    for inbox_lives in [true, false] {
        let (port, inbox) = Port::bounded("progress", 1);
        let inbox = inbox_lives.then_some(inbox);
        let run = plan(&HEAT, settings(0), folder.path()).until(until);
        assert!(run.progress(port, Duration::ZERO).run().is_ok());
        drop(inbox);
    }
}

#[test]
fn a_run_that_nothing_ends_is_refused() {
    let simulation = Simulation::new((HEAT.model)(), Settings::default()).unwrap();
    let failed = Run::new(simulation).run().unwrap_err();
    assert!(matches!(failed.cause, RunFailure::Endless));
}
