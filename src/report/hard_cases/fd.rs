//! Hard cases for finite differences: the longest stable time steps, steps, shocks, near vacuum, stiff diffusion, and
//! flow on meshes too coarse for its Reynolds number.

use super::{HardCase, Sign, Variant, variant};

/// Waves, steps, heat, gas, layers of shear, cavities.
pub const CASES: &[HardCase] = &[
    advection("step, upwind1, longest time step", EXPLICIT, &[("face", "upwind1"), STEP, LONGEST]),
    advection("step, upwind3, longest time step", NOT_EULER, &[("face", "upwind3"), STEP, LONGEST]),
    advection("step, weno5, longest time step", NOT_EULER, &[("face", "weno5"), STEP, LONGEST]),
    advection("step, weno5-z, longest time step", NOT_EULER, &[("face", "weno5-z"), STEP, LONGEST]),
    heat("heat, order 2, longest time step", &[("order", "2"), COLD, SUDDENLY, LONGEST]),
    heat("heat, order 4, longest time step", &[("order", "4"), COLD, SUDDENLY, LONGEST]),
    heat("heat, order 6, longest time step", &[("order", "6"), COLD, SUDDENLY, LONGEST]),
    HardCase {
        name: "waves, longest time step",
        variants: WAVE_ORDERS,
        signs: &[Sign { result: "energy_drift", least: 0.0, most: 1e-6, symptom: "energy drift" }],
        until: 20.0,
        ..case("wave", &[("dim", "1"), LONGEST])
    },
    HardCase {
        name: "a step, carried once around",
        variants: FACES,
        signs: &[Sign { result: "overshoot", least: 0.0, most: 0.01, symptom: "overshoots" }],
        ..case("advection", &[STEP, ("resolution", "128")])
    },
    #[cfg(feature = "implicit")]
    HardCase {
        name: "heat, 1000 times the explicit limit",
        variants: IMPLICIT,
        signs: &[Sign { result: "overshoot", least: 0.0, most: 0.01, symptom: "rings" }],
        ..case(
            "heat",
            &[
                ("dim", "1"),
                ("resolution", "1001"),
                ("order", "2"),
                COLD,
                SUDDENLY,
                ("courant", "1000"),
            ],
        )
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
    cavity("cavity, Re 5000, 128", &[("reynolds", "5000"), ("resolution", "128")]),
    cavity("cavity, Re 10000, 64", &[("reynolds", "10000"), ("resolution", "64")]),
    cavity("cavity, Re 10000, 128", &[("reynolds", "10000"), ("resolution", "128")]),
];

type Settings = &'static [(&'static str, &'static str)];

/// Past it the scenes refuse to begin.
const LONGEST: (&str, &str) = ("courant", "1");

const STEP: (&str, &str) = ("shape", "step");
const COLD: (&str, &str) = ("ends", "cold");
const SUDDENLY: (&str, &str) = ("start", "step");

const EXPLICIT: &[Variant] = &[
    variant("rk4", &[("integrator", "rk4")]),
    variant("ssp-rk3", &[("integrator", "ssp-rk3")]),
    variant("rk2", &[("integrator", "rk2")]),
    variant("euler", &[("integrator", "euler")]),
];

/// Of advection by more than the nearest points Euler's method amplifies some wave with every time step.
const NOT_EULER: &[Variant] = EXPLICIT.split_at(3).0;

const WAVE_ORDERS: &[Variant] = &[
    variant("order 4 (default)", &[("order", "4")]),
    variant("order 2", &[("order", "2")]),
    variant("order 6", &[("order", "6")]),
    variant("order 8", &[("order", "8")]),
];

#[cfg(feature = "implicit")]
const IMPLICIT: &[Variant] = &[
    variant("backward-euler", &[("integrator", "backward-euler")]),
    variant("crank-nicolson", &[("integrator", "crank-nicolson")]),
    variant("bdf2", &[("integrator", "bdf2")]),
];

const FACES: &[Variant] = &[
    variant("weno5-z (default)", &[("face", "weno5-z")]),
    variant("weno5", &[("face", "weno5")]),
    variant("upwind3", &[("face", "upwind3")]),
    variant("upwind1", &[("face", "upwind1")]),
];

const DEFAULT: &[Variant] = &[variant("default", &[])];

const ORDERS: &[Variant] =
    &[variant("order 4 (default)", &[("order", "4")]), variant("order 2", &[("order", "2")])];

const ORDERS_BETWEEN_WALLS: &[Variant] =
    &[variant("order 2 (default)", &[("order", "2")]), variant("order 4", &[("order", "4")])];

/// Resolved flow has some thousandths at most, what changes its sign from point to point 1.
const RIPPLES: Sign = Sign { result: "ripples", least: 0.0, most: 0.01, symptom: "ripples" };

const fn case(scene: &'static str, settings: Settings) -> HardCase {
    let (name, method, variants) = (scene, "fd", DEFAULT);
    HardCase { name, method, time_step: None, scene, settings, until: 1.0, variants, signs: &[] }
}

const fn advection(
    name: &'static str,
    variants: &'static [Variant],
    settings: Settings,
) -> HardCase {
    // Around twenty times.
    HardCase { name, variants, until: 20.0, signs: BOUNDED, ..case("advection", settings) }
}

const fn heat(name: &'static str, settings: Settings) -> HardCase {
    HardCase { name, variants: EXPLICIT, signs: BOUNDED, ..case("heat", settings) }
}

/// Of what cannot leave the range from 0 to 1: what overshoots does not grow.
const BOUNDED: &[Sign] = &[Sign { result: "overshoot", least: 0.0, most: 0.5, symptom: "grows" }];

const fn toro(name: &'static str, until: f64, settings: Settings) -> HardCase {
    const POSITIVE: &[Sign] = &[
        Sign { result: "least_density", least: 0.0, most: f64::MAX, symptom: "negative density" },
        Sign { result: "least_pressure", least: 0.0, most: f64::MAX, symptom: "negative pressure" },
    ];
    // The scene itself refuses time steps with which they are not sure to be.
    HardCase { name, until, signs: POSITIVE, ..case("toro", settings) }
}

const fn layers(name: &'static str, settings: Settings) -> HardCase {
    const VORTICES: Sign =
        Sign { result: "vortices", least: 2.0, most: 2.0, symptom: "spurious vortices" };
    let (variants, signs) = (ORDERS, &[VORTICES, RIPPLES]);
    HardCase { name, variants, signs, ..case("double-shear-layer", settings) }
}

const fn cavity(name: &'static str, settings: Settings) -> HardCase {
    // That of steady flow is between -0.21 (Re 100) and -0.45 (Re 10,000).
    const BACKFLOW: Sign =
        Sign { result: "u_min", least: -0.6, most: -0.1, symptom: "too fast or none below" };
    // Nothing but the lid drives the flow, and pressure hardly makes it faster than that, 1 m/s.
    const SPEED: Sign =
        Sign { result: "largest_speed", least: 0.0, most: 1.1, symptom: "faster than the lid" };
    let (variants, signs) = (ORDERS_BETWEEN_WALLS, &[BACKFLOW, SPEED, RIPPLES]);
    // Several times what the core of steady flow takes to turn once.
    HardCase { name, until: 60.0, variants, signs, ..case("cavity", settings) }
}
