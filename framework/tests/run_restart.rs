//! A run that is interrupted at any step and taken up again, under another schedule and with
//! other workers, is the uninterrupted run: the same state, and the same bytes in every file.

mod run_models;

use std::fs;

use finegrain_framework::Domain;
use finegrain_framework::run::{Every, Stopped, Summary, Until};
use run_models::{Case, HEAT, LEAPFROG, RK4, SWARM, checkpoints, files, plan, settings};

fn same_from_every_step<D: Domain>(case: &Case<D>) {
    let to_the_end = Until { time: Some(case.end), ..Until::default() };
    let whole = tempfile::tempdir().unwrap();
    let keep = usize::MAX;
    let mut run = plan(case, settings(0), whole.path()).until(to_the_end);
    let expected = run.run().unwrap();
    assert_eq!(expected.stopped, Stopped::Time);
    assert_eq!(expected.time.to_bits(), case.end.to_bits());
    assert!(expected.step >= 10, "{} steps", expected.step);
    let expected_files = files(whole.path());
    for step in 0..=expected.step {
        let folder = tempfile::tempdir().unwrap();
        let number = step as usize;
        let interrupted = Until { steps: Some(step), ..to_the_end };
        let first = plan(case, settings(number), folder.path())
            .until(interrupted)
            .checkpoint(Every::Steps(4), keep)
            .run()
            .unwrap();
        assert_eq!(first.step, step);
        let checkpoint = folder.path().join(format!("checkpoint-{step:09}.ckpt"));
        assert_eq!(first.last_checkpoint.as_deref(), Some(&*checkpoint));
        let second = plan(case, settings(number + 7), folder.path())
            .until(to_the_end)
            .checkpoint(Every::Steps(4), keep)
            .restart_from(&checkpoint)
            .run()
            .unwrap();
        assert_same(&second, &expected, step);
        assert_eq!(second.steps_done, expected.step - step);
        assert!(files(folder.path()) == expected_files, "files of a restart at {step}");
    }
}

fn assert_same(found: &Summary, expected: &Summary, step: u64) {
    assert_eq!(found.state_hash, expected.state_hash, "state after a restart at {step}");
    assert_eq!(found.histories, expected.histories, "histories after a restart at {step}");
    assert_eq!((found.step, found.time), (expected.step, expected.time));
}

#[test]
fn a_grid_that_swaps() {
    same_from_every_step(&HEAT);
}

#[test]
fn leapfrog_with_kept_rates() {
    same_from_every_step(&LEAPFROG);
}

#[test]
fn runge_kutta() {
    same_from_every_step(&RK4);
}

#[test]
fn particles_that_are_sorted() {
    same_from_every_step(&SWARM);
}

/// A run that was killed has gone on after its last checkpoint: what it wrote then is cut off and
/// written again.
#[test]
fn from_an_old_checkpoint_in_a_folder_that_has_gone_on() {
    let folder = tempfile::tempdir().unwrap();
    let until = Until { time: Some(SWARM.end), ..Until::default() };
    let all = |number| {
        plan(&SWARM, settings(number), folder.path())
            .until(until)
            .checkpoint(Every::Steps(1), usize::MAX)
    };
    let expected = all(1).run().unwrap();
    let expected_files = files(folder.path());
    for step in [7, 2, 9] {
        let csv = folder.path().join("energy.csv");
        let mut half = fs::read(&csv).unwrap();
        half.extend(b"0.77,3,0.1");
        fs::write(&csv, half).unwrap();
        let checkpoint = folder.path().join(format!("checkpoint-{step:09}.ckpt"));
        let again = all(2).restart_from(checkpoint).run().unwrap();
        assert_same(&again, &expected, step);
        assert!(files(folder.path()) == expected_files);
        assert_eq!(checkpoints(folder.path()).len() as u64, expected.step);
    }
}

/// The histories are in the checkpoint; the series lists only what is in the folder.
#[test]
fn into_another_folder() {
    let (old, new) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let half = Until { steps: Some(6), time: Some(HEAT.end), ..Until::default() };
    let first = plan(&HEAT, settings(0), old.path())
        .until(half)
        .checkpoint(Every::Steps(100), 1)
        .run()
        .unwrap();
    let second = plan(&HEAT, settings(1), new.path())
        .until(Until { steps: None, ..half })
        .restart_from(first.last_checkpoint.unwrap())
        .run()
        .unwrap();
    let files = files(new.path());
    let text = |name: &str| String::from_utf8(files[name].clone()).unwrap();
    assert_eq!(text("heat.csv").lines().count(), 1 + second.histories[0].len());
    let series = text("fields.pvd");
    let dumps: Vec<_> = files.keys().filter(|name| name.ends_with(".vti")).collect();
    assert_eq!(series.matches("<DataSet").count(), dumps.len());
    assert!(dumps.iter().all(|name| series.contains(*name)));
}

/// A run that stopped can also go on as it is.
#[test]
fn going_on_without_a_restart() {
    let (whole, parts) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let until = Until { time: Some(LEAPFROG.end), ..Until::default() };
    let expected = plan(&LEAPFROG, settings(0), whole.path()).until(until).run().unwrap();
    let mut run = plan(&LEAPFROG, settings(0), parts.path());
    for steps in [0, 3, 3, 8] {
        run = run.until(Until { steps: Some(steps), ..until });
        let summary = run.run().unwrap();
        assert_eq!((summary.stopped, summary.step), (Stopped::Steps, steps));
    }
    let found = run.until(until).run().unwrap();
    assert_same(&found, &expected, 8);
    assert!(files(whole.path()) == files(parts.path()));
}
