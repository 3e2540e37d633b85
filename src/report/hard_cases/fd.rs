//! Hard cases for finite differences: steps, shocks, near vacuum, and flow on meshes too coarse for its Reynolds
//! number.

use super::{HardCase, Sign, Variant, variant};

/// Advection, gas, layers of shear, cavities.
pub const CASES: [HardCase; 16] = [
    HardCase {
        name: "a step, carried once around",
        variants: FACES,
        signs: &[Sign { result: "overshoot", least: 0.0, most: 0.01, symptom: "overshoots" }],
        ..case("advection", &[("shape", "step"), ("resolution", "128")])
    },
    toro("toro 1, sonic rarefaction", 0.25, &[("test", "1")]),
    toro("toro 2, near vacuum", 0.15, &[("test", "2")]),
    toro("toro 3, blast", 0.012, &[("test", "3")]),
    toro("toro 4, blast from the right", 0.035, &[("test", "4")]),
    toro("toro 5, two shocks", 0.035, &[("test", "5")]),
    layers("layers, kappa 30, 64", &[("kappa", "30"), ("resolution", "64")]),
    layers("layers, kappa 30, 128", &[("kappa", "30"), ("resolution", "128")]),
    layers("layers, kappa 80, 64", &[("kappa", "80"), ("resolution", "64")]),
    layers("layers, kappa 80, 128", &[("kappa", "80"), ("resolution", "128")]),
    layers("layers, kappa 80, 256", &[("kappa", "80"), ("resolution", "256")]),
    cavity("cavity, Re 1000, 32", &[("reynolds", "1000"), ("resolution", "32")]),
    cavity("cavity, Re 1000, 64", &[("reynolds", "1000"), ("resolution", "64")]),
    cavity("cavity, Re 5000, 64", &[("reynolds", "5000"), ("resolution", "64")]),
    cavity("cavity, Re 10000, 64", &[("reynolds", "10000"), ("resolution", "64")]),
    cavity("cavity, Re 10000, 128", &[("reynolds", "10000"), ("resolution", "128")]),
];

type Settings = &'static [(&'static str, &'static str)];

const FACES: &[Variant] = &[
    variant("weno5-z (default)", &[("face", "weno5-z")]),
    variant("weno5", &[("face", "weno5")]),
    variant("upwind3", &[("face", "upwind3")]),
    variant("upwind1", &[("face", "upwind1")]),
];

const DEFAULT: &[Variant] = &[variant("default", &[])];

const ORDERS: &[Variant] =
    &[variant("order 4 (default)", &[("order", "4")]), variant("order 2", &[("order", "2")])];

const fn case(scene: &'static str, settings: Settings) -> HardCase {
    let (name, method, variants) = (scene, "fd", DEFAULT);
    HardCase { name, method, time_step: None, scene, settings, until: 1.0, variants, signs: &[] }
}

const fn toro(name: &'static str, until: f64, settings: Settings) -> HardCase {
    const POSITIVE: &[Sign] = &[
        Sign { result: "least_density", least: 0.0, most: f64::MAX, symptom: "negative density" },
        Sign { result: "least_pressure", least: 0.0, most: f64::MAX, symptom: "negative pressure" },
    ];
    // The scene itself refuses time steps with which they are not sure to be.
    HardCase { name, until, signs: POSITIVE, ..case("toro", settings) }
}

const fn layers(name: &'static str, settings: Settings) -> HardCase {
    const VORTICES: &[Sign] =
        &[Sign { result: "vortices", least: 2.0, most: 2.0, symptom: "spurious vortices" }];
    let (variants, signs) = (ORDERS, VORTICES);
    HardCase { name, variants, signs, ..case("double-shear-layer", settings) }
}

const fn cavity(name: &'static str, settings: Settings) -> HardCase {
    // That of steady flow is between -0.21 (Re 100) and -0.45 (Re 10,000).
    const BACKFLOW: &[Sign] =
        &[Sign { result: "u_min", least: -0.6, most: -0.1, symptom: "too fast or none below" }];
    HardCase { name, until: 20.0, signs: BACKFLOW, ..case("cavity", settings) }
}
