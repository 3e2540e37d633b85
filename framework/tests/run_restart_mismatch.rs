//! A checkpoint that does not fit is refused with a reason, and changes nothing.

mod run_models;

use std::path::PathBuf;

use finegrain_framework::checkpoint::CheckpointError;
use finegrain_framework::run::{Every, RunFailure, Until};
use finegrain_framework::space::{Grid, Independent};
use finegrain_framework::*;
use run_models::{HEAT, LEAPFROG, RK4, plan, settings};

/// A checkpoint of the heat case at step 3.
fn checkpoint() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let until = Until { steps: Some(3), ..Until::default() };
    let run = plan(&HEAT, settings(0), folder.path()).until(until);
    let summary = run.checkpoint(Every::Steps(3), 1).run().unwrap();
    (folder, summary.last_checkpoint.unwrap())
}

/// `seven`, as checkpoints of a run know it.
const SCENE: u64 = 0x44cd_1a7c_1490_7a28;

/// An update stage that does nothing, under any name.
struct Nothing(&'static str);

impl<D: Domain> UpdateStage<D> for Nothing {
    type Scratch = ();

    fn name(&self) -> &str {
        self.0
    }

    fn update(&self, _: &mut Own<'_, D>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        Ok(())
    }
}

fn simulation<D: Domain>(model: Model<D>) -> Simulation<D> {
    Simulation::new(model, settings(1)).unwrap()
}

/// A grid of 9 x 14 points under the name of the heat case, with these state columns.
fn other_columns(names: &[&str]) -> Model<Grid> {
    let domain = Grid::builder([9, 14]).build();
    let mut columns = Columns::new(domain.points());
    for name in names {
        columns.state::<f64>(name);
    }
    Model::with_fixed_dt("heat", domain, columns, Step::builder().build(), 0.1)
}

#[test]
fn another_method_or_scene() {
    let (_folder, path) = checkpoint();
    let mut other = simulation((LEAPFROG.model)());
    let error = other.restore(&path, SCENE).unwrap_err();
    assert!(
        matches!(&error, RestoreError::Checkpoint(CheckpointError::WrongMethod { expected, found, .. })
            if expected == "oscillators" && found == "heat"),
        "{error}"
    );
    let mut heat = simulation((HEAT.model)());
    let error = heat.restore(&path, 8).unwrap_err();
    assert!(matches!(error, RestoreError::Checkpoint(CheckpointError::WrongScene { .. })));
}

#[test]
fn another_number_of_points() {
    let (_folder, path) = checkpoint();
    let domain = Grid::builder([9, 15]).build();
    let mut columns = Columns::new(domain.points());
    columns.state::<f64>("temperature");
    let model = Model::with_fixed_dt("heat", domain, columns, Step::builder().build(), 0.1);
    let error = simulation(model).restore(&path, SCENE).unwrap_err();
    assert!(matches!(error, RestoreError::Points { expected: 135, found: 126, .. }), "{error}");
}

#[test]
fn other_columns_leave_the_simulation_as_it_was() {
    let (_folder, path) = checkpoint();
    for (names, word) in
        [(&["temperature", "salt"][..], "salt"), (&["warmth"], "warmth"), (&[], "temperature")]
    {
        let mut other = simulation(other_columns(names));
        let before = (other.state_hash(), other.position());
        let error = other.restore(&path, SCENE).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
        assert_eq!((other.state_hash(), other.position()), before);
    }
    let mut columns = Columns::new(126);
    columns.state::<f32>("temperature");
    let domain = Grid::builder([9, 14]).build();
    let model = Model::with_fixed_dt("heat", domain, columns, Step::builder().build(), 0.1);
    let error = simulation(model).restore(&path, SCENE).unwrap_err();
    assert!(matches!(error, RestoreError::Checkpoint(CheckpointError::WrongKind { .. })));
}

/// The same columns, but for what an integrator keeps between steps.
#[test]
fn another_integrator() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("leapfrog.ckpt");
    simulation((LEAPFROG.model)()).save(&path, SCENE).unwrap();
    let error = simulation((RK4.model)()).restore(&path, SCENE).unwrap_err();
    assert!(matches!(&error, RestoreError::Column { column, .. } if column == "acceleration"));
}

/// A domain that must save its division of space does not take a checkpoint without one.
#[test]
fn another_division_of_space() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("swarm.ckpt");
    let swarm = (run_models::SWARM.model)();
    let mut columns = Columns::new(swarm.columns.points());
    for (_, column) in swarm.columns.iter().filter(|(_, column)| column.is_kept()) {
        match column.kind() {
            ElementKind::U32 => drop(columns.state::<u32>(column.name())),
            _ => drop(columns.state::<f64>(column.name())),
        }
    }
    let domain = Independent::new(columns.points());
    let step = Step::builder()
        .stage_at(0.0, &Stage::update(Nothing("integrator update")))
        .stage_at(1.0, &Stage::update(Nothing("Repulsion")))
        .stage_at(1.0, &Stage::update(Nothing("integrator update")));
    let fake = Model::with_fixed_dt("swarm", domain, columns, step.build(), 0.1);
    simulation(fake).save(&path, SCENE).unwrap();
    let error = simulation(swarm).restore(&path, SCENE).unwrap_err();
    assert!(matches!(error, RestoreError::Domain { .. }), "{error}");
}

#[test]
fn another_monitor() {
    let (folder, path) = checkpoint();
    let simulation = simulation((HEAT.model)());
    let failed = run::Run::new(simulation)
        .until(Until { steps: Some(5), ..Until::default() })
        .out(folder.path())
        .scene("seven")
        .monitor("heat", Every::Steps(1), ["mean"], |_| [0.0])
        .restart_from(path)
        .run()
        .unwrap_err();
    assert!(matches!(failed.cause, RunFailure::Monitor { .. }), "{failed}");
}

/// Without a run loop: save, go on; restore elsewhere, go on.
#[test]
fn a_simulation_saves_itself() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ckpt");
    let mut first = simulation((HEAT.model)());
    first.advance(7).unwrap();
    first.save(&path, 1).unwrap();
    first.advance(6).unwrap();
    let mut second = Simulation::new((HEAT.model)(), settings(4)).unwrap();
    second.restore(&path, 1).unwrap();
    second.advance(6).unwrap();
    assert_eq!(first.state_hash(), second.state_hash());
    assert_eq!(first.position(), second.position());
}

#[test]
fn another_scene_says_what_differs() {
    let (folder, path) = checkpoint();
    let run = plan(&HEAT, settings(0), folder.path()).scene("seven\nresolution = 8");
    let until = Until { steps: Some(5), ..Until::default() };
    let failed = run.until(until).restart_from(&path).run().unwrap_err();
    let said = failed.to_string();
    assert!(said.ends_with("is of another scene: resolution = 8 here"), "{said}");
    // A main that returns it says so too.
    assert_eq!(format!("{failed:?}"), said);
}

#[test]
fn the_same_columns_stepped_otherwise() {
    let (_folder, path) = checkpoint();
    let mut model = (HEAT.model)();
    model.plan.step = Step::builder().update(Nothing("rest")).build();
    let error = simulation(model).restore(&path, SCENE).unwrap_err();
    assert!(
        matches!(&error, RestoreError::Step { expected, .. } if expected == "rest at 0"),
        "{error}"
    );
}

#[test]
fn an_end_before_the_checkpoint() {
    let (folder, path) = checkpoint();
    for (until, end) in [
        (Until { steps: Some(2), ..Until::default() }, "step 2"),
        (Until { time: Some(1e-9), ..Until::default() }, "time 0.000000001"),
    ] {
        let run = plan(&HEAT, settings(0), folder.path()).until(until);
        let failed = run.restart_from(&path).run().unwrap_err();
        assert!(
            matches!(&failed.cause, RunFailure::PastEnd { end: at, .. } if at == end),
            "{failed}"
        );
    }
}
