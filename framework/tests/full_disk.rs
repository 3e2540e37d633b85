//! A disk that is full: what is there stays whole, and the error names the file.
//!
//! The system's limit on the size of a file stands in for the disk: a write past it is cut short and
//! then fails, as on a full disk.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::Command;

use finegrain_framework::run::{Every, OutputError, Run, RunFailure, Until};
use finegrain_framework::space::Independent;
use finegrain_framework::*;

const FOLDER: &str = "FINEGRAIN_TEST_FULL_DISK";

/// A thousand points at which nothing happens.
fn run(folder: &Path) -> Run<Independent> {
    let mut columns = Columns::new(1000);
    columns.state::<f64>("value");
    let model =
        Model::with_fixed_dt("idle", Independent::new(1000), columns, Step::builder().build(), 1.0);
    let until = Until { steps: Some(10_000), ..Until::default() };
    Run::new(Simulation::new(model, Settings::default()).unwrap()).until(until).out(folder)
}

/// Runs the ignored test `name` in a process whose files cannot have more than a few thousand bytes.
fn on_a_full_disk(name: &str, folder: &Path) {
    let output = Command::new("sh")
        .args(["-c", "trap '' XFSZ; ulimit -f 4; exec \"$0\" \"$@\""])
        .arg(std::env::current_exe().unwrap())
        .args(["--exact", name, "--ignored"])
        .env(FOLDER, folder)
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
}

#[test]
fn a_row_of_a_history_is_whole_or_not_there() {
    let folder = tempfile::tempdir().unwrap();
    on_a_full_disk("histories_on_a_full_disk", folder.path());
    let text = fs::read_to_string(folder.path().join("steps.csv")).unwrap();
    assert!(text.len() > 1500 && text.ends_with('\n'), "{} bytes", text.len());
    let last = text.lines().last().unwrap();
    let step = text.lines().count() - 2;
    assert_eq!(last, format!("{step}.0,{step},{step}.0,0.0"));
}

#[test]
#[ignore = "run by a_row_of_a_history_is_whole_or_not_there"]
fn histories_on_a_full_disk() {
    let Some(folder) = std::env::var_os(FOLDER) else { return };
    let run = run(Path::new(&folder));
    let columns = ["number", "zero"];
    let failed = run
        .monitor("steps", Every::Steps(1), columns, |whole| [whole.step as f64, 0.0])
        .run()
        .unwrap_err();
    let RunFailure::Output(OutputError::File { path, .. }) = &failed.cause else {
        panic!("{failed}")
    };
    assert!(path.ends_with("steps.csv"), "{failed}");
}

#[test]
fn no_half_of_a_checkpoint_is_left() {
    let folder = tempfile::tempdir().unwrap();
    on_a_full_disk("checkpoints_on_a_full_disk", folder.path());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
#[ignore = "run by no_half_of_a_checkpoint_is_left"]
fn checkpoints_on_a_full_disk() {
    let Some(folder) = std::env::var_os(FOLDER) else { return };
    let failed = run(Path::new(&folder)).checkpoint(Every::Steps(5), 2).run().unwrap_err();
    assert!(failed.to_string().contains("checkpoint-000000005.ckpt"), "{failed}");
    assert_eq!(failed.last_checkpoint, None);
}
