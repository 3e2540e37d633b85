//! The main job, `finegrain bench cylinder`, in its smallest size: what it says, its numbers and its
//! pictures; and the picture of a run.

mod png_file;

use std::collections::HashMap;
use std::path::Path;
use std::process::Command;

use png_file::decoded;

fn finegrain(arguments: &[&str], folder: &Path) -> String {
    let command = Command::new(env!("CARGO_BIN_EXE_finegrain"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the command starts");
    assert!(command.status.success(), "{}", String::from_utf8_lossy(&command.stderr));
    String::from_utf8_lossy(&command.stdout).into_owned()
}

/// The fields of a line of CSV, some of them quoted.
fn fields(line: &str) -> Vec<String> {
    let mut is_quoted = false;
    let ends = |c: char| {
        is_quoted ^= c == '"';
        c == ',' && !is_quoted
    };
    line.split(ends).map(|field| field.trim_matches('"').to_owned()).collect()
}

/// The rows of a CSV table, by the names of its columns.
fn table(path: &Path) -> Vec<HashMap<String, String>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines().map(fields);
    let header = lines.next().expect("a header");
    let row = |line: Vec<String>| {
        assert_eq!(line.len(), header.len(), "{line:?}");
        header.iter().cloned().zip(line).collect()
    };
    lines.map(row).collect()
}

fn is(value: f64, expected: f64) -> bool {
    (value / expected - 1.0).abs() < 1e-3
}

#[test]
fn the_benchmark_measures_what_it_says() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--sizes", "0.0003", "--workers", "1,2", "--steps", "12", "--repeats", "1"];
    let said = finegrain(
        &[&["bench", "cylinder", "--out", "out"], &arguments[..]].concat(),
        folder.path(),
    );
    let out = folder.path().join("out");

    let rows = table(&out.join("cylinder.csv"));
    assert_eq!(rows.len(), 2);
    let number = |row: &HashMap<String, String>, column: &str| -> f64 {
        row[column].parse().unwrap_or_else(|_| panic!("{column} of {row:?}"))
    };
    for (row, workers) in rows.iter().zip([1.0, 2.0]) {
        let of = |column| number(row, column);
        assert_eq!(of("width_m"), 0.0003);
        assert_eq!(of("workers"), workers);
        // Two layers of 125 by 144, as the packing's cell of 0.2 mm by 0.2 sqrt(3) mm fits 25 mm.
        assert_eq!(of("particles"), 36_000.0);
        // Nearer than three spacings in hexagonal close packing: its theta series, OEIS A004012.
        assert!((of("neighbours") - 146.0).abs() < 0.5, "{row:?}");
        assert_eq!(of("sweeps"), 2.0);
        assert!(of("seconds_per_step_best") <= of("seconds_per_step_median"));
        let pairs = of("particles") * of("neighbours") / (workers * of("seconds_per_step_median"));
        assert!(is(of("pairs_per_s_and_core"), pairs), "{row:?}");
        assert!(is(of("pair_interactions_per_s_and_core"), 2.0 * pairs), "{row:?}");
        assert!((100.0..2000.0).contains(&of("bytes_per_particle")), "{row:?}");
    }
    let (one, two) = (&rows[0], |column: &str| number(&rows[1], column));
    assert_eq!(one["speed_up"], "");
    for (speed_up, seconds) in
        [("speed_up", "seconds_per_step_median"), ("speed_up_best", "seconds_per_step_best")]
    {
        assert!(is(two(speed_up), number(one, seconds) / two(seconds)), "{rows:?}");
    }
    assert!(is(two("efficiency"), 0.5 * two("speed_up")), "{rows:?}");
    let product = two("stage_efficiency") * two("schedule_efficiency");
    assert!(is(two("efficiency"), product), "{rows:?}");
    assert!(two("machine_efficiency") > 0.0);

    let parts = table(&out.join("where-time-goes.csv"));
    let shares: f64 = parts.iter().map(|part| number(part, "share")).sum();
    assert!((shares - 1.0).abs() < 0.02, "{parts:?}");

    for picture in ["fig10-time-per-step.png", "fig11-speed-up.png", "fig12-efficiency.png"] {
        let (width, height, colours) = decoded(&out.join(picture));
        assert!(width >= 400 && height >= 300, "{picture}");
        // The line of the measurements, beside text and axes.
        assert!(colours.get(&[0x00, 0x72, 0xb2]).is_some_and(|&n| n > 100), "{picture} is empty");
    }
    let (.., colours) = decoded(&out.join("flow.png"));
    assert!(colours.len() > 100, "the flow has {} colours", colours.len());
    assert!(said.contains("flow.png"), "{said}");
    for workers in ["workers-1", "workers-2"] {
        assert!(out.join(workers).join("results.pvd").exists());
    }
    assert!(!out.join("separate").exists(), "what separate runs write is not kept");
    // What the paper leaves open.
    assert!(said.contains("fitted to whole layers"), "{said}");
    assert!(said.contains("36000 particles"), "{said}");
}

#[test]
fn a_run_leaves_a_picture_of_its_field() {
    let folder = tempfile::tempdir().unwrap();
    for (scene, method) in
        [("taylor-green", "sph"), ("taylor-green", "lbm"), ("taylor-green", "fd")]
    {
        let arguments = [
            "run",
            scene,
            "--method",
            method,
            "--set",
            "resolution=16",
            "--steps",
            "2",
            "--out",
            method,
        ];
        finegrain(&arguments, folder.path());
        let (width, height, colours) = decoded(&folder.path().join(method).join("final.png"));
        assert!(width >= 400 && height >= 300, "{method}");
        // A vortex has all speeds from none to the largest, and so all colours between.
        assert!(colours.len() > 100, "{method}: {} colours", colours.len());
    }
}
