//! Creeping flow past a cylinder, against the drag of Sangani & Acrivos (1982).

use finegrain::scene::{Orders, Precision, Scene};

/// Relative error of `drag_k` at a resolution.
fn error(resolution: &str) -> f64 {
    let scene = Scene::find("cylinder").unwrap();
    let parameters = scene.set([("resolution", resolution)]).unwrap();
    let prepared = scene.prepare(None, &parameters, Precision::F64).unwrap();
    prepared.run(Orders::default()).unwrap().errors["drag_k"]
}

#[test]
fn drag_is_within_five_percent_at_50_points_and_its_error_falls_with_resolution() {
    let errors = ["16", "32", "50"].map(|resolution| error(resolution).abs());
    assert!(errors[2] < 0.05, "errors {errors:?}");
    assert!(errors[0] > errors[1] && errors[1] > errors[2], "errors {errors:?}");
}
