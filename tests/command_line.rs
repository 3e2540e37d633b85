//! The command line: what it prints, what it writes, and what it says to bad input.

use std::path::Path;
use std::process::{Command, Output};

use finegrain::scene::SCENES;
use serde_json::Value;

fn finegrain(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_finegrain"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("the command starts")
}

/// The JSON object on the last line of standard output.
fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(text.lines().last().expect("a last line")).expect("JSON")
}

/// What a command that must fail says.
fn complaint(arguments: &[&str], folder: &Path) -> String {
    let output = finegrain(arguments, folder);
    assert!(!output.status.success(), "{arguments:?} must fail");
    assert!(output.status.code().is_some(), "{arguments:?} must not be killed");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!text.contains("panicked"), "{text}");
    text
}

const SMALL: [&str; 4] = ["run", "taylor-green", "--set", "resolution=16"];

fn small<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&SMALL[..], more].concat()
}

#[test]
fn scenes_are_listed_with_their_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let said = |arguments: &[&str]| {
        let output = finegrain(arguments, folder.path());
        assert!(output.status.success(), "{output:?}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let all = said(&["scenes"]);
    for scene in SCENES {
        assert!(all.lines().any(|line| line.starts_with(scene.name)), "{} in {all}", scene.name);
    }
    let cylinder = said(&["scenes", "cylinder"]);
    for word in ["--method lbm", "solid_fraction", "between 0.001 and 0.5"] {
        assert!(cylinder.contains(word), "{word} in {cylinder}");
    }
    let of_lbm = said(&["scenes", "cylinder", "--method", "lbm"]);
    assert!(of_lbm.contains("collision") && !of_lbm.contains("kernel"), "{of_lbm}");
    assert!(!finegrain(&["scenes", "cylindre"], folder.path()).status.success());
}

#[test]
fn a_trace_shows_every_part_of_every_worker() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = small(&["--steps", "4", "--workers", "2", "--trace", "trace.json", "--json"]);
    let output = finegrain(&arguments, folder.path());
    assert!(String::from_utf8_lossy(&output.stdout).contains("balance"));
    let line = json(&output);
    let text = std::fs::read_to_string(folder.path().join("trace.json")).unwrap();
    let trace: Value = serde_json::from_str(&text).unwrap();
    let events = trace["traceEvents"].as_array().unwrap();
    let rows: Vec<_> =
        events.iter().filter(|e| e["ph"] == "M").map(|e| &e["args"]["name"]).collect();
    assert_eq!(rows, ["worker 0", "worker 1", "steps"]);
    let mut parts = std::collections::BTreeSet::new();
    for event in events.iter().filter(|e| e["ph"] == "X" && e["tid"] != 2) {
        assert!(event["dur"].as_f64().is_some_and(|duration| duration >= 0.0));
        assert!(event["tid"].as_u64().is_some_and(|worker| worker < 2));
        assert!(event["name"].as_str().is_some_and(|name| !name.is_empty()));
        let place = ["step", "part", "sub_domain"].map(|key| event["args"][key].as_u64().unwrap());
        assert!(parts.insert(place), "{place:?} twice");
    }
    // As many in each of the steps, and the same bits as without.
    let of_step = |step| parts.iter().filter(|part| part[0] == step).count();
    assert!(of_step(0) > 4 && (1..4).all(|step| of_step(step) == of_step(0)));
    let plain = json(&finegrain(&small(&["--steps", "4", "--json"]), folder.path()));
    assert_eq!(line["state_hash"], plain["state_hash"]);
    // A run that fails leaves what stood there, and the checkpoint it should restart from is no place for a trace.
    std::fs::write(folder.path().join("a"), "precious").unwrap();
    for trace in ["trace.json", "a"] {
        complaint(&small(&["--restart", "a", "--trace", trace]), folder.path());
    }
    assert_eq!(std::fs::read_to_string(folder.path().join("a")).unwrap(), "precious");
    assert_eq!(std::fs::read_to_string(folder.path().join("trace.json")).unwrap(), text);
    let nowhere = small(&["--steps", "1", "--trace", "no/such/folder/t.json"]);
    assert!(
        complaint(&nowhere, folder.path()).contains("cannot write trace `no/such/folder/t.json`")
    );
}

#[test]
fn the_last_line_is_json_with_everything_in_it() {
    let folder = tempfile::tempdir().unwrap();
    let line = json(&finegrain(&small(&["--steps", "5", "--json"]), folder.path()));
    assert_eq!(line["scene"], "taylor-green");
    assert_eq!(line["method"], "sph");
    assert_eq!(line["steps"], 5);
    assert_eq!(line["points"], 256);
    assert_eq!(line["parameters"]["resolution"], 16);
    assert_eq!(line["state_hash"].as_str().map(str::len), Some(16));
    for key in ["time", "wall_s", "point_steps_per_s"] {
        assert!(line[key].as_f64().is_some_and(|x| x > 0.0), "{key}");
    }
    assert!(line["results"]["decay_rate"].is_f64() && line["errors"]["decay_rate"].is_f64());
}

#[test]
fn only_parameters_with_an_effect_are_in_the_json() {
    let folder = tempfile::tempdir().unwrap();
    let has = |more: &[&str], name: &str| {
        let orders = [&["--method", "lbm", "--steps", "1", "--json"], more].concat();
        json(&finegrain(&small(&orders), folder.path()))["parameters"].get(name).is_some()
    };
    assert!(!has(&[], "lattice") && has(&["--set", "dim=3"], "lattice"));
    assert!(!has(&[], "magic") && has(&["--set", "collision=trt"], "magic"));
}

#[test]
fn who_stops_listening_loses_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_finegrain"))
        .args(small(&["--steps", "2", "--out", "out"]))
        .current_dir(folder.path())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    assert!(child.wait().unwrap().success());
    for file in ["final.png", "fields.pvd", "checkpoint-000000002.ckpt"] {
        assert!(folder.path().join("out").join(file).exists(), "{file}");
    }
}

#[test]
fn a_folder_with_files_of_an_earlier_run_is_pointed_out() {
    let folder = tempfile::tempdir().unwrap();
    let run = || finegrain(&small(&["--steps", "2", "--out", "out"]), folder.path()).stderr;
    let [first, second] = [run(), run()].map(|said| String::from_utf8(said).unwrap());
    assert!(!first.contains("earlier run"), "{first}");
    for word in ["earlier run", "checkpoint-000000002.ckpt", "final.png"] {
        assert!(second.contains(word), "{word} in {second}");
    }
}

#[test]
fn small_scenes_take_few_workers_unless_more_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let workers = |more: &[&str]| {
        let orders = [&["--steps", "1", "--json"], more].concat();
        json(&finegrain(&small(&orders), folder.path()))["workers"].clone()
    };
    assert_eq!(workers(&[]), 1);
    assert_eq!(workers(&["--workers", "3"]), 3);
}

#[test]
fn a_flow_that_no_mesh_here_resolves_is_said_to_be_none() {
    let folder = tempfile::tempdir().unwrap();
    let notes = |reynolds: &str| {
        let orders = ["--method", "lbm", "--set", reynolds, "--steps", "2", "--json"];
        json(&finegrain(&small(&orders), folder.path()))["notes"].to_string()
    };
    // 16 sites: up to a Reynolds number of 16^2.
    assert!(!notes("reynolds=250").contains("not resolved"));
    assert!(notes("reynolds=260").contains("grid Reynolds number"));
}

/// BGK on a mesh too coarse: populations grow for hundreds of steps before they are infinite.
#[test]
fn a_flow_that_has_lost_all_sense_ends_the_run_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let settings = ["resolution=32", "collision=bgk", "reynolds=5000"];
    let mut orders = vec!["run", "cavity", "--method", "lbm", "--until", "20", "--out", "out"];
    settings.iter().for_each(|setting| orders.extend(["--set", setting]));
    let said = complaint(&orders, folder.path());
    assert!(said.contains("the flow is unstable; choose another collision"), "{said}");
    let history = std::fs::read_to_string(folder.path().join("out/flow.csv")).unwrap();
    let energies = history.lines().skip(1).map(|row| row.split(',').nth(2).unwrap());
    let most = energies.map(|energy| energy.parse().unwrap()).fold(0.0, f64::max);
    // Of a fluid that all moves as fast as the lid, 0.5; without the limit, 1e126.
    assert!(most < 1e3, "kinetic energy {most}");
}

#[test]
fn workers_and_schedules_do_not_change_the_hash() {
    let folder = tempfile::tempdir().unwrap();
    let hash = |more: &[&str]| {
        let orders = [&["--steps", "12", "--json"], more].concat();
        json(&finegrain(&small(&orders), folder.path()))["state_hash"].clone()
    };
    let expected = hash(&["--schedule", "serial"]);
    for schedule in ["lockstep", "peer-to-peer", "fork-join", "fixed"] {
        assert_eq!(hash(&["--schedule", schedule, "--workers", "3"]), expected, "{schedule}");
    }
    assert_ne!(hash(&["--precision", "f32"]), expected);
}

/// Restarts a run of 37 steps, which begins with these arguments, from each of its checkpoints.
fn restarts_with_the_same_bits(scene: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let run = |more: &[&str]| {
        let orders = [&["--steps", "37", "--json"], more].concat();
        json(&finegrain(&[scene, &orders].concat(), folder.path()))
    };
    // More checkpoints than are kept: runs that end earlier leave the others.
    for (out, end) in [("early", "19"), ("late", "37")] {
        let orders = ["--steps", end, "--out", out, "--checkpoint-every", "6"];
        finegrain(&[scene, &orders].concat(), folder.path());
    }
    let whole = run(&[]);
    let mut restarts = 0;
    for out in ["early", "late"] {
        for entry in std::fs::read_dir(folder.path().join(out)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|e| e == "ckpt") {
                let path = path.to_str().unwrap();
                let other = ["--workers", "3", "--schedule", "peer-to-peer"];
                let again = run(&[&["--restart", path], &other[..]].concat());
                assert_eq!(again["state_hash"], whole["state_hash"], "{scene:?} from {path}");
                restarts += 1;
            }
        }
    }
    assert_eq!(restarts, 6);
}

#[test]
fn a_restarted_run_ends_with_the_bits_of_the_uninterrupted_one() {
    for integrator in ["leapfrog", "symplectic-euler", "rk2", "ssp-rk3", "rk4", "euler"] {
        let integrator = format!("integrator={integrator}");
        let moving = ["--set", "background_pressure=0.1", "--set", "courant=0.5"];
        restarts_with_the_same_bits(&small(&[&["--set", &integrator], &moving[..]].concat()));
    }
    restarts_with_the_same_bits(&small(&["--precision", "mixed"]));
}

#[test]
fn so_does_one_with_walls_a_free_surface_or_gas() {
    let edac =
        ["transport=1", "density=summation", "pressure=edac", "pressure_form=density-weighted"];
    for (scene, resolution, more) in [
        ("couette", "resolution=10", &edac[..]),
        ("cylinder", "resolution=16", &["viscous_form=strain-rate"]),
        ("dam-break", "resolution=8", &["shifting=on"]),
        ("sod", "resolution=50", &["integrator=rk2"]),
    ] {
        let settings = more.iter().flat_map(|setting| ["--set", setting]);
        let begin = ["run", scene, "--set", resolution].into_iter().chain(settings);
        restarts_with_the_same_bits(&begin.collect::<Vec<_>>());
    }
}

#[test]
fn a_scene_file_sets_parameters_and_the_command_line_goes_over_it() {
    let folder = tempfile::tempdir().unwrap();
    let file = "scene = \"taylor-green\"\nprecision = \"f32\"\n[parameters]\nresolution = 12\n\
                kernel = \"quintic-spline\"\n";
    std::fs::write(folder.path().join("my.toml"), file).unwrap();
    let line = json(&finegrain(
        &["run", "my.toml", "--set", "reynolds=50", "--steps", "2", "--json"],
        folder.path(),
    ));
    assert_eq!(line["points"], 144);
    assert_eq!(line["precision"], "f32");
    assert_eq!(line["parameters"]["kernel"], "quintic-spline");
    assert_eq!(line["parameters"]["reynolds"], 50.0);
}

#[test]
fn bad_arguments_are_named_with_what_would_be_right() {
    let folder = tempfile::tempdir().unwrap();
    let says = |arguments: &[&str], words: &[&str]| {
        let text = complaint(arguments, folder.path());
        for word in words {
            assert!(text.contains(word), "{word:?} in {text}");
        }
    };
    says(&["run", "cylindre"], &["cylindre", "cylinder, taylor-green"]);
    says(&small(&["--set", "resolution=4"]), &["resolution = 4", "between 8 and 4000"]);
    says(&small(&["--set", "resolution=NaN"]), &["resolution = NaN"]);
    says(&small(&["--set", "resolution=24.6"]), &["resolution = 24.6", "whole number"]);
    says(&small(&["--set", "dim=2.5"]), &["dim = 2.5", "between 2 and 3"]);
    says(&small(&["--set", "viscocity=1"]), &["viscocity", "reynolds"]);
    says(&small(&["--set", "kernel=box"]), &["kernel = box", "gaussian"]);
    says(&small(&["--set", "resolution"]), &["KEY=VALUE"]);
    says(&small(&["--method", "fem"]), &["fem", "sph, lbm"]);
    says(&small(&["--method", "lbm", "--set", "kernel=gaussian"]), &["kernel", "collision"]);
    says(&small(&["--schedule", "chaos"]), &["chaos", "peer-to-peer"]);
    says(&small(&["--set", "resolution=4"]), &["scene \"taylor-green\"", "--method sph"]);
    let kernel = ["run", "cylinder", "--method", "fd", "--set", "kernel=gaussian"];
    says(&kernel, &["scene \"cylinder\"", "--method fd", "there is one with sph"]);
    says(&["run", "cylinder", "--method", "fd", "--set", "dim=3"], &["it must be 2 only"]);
    let implicit = ["run", "heat", "--set", "courant=2"];
    says(&implicit, &["courant = 2", "at most 1 with integrator = rk4"]);
    says(&["run", "."], &["`.` is no scene file", ".toml"]);
    says(&small(&["--workers", "0"]), &["workers", "0"]);
    says(&small(&["--steps", "-3"]), &["-3", "at least 0"]);
    says(&small(&["--out", "out", "--dump-every", "0"]), &["0", "at least 1"]);
    says(&small(&["--until", "-1"]), &["-1"]);
    says(&small(&["--checkpoint-every", "5"]), &["--out"]);
    says(&small(&["--restart", "nowhere.ckpt"]), &["nowhere.ckpt"]);
    says(&["run", "nowhere.toml"], &["nowhere.toml"]);
    says(&["run", "cylinder", "--set", "solid_fraction=0.6"], &["solid_fraction", "0.5"]);
    let mixed = ["run", "couette", "--method", "lbm", "--precision", "mixed"];
    says(&mixed, &["lbm", "mixed", "f32 and f64"]);
    says(&["run", "couette", "--set", "transport=1"], &["transport", "density = summation"]);
}

#[test]
fn bad_scene_files_are_named_with_line_and_key() {
    let folder = tempfile::tempdir().unwrap();
    let says = |text: &str, words: &[&str]| {
        std::fs::write(folder.path().join("bad.toml"), text).unwrap();
        let said = complaint(&["run", "bad.toml"], folder.path());
        for word in ["bad.toml"].iter().chain(words) {
            assert!(said.contains(word), "{word:?} in {said}");
        }
    };
    says("scene = \"cylinder\"\nresolution = 5\n", &["resolution"]);
    says(
        "scene = \"cylinder\"\n[parameters]\nresolution = 5\n",
        &["resolution = 5", "between 10 and"],
    );
    says("scene = \"cylinder\"\n[parameters]\nresolution = [5]\n", &["line 3", "resolution"]);
    says("scene = \"nothing\"\n", &["nothing", "cylinder"]);
    says("scene = ", &["line 1"]);
    says("", &["scene"]);
}

#[test]
fn a_time_step_past_stability_is_an_error_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    // With the scene's own scheme this survives; plain terms do not.
    let plain = [
        "reynolds=0.1",
        "courant=10",
        "pressure=state-equation",
        "density=continuity",
        "pressure_form=symmetric",
        "viscous_form=morris",
        "transport=0",
        "kernel=gaussian",
        "smoothing_ratio=1",
    ];
    let settings = plain.iter().flat_map(|setting| ["--set", setting]);
    let arguments: Vec<_> = settings.chain(["--steps", "200"]).collect();
    let said = complaint(&small(&arguments), folder.path());
    for word in ["sph: step", "time step control", "sound speed", "past stability"] {
        assert!(said.contains(word), "{word:?} in {said}");
    }
}

#[test]
fn a_checkpoint_of_another_scene_or_a_damaged_one_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    finegrain(&small(&["--steps", "4", "--out", "a", "--checkpoint-every", "4"]), folder.path());
    let checkpoint = std::fs::read_dir(folder.path().join("a"))
        .unwrap()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .find(|path| path.extension().is_some_and(|e| e == "ckpt"))
        .unwrap();
    let path = checkpoint.to_str().unwrap();
    let other = ["run", "taylor-green", "--set", "resolution=18", "--restart", path];
    let said = complaint(&other, folder.path());
    assert!(said.contains("resolution = 16 in the checkpoint, resolution = 18 here"), "{said}");
    let said = complaint(&small(&["--restart", path, "--steps", "3"]), folder.path());
    assert!(said.contains("step 4, past step 3"), "{said}");
    assert!(!said.contains("last good checkpoint"), "{said}");
    let said = complaint(&small(&["--restart", "nowhere.ckpt"]), folder.path());
    assert!(said.contains("nowhere.ckpt") && said.contains("No such file"), "{said}");
    let mut bytes = std::fs::read(&checkpoint).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&checkpoint, bytes).unwrap();
    assert!(complaint(&small(&["--restart", path]), folder.path()).contains(path));
}
