//! What a run writes: histories, dumps, checkpoints.

mod run_models;
mod vtk_file;

use finegrain_framework::run::{Dump, Every, Run, Until};
use finegrain_framework::*;
use run_models::{HEAT, SWARM, checkpoints, files, plan, settings};

fn until(steps: u64) -> Until {
    Until { steps: Some(steps), ..Until::default() }
}

/// A grid with a fixed time step, to know when something is due.
fn still(dt: f64, settings: Settings) -> Run<space::Grid> {
    let mut model = (HEAT.model)();
    model.pacing = Box::new(FixedPace(dt));
    Run::new(Simulation::new(model, settings).unwrap())
}

#[test]
fn a_history_has_every_digit_of_every_row() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = plan(&HEAT, settings(1), folder.path()).until(until(9));
    let summary = run.run().unwrap();
    let history = &summary.histories[0];
    assert_eq!(history.steps(), [0, 2, 4, 6, 8]);
    let text = String::from_utf8(files(folder.path())["heat.csv"].clone()).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("time,step,sum,most"));
    for (row, line) in lines.enumerate() {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
        let expected = [history.times()[row], history.steps()[row] as f64];
        assert_eq!(numbers, [&expected[..], history.row(row)].concat());
    }
    assert_eq!(text.lines().count(), 6);
    assert!(text.ends_with('\n'));
}

/// Neither the schedule nor the workers nor a cut into other legs show in any file.
#[test]
fn files_are_the_same_whatever_runs_them() {
    let expected = tempfile::tempdir().unwrap();
    plan(&SWARM, settings(0), expected.path()).until(until(10)).run().unwrap();
    for number in 1..6 {
        let folder = tempfile::tempdir().unwrap();
        plan(&SWARM, settings(number), folder.path())
            .until(until(10))
            .checkpoint(Every::Steps(number as u64), 2)
            .run()
            .unwrap();
        assert!(files(folder.path()) == files(expected.path()), "settings {number}");
    }
}

#[test]
fn a_dump_is_written_at_the_first_step_past_each_multiple() {
    let folder = tempfile::tempdir().unwrap();
    still(0.1, settings(2))
        .until(until(30))
        .out(folder.path())
        .dump(Dump::new("fields", Every::Time(0.75)).scalar("temperature"))
        .run()
        .unwrap();
    let files = files(folder.path());
    let steps = [0, 8, 15, 23, 30].map(|step| format!("fields-{step:09}.vti"));
    let dumps: Vec<_> = files.keys().filter(|name| name.ends_with(".vti")).collect();
    assert_eq!(dumps, steps.each_ref());
    let series = String::from_utf8(files["fields.pvd"].clone()).unwrap();
    assert!(steps.iter().all(|name| series.contains(name)));
}

#[test]
fn a_dump_of_particles_has_positions_and_vectors() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = plan(&SWARM, settings(3), folder.path()).until(until(6));
    run.run().unwrap();
    let (_, arrays) = vtk_file::read(&files(folder.path())["particles-000000006.vtu"]);
    let columns = run.simulation().columns();
    let column = |name| columns.values(columns.find_state::<f64>(name).unwrap()).to_vec();
    for (name, [x, y]) in [("position", ["x", "y"]), ("velocity", ["velocity_x", "velocity_y"])] {
        let (x, y) = (column(x), column(y));
        let expected: Vec<_> = x.into_iter().zip(y).flat_map(|(x, y)| [x, y, 0.0]).collect();
        assert_eq!(arrays[name].numbers(), expected);
    }
    assert_eq!((&*arrays["identity"].kind, arrays["identity"].components), ("UInt32", 1));
}

#[test]
fn the_last_checkpoints_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let summary = plan(&HEAT, settings(0), folder.path())
        .until(until(11))
        .checkpoint(Every::Steps(2), 3)
        .run()
        .unwrap();
    let names = [8, 10, 11].map(|step| format!("checkpoint-{step:09}.ckpt"));
    assert_eq!(checkpoints(folder.path()), names);
    let listed = summary.files.iter().filter(|path| path.ends_with(&names[2])).count();
    assert_eq!(listed, 1);
    assert!(summary.files.iter().all(|path| path.exists()));
    let again = plan(&HEAT, settings(1), folder.path())
        .until(until(13))
        .checkpoint(Every::Steps(2), 3)
        .restart_from(folder.path().join(&names[2]))
        .run()
        .unwrap();
    assert_eq!(again.step, 13);
    let names = [11, 12, 13].map(|step| format!("checkpoint-{step:09}.ckpt"));
    assert_eq!(checkpoints(folder.path()), names);
}

/// Many more snapshots than may be under way: stepping waits for the disk, and goes on.
#[test]
fn a_disk_slower_than_the_steps() {
    let folder = tempfile::tempdir().unwrap();
    let dump = |name| Dump::new(name, Every::Steps(1)).scalar("temperature");
    let summary = still(0.1, settings(1))
        .until(until(60))
        .out(folder.path())
        .dump(dump("one"))
        .dump(dump("two"))
        .checkpoint(Every::Steps(1), 2)
        .run()
        .unwrap();
    assert_eq!(summary.step, 60);
    let files = files(folder.path());
    assert_eq!(files.keys().filter(|name| name.ends_with(".vti")).count(), 2 * 61);
}

/// Without a folder histories are kept in memory.
#[test]
fn no_folder() {
    let simulation = Simulation::new((HEAT.model)(), settings(0)).unwrap();
    let mut run = Run::new(simulation).until(until(4)).monitor(
        "step",
        Every::Steps(1),
        ["number"],
        |whole| [whole.step as f64],
    );
    let summary = run.run().unwrap();
    assert_eq!(summary.histories[0].column("number").unwrap().sum::<f64>(), 10.0);
    assert!(summary.histories[0].column("step").is_none());
    assert!(summary.files.is_empty());
    assert_eq!(run.histories(), summary.histories);
}
