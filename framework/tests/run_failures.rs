//! A run that fails says why, names the last good checkpoint, and leaves only whole files.

mod run_models;

use std::error::Error;
use std::fs;
use std::path::Path;

use finegrain_framework::checkpoint::CheckpointReader;
use finegrain_framework::port::Port;
use finegrain_framework::run::{Dump, Every, OutputError, Run, RunFailed, RunFailure, Until};
use finegrain_framework::space::{Grid, Independent};
use finegrain_framework::*;
use run_models::{HEAT, LEAPFROG, checkpoints, files, plan, settings};

const TEN_STEPS: Until = Until { steps: Some(10), time: None, wall_clock: None };

/// A stage that spoils one point at step `at`.
struct Spoil {
    value: State<f64>,
    at: u64,
    how: How,
}

#[derive(Clone, Copy, PartialEq)]
enum How {
    Panic,
    Fault,
    NotFinite,
}

impl UpdateStage<Independent> for Spoil {
    type Scratch = ();

    fn update(
        &self,
        own: &mut Own<'_, Independent>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        let value = own.state_mut(self.value).whole();
        value[0] += 1.0;
        if moment.step != self.at || own.id() != 3 {
            return Ok(());
        }
        match self.how {
            How::Panic => panic!("spoiled"),
            How::Fault => Err(Fault::new("spoiled")),
            How::NotFinite => {
                value[0] = f64::NAN;
                Ok(())
            }
        }
    }
}

fn spoiled(folder: &Path, how: How, settings: Settings) -> Run<Independent> {
    let domain = Independent::with_share(40, 8);
    let mut columns = Columns::new(40);
    let value = columns.state("value");
    let step = Step::builder().update(Spoil { value, at: 6, how }).build();
    let model = Model::with_fixed_dt("spoiled", domain, columns, step, 0.5);
    Run::new(Simulation::new(model, settings).unwrap())
        .until(TEN_STEPS)
        .out(folder)
        .monitor("sum", Every::Steps(1), ["value"], move |whole| {
            whole.sum(|near| [near.state(value).own().whole().iter().sum()])
        })
        .dump(Dump::new("values", Every::Steps(2)).scalar("value"))
        .checkpoint(Every::Steps(2), 5)
}

/// The checkpoints in the folder are sound, the series lists what is there, lines are whole, and
/// nothing half written lies around.
fn assert_whole(folder: &Path) {
    for name in checkpoints(folder) {
        CheckpointReader::open(folder.join(name)).unwrap();
    }
    let files = files(folder);
    assert!(files.keys().all(|name| !name.ends_with(".part")), "{:?}", files.keys());
    let series = files.iter().filter(|(name, _)| name.ends_with(".pvd"));
    for (_, series) in series {
        let series = String::from_utf8(series.clone()).unwrap();
        assert!(series.ends_with("</VTKFile>\n"));
        let listed = series.split("file=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
        assert!(listed.into_iter().all(|file| files[file].ends_with(b"</VTKFile>\n")));
    }
    let histories = files.iter().filter(|(name, _)| name.ends_with(".csv"));
    assert!(histories.into_iter().all(|(_, text)| text.ends_with(b"\n")));
}

#[test]
fn a_stage_that_fails() {
    for (number, how) in [How::Panic, How::Fault, How::NotFinite].into_iter().enumerate() {
        for schedule in Schedule::ALL {
            let folder = tempfile::tempdir().unwrap();
            let settings =
                Settings { schedule, check_every: Some(1), ..run_models::settings(number) };
            let mut run = spoiled(folder.path(), how, settings.clone());
            let failed = run.run().unwrap_err();
            let RunFailure::Step(error) = &failed.cause else { panic!("{failed}") };
            let place = (&*error.method, error.step, error.time, error.sub_domain);
            assert_eq!(place, ("spoiled", 6, 3.0, Some(3)));
            assert_eq!(error.stage, "Spoil");
            let last = folder.path().join("checkpoint-000000006.ckpt");
            assert_eq!(failed.last_checkpoint.as_deref(), Some(&*last));
            assert!(failed.to_string().contains("checkpoint-000000006.ckpt"), "{failed}");
            assert_whole(folder.path());
            let csv = String::from_utf8(files(folder.path())["sum.csv"].clone()).unwrap();
            assert_eq!(csv.lines().count(), 1 + 7);
            // What was right again can go on from there.
            let mut mended = spoiled(folder.path(), How::Fault, settings).restart_from(last);
            let failed = mended.run().unwrap_err();
            assert!(matches!(&failed.cause, RunFailure::Step(error) if error.step == 6));
        }
    }
}

/// Stages are checked every ten steps here; the checkpoint before that is not written.
#[test]
fn a_checkpoint_never_holds_nan() {
    let folder = tempfile::tempdir().unwrap();
    let settings = Settings { check_every: Some(10), ..settings(1) };
    let failed = spoiled(folder.path(), How::NotFinite, settings).run().unwrap_err();
    let RunFailure::Step(error) = &failed.cause else { panic!("{failed}") };
    assert_eq!((error.step, error.sub_domain), (8, Some(3)));
    assert_eq!(error.cause, Cause::NotFinite { column: "value".to_owned() });
    let last = folder.path().join("checkpoint-000000006.ckpt");
    assert_eq!(failed.last_checkpoint.as_deref(), Some(&*last));
    assert_whole(folder.path());
}

/// Nor does a run that ends before the next check end well.
#[test]
fn an_end_is_never_nan() {
    let folder = tempfile::tempdir().unwrap();
    let settings = Settings { check_every: Some(10), ..settings(1) };
    let mut run = spoiled(folder.path(), How::NotFinite, settings);
    run = run.checkpoint(Every::Steps(100), 1).until(Until { steps: Some(7), ..TEN_STEPS });
    let failed = run.run().unwrap_err();
    assert!(matches!(&failed.cause, RunFailure::Step(error) if error.step == 7), "{failed}");
}

#[test]
fn a_monitor_that_panics() {
    let folder = tempfile::tempdir().unwrap();
    let failed = plan(&HEAT, settings(1), folder.path())
        .until(TEN_STEPS)
        .monitor("broken", Every::Steps(4), ["x"], |whole| {
            assert!(whole.step < 4, "no more");
            [0.0]
        })
        .run()
        .unwrap_err();
    let RunFailure::Step(error) = &failed.cause else { panic!("{failed}") };
    assert_eq!((error.step, &*error.stage), (4, "monitor broken"));
    assert_eq!(error.cause, Cause::Panic("no more".to_owned()));
    assert_eq!(failed.last_checkpoint, None);
    assert_whole(folder.path());
}

/// The run ends, says which file, and what was written before stays.
#[test]
fn a_dump_that_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let in_the_way = folder.path().join("points-000000005.vti");
    fs::create_dir(&in_the_way).unwrap();
    let failed = plan(&LEAPFROG, settings(1), folder.path())
        .until(Until { steps: Some(1_000_000), ..Until::default() })
        .checkpoint(Every::Steps(3), 2)
        .run()
        .unwrap_err();
    assert!(matches!(failed.cause, RunFailure::Output(OutputError::Format(_))), "{failed}");
    assert!(failed.to_string().contains("points-000000005.vti"), "{failed}");
    assert!(failed.source().is_some());
    assert!(CheckpointReader::open(failed.last_checkpoint.unwrap()).is_ok());
    fs::remove_dir(&in_the_way).unwrap();
    assert_whole(folder.path());
}

/// What a run that was killed has left half written goes when the next one begins.
#[test]
fn leftovers_of_a_killed_run() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(".checkpoint-000000003.ckpt.17-2.part"), "half").unwrap();
    plan(&HEAT, settings(1), folder.path()).until(TEN_STEPS).run().unwrap();
    assert_whole(folder.path());
}

/// The first checkpoint is good and stays so when the second cannot be written.
#[test]
fn a_checkpoint_that_cannot_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let in_the_way = folder.path().join("checkpoint-000000006.ckpt");
    fs::create_dir(&in_the_way).unwrap();
    let failed = plan(&LEAPFROG, settings(2), folder.path())
        .until(TEN_STEPS)
        .checkpoint(Every::Steps(3), 1)
        .run()
        .unwrap_err();
    assert!(failed.to_string().contains("checkpoint-000000006.ckpt"), "{failed}");
    // Those that follow may still be written before the failure is seen.
    assert!(CheckpointReader::open(failed.last_checkpoint.unwrap()).is_ok());
}

#[test]
fn a_folder_that_is_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("out");
    fs::write(&file, "mine").unwrap();
    let failed = plan(&HEAT, settings(0), &file).until(TEN_STEPS).run().unwrap_err();
    let RunFailure::Output(OutputError::File { path, .. }) = &failed.cause else {
        panic!("{failed}")
    };
    assert_eq!(path, &file);
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
}

/// How a plan is refused.
fn refusal(plan: impl FnOnce(Run<Grid>) -> Run<Grid>) -> RunFailed {
    let simulation = Simulation::new((HEAT.model)(), settings(0)).unwrap();
    plan(Run::new(simulation).until(TEN_STEPS)).run().unwrap_err()
}

#[test]
fn plans_that_make_no_sense() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let fields = || Dump::new("fields", Every::Steps(1));
    let zero = |name: &'static str, every| {
        move |run: Run<Grid>| run.monitor(name, every, ["x"], |_| [0.0])
    };
    let cases: [(RunFailed, &[&str]); 12] = [
        (
            refusal(|run| run.out(out).dump(fields().scalar("pressure"))),
            &["pressure", "temperature"],
        ),
        (refusal(|run| run.out(out).dump(fields().vector("v", []))), &["`v`", "0", "1 to 3"]),
        (refusal(|run| run.dump(fields())), &["`fields`", "folder"]),
        (refusal(|run| run.out(out).dump(fields()).dump(fields())), &["fields", "twice"]),
        (refusal(|run| run.checkpoint(Every::Steps(1), 1)), &["checkpoints", "folder"]),
        (refusal(|run| run.out(out).checkpoint(Every::Steps(1), 0)), &["keep", "0", "at least 1"]),
        (refusal(|run| run.checkpoint_on(Port::unbounded("x").1)), &["request", "folder"]),
        (refusal(zero("heat", Every::Steps(0))), &["heat", "0", "at least 1"]),
        (refusal(zero("heat", Every::Time(-0.5))), &["heat", "-0.5", "positive"]),
        (refusal(zero("../heat", Every::Steps(1))), &["../heat", "letters"]),
        (
            refusal(|run| run.monitor("heat", Every::Steps(1), ["x", "x"], |_| [0.0; 2])),
            &["`x`", "taken"],
        ),
        (
            refusal(|run| run.until(Until { time: Some(f64::NAN), ..Until::default() })),
            &["end time", "NaN", "finite"],
        ),
    ];
    for (failed, words) in cases {
        let message = failed.to_string();
        assert!(
            words.iter().all(|word| message.contains(word)),
            "{message} lacks one of {words:?}"
        );
    }
    assert_eq!(fs::read_dir(out).unwrap().count(), 0);
}

/// Locks of folders are the system's: elsewhere two runs into one folder are the user's affair.
#[test]
#[cfg(unix)]
fn two_runs_into_one_folder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_path_buf();
    let another = move || plan(&HEAT, settings(1), &path).until(TEN_STEPS).run();
    let meanwhile = another.clone();
    let mut run = plan(&HEAT, settings(1), folder.path()).until(TEN_STEPS).monitor(
        "refused",
        Every::Steps(5),
        ["refused"],
        move |_| {
            let failed = meanwhile().err().map(|failed| failed.cause);
            [f64::from(matches!(failed, Some(RunFailure::Output(OutputError::InUse { .. }))))]
        },
    );
    let summary = run.run().unwrap();
    let refused: Vec<f64> = summary.histories[1].column("refused").unwrap().collect();
    assert_eq!(refused, [1.0; 3]);
    let written = files(folder.path());
    another().unwrap();
    assert_eq!(written["heat.csv"], files(folder.path())["heat.csv"]);
}
