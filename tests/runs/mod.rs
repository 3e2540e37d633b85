//! Runs of scenes in `f64`, and what every method must hold to.
#![allow(dead_code, reason = "every test binary uses its own share of these")]

use std::collections::BTreeMap;
use std::path::PathBuf;

use finegrain::scene::{Orders, Precision, Report, Scene};

/// What a scene comes to by a method.
pub fn run(method: &str, scene: &str, settings: &[(&str, &str)], orders: Orders) -> Report {
    let scene = Scene::find(scene).unwrap();
    let parameters = scene.set_for(Some(method), settings.iter().copied()).unwrap();
    scene.prepare(Some(method), &parameters, Precision::F64).unwrap().run(orders).unwrap()
}

/// Its errors, run to its own end.
pub fn errors(method: &str, scene: &str, settings: &[(&str, &str)]) -> BTreeMap<&'static str, f64> {
    run(method, scene, settings, Orders::default()).errors
}

/// A run that is taken up again from a checkpoint, with other numbers of workers, ends with the bits of
/// the uninterrupted one, which is returned.
pub fn assert_goes_on_with_the_same_bits(
    method: &str,
    scene: &str,
    settings: &[(&str, &str)],
) -> Report {
    let folder = tempfile::tempdir().unwrap();
    let until = |steps, restart, workers| Orders {
        steps: Some(steps),
        workers: Some(workers),
        out: Some(folder.path().join(steps.to_string())),
        restart,
        ..Orders::default()
    };
    let whole = run(method, scene, settings, until(31, None, 1));
    let half = run(method, scene, settings, until(14, None, 2));
    let file = |extension| {
        let has_it = |f: &&PathBuf| f.extension().is_some_and(|e| e == extension);
        half.files.iter().find(has_it).cloned().expect("a file of this kind")
    };
    assert!(file("vti").exists() && file("csv").exists());
    let again = run(method, scene, settings, until(31, Some(file("ckpt")), 3));
    assert_eq!(again.state_hash, whole.state_hash);
    assert_eq!(again.results, whole.results);
    whole
}
