//! Shock tube and implosion, coarse: errors are what they should be, and fall.

use finegrain::scene::{Orders, Precision, Report, Scene};

fn report(name: &str, settings: &[(&str, &str)], precision: Precision) -> Report {
    let scene = Scene::find(name).unwrap();
    let parameters = scene.set(settings.iter().copied()).unwrap();
    let prepared = scene.prepare(Some("sph"), &parameters, precision).unwrap();
    prepared.run(Orders::default()).unwrap()
}

#[test]
fn shock_tube_converges() {
    let tube = |resolution| report("sod", &[("resolution", resolution)], Precision::F64);
    let (coarse, fine) = (tube("100"), tube("400"));
    let (e1, e4) = (coarse.errors["density_l1"], fine.errors["density_l1"]);
    // First order, since a shock is as wide as the smoothing length.
    assert!(e4 < 0.012 && (e1 / e4).log2() / 2.0 > 0.7, "{e1} {e4}");
    for report in [coarse, fine] {
        assert!(report.errors["energy_drift"] < 1e-4, "{:?}", report.errors);
    }
}

#[test]
fn shock_tube_in_2d_and_single_precision() {
    let tube = report("sod", &[("dim", "2"), ("resolution", "110")], Precision::F32);
    let errors = &tube.errors;
    assert!(errors["density_l1"] < 0.03 && errors["energy_drift"] < 1e-4, "{errors:?}");
}

#[test]
fn implosion_in_1d() {
    let noh = report("noh", &[("resolution", "100")], Precision::F64);
    let errors = &noh.errors;
    assert!(errors["shocked_density"].abs() < 0.01, "{errors:?}");
    assert!(errors["energy_drift"] < 1e-4, "{errors:?}");
}

/// Where gas converges artificial viscosity heats it before the shock gets there: its density then
/// falls short, the less the shorter the smoothing length.
#[test]
fn implosion_in_2d_converges() {
    let noh = |resolution| {
        let settings = [("dim", "2"), ("resolution", resolution)];
        let errors = report("noh", &settings, Precision::F64).errors;
        assert!(errors["energy_drift"] < 1e-4, "{errors:?}");
        errors["shocked_density"].abs()
    };
    let (coarse, fine) = (noh("20"), noh("30"));
    assert!(fine < 0.15 && (coarse / fine).log2() / 1.5f64.log2() > 1.0, "{coarse} {fine}");
}
