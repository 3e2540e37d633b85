//! Reports: what they run, write and say.

use std::path::Path;
use std::process::{Command, Output};

fn report(arguments: &[&str], folder: &Path) -> Output {
    let program = Command::new(env!("CARGO_BIN_EXE_finegrain"))
        .arg("report")
        .args(arguments)
        .current_dir(folder)
        .output();
    program.expect("the command starts")
}

#[test]
fn errors_and_their_cost_are_measured_and_written() {
    let folder = tempfile::tempdir().unwrap();
    let asked = ["speed-vs-error", "--scene", "poiseuille", "--method", "lbm", "--budget", "0.05"];
    let output = report(&asked, folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let out = folder.path().join("out/speed-vs-error");
    let table = std::fs::read_to_string(out.join("speed-vs-error.csv")).unwrap();
    let mut rows = table.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let names = rows.next().unwrap();
    let rows: Vec<_> = rows.collect();
    let column = |name| names.iter().position(|&n| n == name).unwrap();
    let number = |row: &[&str], name| row[column(name)].parse::<f64>().unwrap();
    // How many there are depends on the machine's speed.
    assert!(!rows.is_empty(), "{table}");
    for row in &rows {
        assert_eq!(row.len(), names.len(), "{row:?}");
        assert_eq!(row[column("method")], "lbm");
        assert!(number(row, "error") < 0.01 && number(row, "wall_s") > 0.0);
        // The command makes the very run.
        let command = row[column("command")].split(' ').skip(1);
        let again = Command::new(env!("CARGO_BIN_EXE_finegrain")).args(command).output().unwrap();
        let said = String::from_utf8_lossy(&again.stdout).into_owned();
        assert!(said.contains(row[column("state_hash")]), "{said}");
    }
    let page = std::fs::read_to_string(out.join("index.html")).unwrap();
    for part in ["Time to an error", "<polyline", "Machine: ", "--scene poiseuille"] {
        assert!(page.contains(part), "{part}");
    }
    // It needs nothing from elsewhere.
    assert!(!page.contains("http") && !page.contains("<script"));
    assert!(out.join("poiseuille.png").exists());
}

#[test]
fn what_there_was_no_time_for_is_listed() {
    let folder = tempfile::tempdir().unwrap();
    let asked = ["speed-vs-error", "--scene", "sphere-array", "--budget", "1e-4"];
    let output = report(&asked, folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let page = folder.path().join("out/speed-vs-error/index.html");
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("What was not run") && page.contains("sphere-array, LBM, 64 points"));
}

#[test]
fn a_comparison_that_there_is_not_is_named_with_those_that_there_are() {
    let folder = tempfile::tempdir().unwrap();
    let output = report(&["speed-vs-error", "--scene", "tailor"], folder.path());
    assert!(!output.status.success());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("tailor") && said.contains("taylor-green"), "{said}");
}

#[test]
fn scaling_is_measured_as_far_as_asked_and_forecast_further() {
    let folder = tempfile::tempdir().unwrap();
    let asked = ["scaling", "couette", "--workers", "2", "--repeats", "1", "--steps", "200"];
    let output = report(&asked, folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let out = folder.path().join("out/scaling");
    let table = std::fs::read_to_string(out.join("scaling.csv")).unwrap();
    let rows: Vec<Vec<_>> = table.lines().skip(1).map(|row| row.split(',').collect()).collect();
    for schedule in ["lockstep", "peer-to-peer", "fixed"] {
        let of = || rows.iter().filter(|row| row[0] == schedule);
        let workers: Vec<_> = of().map(|row| row[1]).collect();
        assert_eq!(workers, ["1", "2", "4", "8", "16", "32", "64", "128"]);
        for row in of() {
            let forecast: f64 = row[4].parse().unwrap();
            let with_this_memory: f64 = row[5].parse().unwrap();
            assert!(forecast > 0.0 && with_this_memory >= forecast, "{row:?}");
            assert_eq!(row[2].is_empty(), row[1].parse::<u32>().unwrap() > 2, "{row:?}");
        }
        // With one worker there is nothing to forecast but the step itself.
        let alone = of().next().unwrap();
        let [best, worst, forecast] = [2, 3, 4].map(|k| alone[k].parse::<f64>().unwrap());
        assert!(best <= worst && forecast < 20.0 * worst && best < 20.0 * forecast, "{alone:?}");
    }
    let page = std::fs::read_to_string(out.join("index.html")).unwrap();
    for part in ["Fig. 10", "Fig. 11", "Fig. 12", "couette", "Machine: "] {
        assert!(page.contains(part), "{part}");
    }
}

#[test]
fn a_run_too_short_to_say_what_a_step_costs_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let output = report(&["scaling", "couette", "--steps", "1"], folder.path());
    assert!(!output.status.success());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("--steps") && said.contains("at least 2"), "{said}");
}
