//! Flow past a cylinder, against the drag of Sangani & Acrivos (1982) and velocities by finite
//! elements.

mod runs;

use std::collections::BTreeMap;

use finegrain::scene::{Orders, Precision, Scene};

/// Errors of the scene with these settings.
fn errors(settings: &[(&str, &str)]) -> BTreeMap<&'static str, f64> {
    let scene = Scene::find("cylinder").unwrap();
    let parameters = scene.set(settings.iter().copied()).unwrap();
    let prepared = scene.prepare(None, &parameters, Precision::F64).unwrap();
    prepared.run(Orders::default()).unwrap().errors
}

#[test]
fn creeping_flow_converges() {
    let [coarse, middle, fine] =
        ["20", "32", "50"].map(|resolution| errors(&[("resolution", resolution)]));
    let drag = [&coarse, &middle, &fine].map(|errors| errors["drag_k"].abs());
    assert!(drag[2] < 0.02, "errors {drag:?}");
    let order = (drag[0] / drag[2]).ln() / 2.5f64.ln();
    assert!(order > 1.3 && drag[1] < drag[0], "order {order} of errors {drag:?}");
    assert!(fine["profiles_l2"] < 0.02 && fine["profiles_l2"] < middle["profiles_l2"]);
    // What drives the fluid ends on the cylinder.
    assert!(fine["momentum_balance"].abs() < 5e-3, "{fine:?}");
}

#[test]
fn flow_with_inertia() {
    let settings = [("resolution", "32"), ("viscosity", "1e-6"), ("body_acceleration", "1.5e-7")];
    let errors = errors(&settings);
    assert!(errors["drag_k"].abs() < 0.02, "{errors:?}");
    assert!(errors["momentum_balance"].abs() < 0.01, "{errors:?}");
}

/// By every method, 24 points across, of which the radius is 1.4 to 8.6: the thinner the cylinder, the coarser.
#[test]
fn drag_of_thin_and_thick_cylinders() {
    let fractions = ["0.01", "0.1", "0.2", "0.4"];
    for (method, most) in [
        ("lbm", [0.15, 0.05, 0.02, 0.02]),
        ("fd", [0.04, 0.02, 0.02, 0.02]),
        ("sph", [0.25, 0.08, 0.06, 0.08]),
    ] {
        for (fraction, most) in fractions.into_iter().zip(most) {
            let settings = [("resolution", "24"), ("solid_fraction", fraction)];
            let error = runs::errors(method, "cylinder", &settings)["drag_k"];
            assert!(error.abs() < most, "{method}, {fraction}: {error}");
        }
    }
}

/// Too thin for particles, however wide the range of the parameter is.
#[test]
fn a_cylinder_that_particles_would_see_through() {
    let scene = Scene::find("cylinder").unwrap();
    for fraction in ["0.001", "0.01"] {
        let parameters = scene.set([("resolution", "10"), ("solid_fraction", fraction)]).unwrap();
        let Err(error) = scene.prepare(None, &parameters, Precision::F64) else {
            panic!("{fraction} is too thin")
        };
        let said = error.to_string();
        for word in ["solid_fraction", fraction, "larger", "resolution"] {
            assert!(said.contains(word), "{word} in {said}");
        }
    }
}
