//! What signals do to a run: SIGINT and SIGTERM end it in order, SIGUSR1 asks for a checkpoint.
#![cfg(unix)]

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// A run without an end; ended with the test, however that ends.
struct Running {
    child: Option<Child>,
    folder: tempfile::TempDir,
}

const SCENE: [&str; 4] = ["run", "taylor-green", "--set", "resolution=16"];

fn finegrain(folder: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_finegrain"));
    command.args(SCENE).args(more).current_dir(folder);
    command
}

impl Running {
    /// Returns when the run has begun to write.
    fn start() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let endless = ["--steps", "1000000000", "--dump-every", "1000000000", "--out", "out"];
        let child = finegrain(folder.path(), &endless)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        Self { child: Some(child), folder }
    }

    /// Waits until `done`, or until the run has ended.
    fn until(&mut self, done: impl Fn(&Path) -> bool) {
        while !done(self.folder.path()) && self.is_running() {
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    fn is_running(&mut self) -> bool {
        self.child.as_mut().unwrap().try_wait().unwrap().is_none()
    }

    fn send(&mut self, signal: &str) {
        assert!(self.is_running());
        let id = self.child.as_ref().unwrap().id().to_string();
        assert!(Command::new("kill").args([signal, &id]).status().unwrap().success());
    }

    fn end(&mut self) -> Output {
        self.child.take().unwrap().wait_with_output().unwrap()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        if let Some(mut child) = self.child.take() {
            // It may have ended by itself.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// The checkpoints in the folder `out`, in order.
fn checkpoints(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder.join("out")).into_iter().flatten();
    let paths = entries.map(|entry| entry.unwrap().path());
    let mut paths: Vec<_> =
        paths.filter(|path| path.extension() == Some("ckpt".as_ref())).collect();
    paths.sort_unstable();
    paths
}

fn has_begun(folder: &Path) -> bool {
    folder.join("out/fields.pvd").exists()
}

#[test]
fn a_request_to_stop_ends_the_run_in_order_with_a_checkpoint() {
    for signal in ["-INT", "-TERM"] {
        let mut run = Running::start();
        run.until(has_begun);
        run.send(signal);
        let output = run.end();
        let said = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(0), "{signal}: {output:?}");
        assert!(said.contains("stopped on request"), "{signal}: {said}");
        let [checkpoint] = &checkpoints(run.folder.path())[..] else { panic!("{said}") };
        let restart = ["--wall-clock", "0.001", "--restart", checkpoint.to_str().unwrap()];
        assert!(finegrain(run.folder.path(), &restart).output().unwrap().status.success());
    }
}

/// In the moment when the steps are done and the rest is being written, as good as can be met.
#[test]
fn a_request_to_stop_that_comes_late_loses_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let last = ["--steps", "3", "--out", "out", "--set", "resolution=200"];
    let child = finegrain(folder.path(), &last)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut run = Running { child: Some(child), folder };
    run.until(|folder| !checkpoints(folder).is_empty());
    let id = run.child.as_ref().unwrap().id().to_string();
    // Too late is no failure.
    let _ = Command::new("kill").args(["-INT", &id]).status().unwrap();
    let output = run.end();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(run.folder.path().join("out/final.png").exists());
}

#[test]
fn a_request_for_a_checkpoint_leaves_one_while_the_run_goes_on() {
    let mut run = Running::start();
    run.until(has_begun);
    for count in 1..=2 {
        run.send("-USR1");
        run.until(|folder| checkpoints(folder).len() == count);
    }
    assert!(run.is_running(), "{:?}", run.end());
    run.send("-INT");
    assert_eq!(run.end().status.code(), Some(0));
    assert_eq!(checkpoints(run.folder.path()).len(), 3, "and one at the end");
}
