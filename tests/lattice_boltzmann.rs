//! The scenes by lattice Boltzmann: the errors that they report against their references, and how
//! they fall.

mod runs;

use std::collections::BTreeMap;

use finegrain::scene::{Orders, Precision, Report, Scene};

fn run(scene: &str, settings: &[(&str, &str)], orders: Orders) -> Report {
    runs::run("lbm", scene, settings, orders)
}

fn errors(scene: &str, settings: &[(&str, &str)]) -> BTreeMap<&'static str, f64> {
    runs::errors("lbm", scene, settings)
}

#[test]
fn flow_between_plates_starts_as_the_series_says_in_second_order() {
    for scene in ["couette", "poiseuille"] {
        let [coarse, fine] =
            ["16", "32"].map(|n| errors(scene, &[("resolution", n)])["velocity_l2"]);
        let order = (coarse / fine).log2();
        assert!(fine < 1e-3 && order > 1.9, "{scene}: {coarse} {fine}");
    }
}

/// Diffusive scaling: the Mach number falls with the spacing. Rates of decay are differences of errors
/// of both signs, and not there yet.
#[test]
fn vortices_decay_in_second_order() {
    let at = |n, mach| errors("taylor-green", &[("resolution", n), ("mach", mach)]);
    let (coarse, fine) = (at("32", "0.05"), at("64", "0.025"));
    let order = (coarse["velocity_l2"] / fine["velocity_l2"]).log2();
    assert!((order - 2.0).abs() < 0.1, "{coarse:?} {fine:?}");
    assert!(fine["velocity_l2"] < 2e-4 && fine["decay_rate"].abs() < 2e-4, "{fine:?}");
}

/// With interpolated walls. The force on the cylinder balances the one on the fluid.
#[test]
fn the_drag_of_a_cylinder_converges() {
    let at = |n| {
        let settings = [("resolution", n), ("relaxation_time", "1")];
        let report = run("cylinder", &settings, Orders::default());
        assert!(report.results["momentum_balance"].abs() < 1e-6, "{:?}", report.results);
        assert!(report.results["cross_flow"] < 1e-9, "{:?}", report.results);
        report.errors["drag_k"].abs()
    };
    let [coarse, fine] = ["20", "100"].map(at);
    assert!(fine < 0.003, "{fine}");
    assert!((coarse / fine).ln() / 5.0f64.ln() > 1.7, "{coarse} {fine}");
}

#[test]
fn the_cavity_has_the_right_extrema() {
    let report = run("cavity", &[("resolution", "128"), ("mach", "0.15")], Orders::default());
    for (name, error) in &report.errors {
        assert!(error.abs() < 0.005, "{name}: {error}");
    }
    assert_eq!(report.errors.len(), 3);
}

/// Against velocities by finite elements on Morris's lines.
#[test]
fn the_flow_around_a_cylinder_has_the_right_profile() {
    let settings = [("resolution", "50"), ("relaxation_time", "1")];
    let errors = errors("cylinder", &settings);
    assert!(errors["profiles_l2"] < 0.005, "{errors:?}");
}

#[test]
fn the_drag_of_spheres_converges() {
    let [coarse, fine] = ["12", "24"].map(|n| {
        let errors = errors("sphere-array", &[("resolution", n), ("relaxation_time", "1")]);
        assert!(errors["momentum_balance"].abs() < 1e-5, "{errors:?}");
        errors["drag_k"].abs()
    });
    assert!(fine < 0.02 && coarse / fine > 3.0, "{coarse} {fine}");
}

#[test]
fn flow_to_and_fro_is_right_in_second_order() {
    let [coarse, fine] =
        ["32", "64"].map(|n| errors("womersley", &[("resolution", n)])["velocity_l2"]);
    let order = (coarse / fine).log2();
    assert!(fine < 1e-4 && (order - 2.0).abs() < 0.1, "{coarse} {fine}");
}

/// With an interpolated wall, which leaves the order as it happens to cut the sites.
#[test]
fn flow_to_and_fro_in_a_pipe_converges() {
    let at = |n| errors("womersley", &[("section", "pipe"), ("resolution", n)])["velocity_l2"];
    let [coarse, fine] = [at("16"), at("32")];
    assert!(fine < 0.002 && coarse / fine > 3.0, "{coarse} {fine}");
}

#[test]
fn layers_of_shear_roll_up() {
    let report = run("double-shear-layer", &[("resolution", "128")], Orders::default());
    assert!(report.errors["kinetic_energy"].abs() < 0.0025, "{:?}", report.errors);
    assert!(report.errors["enstrophy"].abs() < 0.02, "{:?}", report.errors);
    assert_eq!(report.results["vortices"], 2.0);
}

/// Thin layers on a coarse mesh, at a viscosity that is hardly more than none, by the default collision.
#[test]
fn thin_layers_survive() {
    let settings = [("resolution", "64"), ("kappa", "80"), ("reynolds", "1e5")];
    let report = run("double-shear-layer", &settings, Orders::default());
    assert_eq!(report.results["vortices"], 2.0);
    assert!(report.results["kinetic_energy"] < 0.48, "{:?}", report.results);
}

#[test]
fn vortices_in_space_lose_the_right_energy() {
    let settings = [
        ("dim", "3"),
        ("resolution", "32"),
        ("reynolds", "628.3185307"),
        ("mach", "0.1"),
        ("collision", "cumulant"),
    ];
    let errors = errors("taylor-green", &settings);
    assert!(errors["peak_dissipation"].abs() < 0.02, "{errors:?}");
    assert!(errors["peak_time"].abs() < 0.01, "{errors:?}");
}

/// A coarse mesh, on which the cylinder is ten spacings thick; the lift is a part in 500 of the drag.
#[test]
fn flow_past_a_cylinder_between_walls() {
    let settings = [("resolution", "41"), ("mach", "0.1")];
    let report = run("channel-cylinder", &settings, Orders::default());
    assert!(report.errors["drag"].abs() < 0.006, "{:?}", report.errors);
    assert!(report.errors["lift"].abs() < 0.15, "{:?}", report.errors);
    assert!(report.errors["pressure_difference"].abs() < 0.04, "{:?}", report.errors);
}

#[test]
fn a_checkpoint_is_gone_on_from_with_the_same_bits() {
    let settings = [("resolution", "20")];
    let whole = runs::assert_goes_on_with_the_same_bits("lbm", "cylinder", &settings);
    assert_eq!(whole.results["relaxation_time"], 0.8);
    let mach = whole.results["mach_reached"];
    assert!(mach > 0.0 && mach < 0.01, "{mach}");
}

#[test]
fn what_the_method_cannot_do_is_refused_with_the_range() {
    let refused = |scene: &str, settings: &[(&str, &str)]| {
        let scene = Scene::find(scene).unwrap();
        let parameters = scene.set_for(Some("lbm"), settings.iter().copied()).unwrap();
        match scene.prepare(Some("lbm"), &parameters, Precision::F64) {
            Ok(_) => panic!("must be refused"),
            Err(error) => error.to_string(),
        }
    };
    let cylinder = Scene::find("cylinder").unwrap();
    let said = cylinder.set_for(Some("lbm"), [("relaxation_time", "0.5")]).unwrap_err().to_string();
    assert!(said.contains("relaxation_time = 0.5") && said.contains("0.5001 and 100"), "{said}");
    let said = refused("taylor-green", &[("reynolds", "0.01"), ("resolution", "400")]);
    assert!(said.contains("relaxation time"), "{said}");
    let said = refused("shear-wave", &[("relaxation_time", "50"), ("resolution", "8")]);
    assert!(said.contains("Mach number"), "{said}");
    let scene = Scene::find("cavity").unwrap();
    let of_sph = scene.set([]).unwrap();
    let said = scene.prepare(Some("lbm"), &of_sph, Precision::F64).err().unwrap().to_string();
    assert!(
        said.contains("scene \"cavity\", --method lbm: these are not its parameters"),
        "{said}"
    );
}
