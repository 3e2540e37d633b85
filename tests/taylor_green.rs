//! Taylor-Green vortices where viscosity decides: the decay rate is that of the exact solution.

use finegrain::scene::{Orders, Precision, Scene};

#[test]
fn creeping_vortices_decay_as_they_should() {
    let scene = Scene::find("taylor-green").unwrap();
    let settings = [("resolution", "32"), ("reynolds", "1")];
    let parameters = scene.set(settings).unwrap();
    let prepared = scene.prepare(Some("sph"), &parameters, Precision::F64).unwrap();
    let report = prepared.run(Orders { until: Some(0.02), ..Orders::default() }).unwrap();
    assert_eq!(report.time, 0.02);
    // eta^2 = 0.01 h^2 in the viscous term makes it some percent too weak, at any resolution.
    let error = report.errors["decay_rate"];
    assert!(error.abs() < 0.05, "error {error}");
}
