//! Hard cases for lattice Boltzmann: collisions, each on meshes too coarse for its Reynolds number.

use super::{HardCase, Sign, Variant, variant};

/// Layers of shear, cavities, vortices in space, a cylinder in a channel.
pub const CASES: [HardCase; 17] = [
    layers("layers, Re 1e4, 64", &[("reynolds", "1e4"), ("resolution", "64"), THIN]),
    layers("layers, Re 1e4, 128", &[("reynolds", "1e4"), ("resolution", "128"), THIN]),
    layers("layers, Re 1e4, 256", &[("reynolds", "1e4"), ("resolution", "256"), THIN]),
    layers("layers, Re 1e5, 64", &[("reynolds", "1e5"), ("resolution", "64"), THIN]),
    layers("layers, Re 1e5, 128", &[("reynolds", "1e5"), ("resolution", "128"), THIN]),
    layers("layers, Re 1e5, 256", &[("reynolds", "1e5"), ("resolution", "256"), THIN]),
    layers("layers, Re 1e6, 64", &[("reynolds", "1e6"), ("resolution", "64"), THIN]),
    layers("layers, Re 1e6, 128", &[("reynolds", "1e6"), ("resolution", "128"), THIN]),
    layers("layers, Re 1e6, 256", &[("reynolds", "1e6"), ("resolution", "256"), THIN]),
    cavity("cavity, Re 1000, 32", &[("reynolds", "1000"), ("resolution", "32")]),
    cavity("cavity, Re 1000, 64", &[("reynolds", "1000"), ("resolution", "64")]),
    cavity("cavity, Re 10000, 64", &[("reynolds", "10000"), ("resolution", "64")]),
    cavity("cavity, Re 10000, 128", &[("reynolds", "10000"), ("resolution", "128")]),
    vortices("vortices 3-D, 32", &[("resolution", "32"), RE_1600, SPACE, FAST]),
    vortices("vortices 3-D, 64", &[("resolution", "64"), RE_1600, SPACE, FAST]),
    // To the time in which the flow goes through the channel, and more.
    cylinder("cylinder, Re 100, 41", 4.0, &[("reynolds", "100"), ("resolution", "41"), FAST]),
    cylinder("cylinder, Re 1000, 41", 0.4, &[("reynolds", "1000"), ("resolution", "41"), FAST]),
];

type Settings = &'static [(&'static str, &'static str)];

const THIN: (&str, &str) = ("kappa", "80");
const FAST: (&str, &str) = ("mach", "0.1");
const SPACE: (&str, &str) = ("dim", "3");
/// In a box 2 pi long the Reynolds number of the references is 1600.
const RE_1600: (&str, &str) = ("reynolds", "10053.1");

const COLLISIONS: &[Variant] = &[
    variant("bgk", &[("collision", "bgk")]),
    variant("trt 3/16", &[("collision", "trt")]),
    variant("trt 1/4", &[("collision", "trt"), ("magic", "0.25")]),
    variant("mrt 3/16", &[("collision", "mrt")]),
    variant("regularised", &[("collision", "regularised")]),
    variant("central (default)", &[("collision", "central-moments")]),
    variant("cumulant", &[("collision", "cumulant")]),
];

const fn case(
    name: &'static str,
    scene: &'static str,
    settings: Settings,
    until: f64,
    signs: &'static [Sign],
) -> HardCase {
    let (method, variants) = ("lbm", COLLISIONS);
    HardCase { name, method, time_step: None, scene, settings, until, variants, signs }
}

const fn layers(name: &'static str, settings: Settings) -> HardCase {
    const VORTICES: Sign =
        Sign { result: "vortices", least: 2.0, most: 2.0, symptom: "spurious vortices" };
    case(name, "double-shear-layer", settings, 1.0, &[VORTICES, SPEED, SOUND])
}

const fn cavity(name: &'static str, settings: Settings) -> HardCase {
    case(name, "cavity", settings, 20.0, &[SPEED, SOUND])
}

const fn vortices(name: &'static str, settings: Settings) -> HardCase {
    // The peak of the dissipation is at 9 / (2 pi).
    case(name, "taylor-green", settings, 1.6, &[SPEED, SOUND])
}

const fn cylinder(name: &'static str, until: f64, settings: Settings) -> HardCase {
    case(name, "channel-cylinder", settings, until, &[SPEED, SOUND])
}

/// All run at a Mach number of 0.1 of the speed of layers, lid and vortices; this is that of the end.
const SPEED: Sign = Sign { result: "mach_reached", least: 0.0, most: 0.18, symptom: "too fast" };

/// At any time. Flow that overtakes its own sound is none that these lattices can have: their equilibrium is an
/// expansion for small Mach numbers (Qian, d'Humieres & Lallemand 1992, Europhys. Lett. 17).
const SOUND: Sign = Sign {
    result: "largest_mach",
    least: 0.0,
    most: 1.0f64.next_down(),
    symptom: "faster than sound",
};
