//! What a scene does not ask for costs no memory: the columns of models with and without it.

mod gas_box;

use std::collections::BTreeSet;

use finegrain_framework::shape::Shape;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Columns, Real};
use finegrain_sph::{
    Fluid, Gradient, Packing, Physics, Scheme, ShockCapturing, Sph, Start, StateEquation,
    Viscosity, WallVelocity,
};

/// Bytes a particle in all columns, and their names.
fn cost(columns: &Columns) -> (usize, BTreeSet<String>) {
    let bytes = columns.iter().map(|(_, column)| column.kind().size()).sum();
    (bytes, columns.iter().map(|(_, column)| column.name().to_owned()).collect())
}

/// Of a periodic box in 2-D.
fn cost_of<T: Real>(physics: &Physics, scheme: &Scheme) -> (usize, BTreeSet<String>) {
    let lattice = Packing::Square.fit([1.0; 3], 0.1).unwrap();
    let start = Start {
        region: Region { lower: vec![0.0; 2], upper: vec![1.0; 2], periodic: vec![true; 2] },
        spacing: 0.1,
        particle_volume: lattice.volume_per_particle(),
        positions: lattice.positions().collect(),
        velocities: Vec::new(),
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 10.0,
        kinematic_viscosity: 0.1,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let sph = Sph::<T>::new(&start, &fluid, physics, scheme).unwrap();
    cost(&sph.model.columns)
}

/// Checks that `physics` adds the columns `names`, to what there is without.
fn adds(physics: &Physics, names: &[&str]) {
    adds_with(physics, &Scheme::default(), names);
}

/// Checks that `physics` and `scheme` add the columns `names`, to what there is without.
fn adds_with(physics: &Physics, scheme: &Scheme, names: &[&str]) {
    let (plain, known) = cost_of::<f64>(&Physics::default(), &Scheme::default());
    let (bytes, all) = cost_of::<f64>(physics, scheme);
    let new: Vec<_> = all.difference(&known).map(String::as_str).collect();
    assert_eq!(new, names);
    assert_eq!(bytes - plain, 8 * names.len());
    let (bytes, all) = (cost_of::<f32>(physics, scheme).0, 4 * all.len());
    assert_eq!(bytes, all, "single precision is half of it but for the identity");
}

#[test]
fn nothing_more_than_mass_and_momentum_by_default() {
    let (bytes, names) = cost_of::<f64>(&Physics::default(), &Scheme::default());
    let nothing = [
        "energy",
        "stress",
        "wall",
        "sound_speed",
        "smoothing_length",
        "grad_h",
        "signal",
        "moment",
        "correction",
    ];
    for name in nothing {
        assert!(!names.iter().any(|column| column.contains(name)), "{name}");
    }
    // Position, velocity, density, two of the state equation, rates and last rates, and where it was
    // sorted; 4 bytes are its identity.
    assert!(bytes <= 15 * 8 + 4, "{bytes} bytes in {names:?}");
}

#[test]
fn energy() {
    let physics = Physics { energy: true, ..Physics::default() };
    adds(&physics, &["energy", "energy_rate", "last_energy_rate"]);
}

#[test]
fn viscosity() {
    let of = |form| Physics { viscosity: Some(form), ..Physics::default() };
    adds(&of(Viscosity::Morris), &[]);
    adds(&of(Viscosity::Monaghan), &[]);
    adds(&of(Viscosity::StrainRate), &["stress_term_0", "stress_term_1", "stress_term_2"]);
}

#[test]
fn corrected_gradient() {
    let scheme = Scheme { gradient: Gradient::Corrected, ..Scheme::default() };
    let columns =
        ["correction_0", "correction_1", "correction_2", "moment_0", "moment_1", "moment_2"];
    adds_with(&Physics::default(), &scheme, &columns);
}

#[test]
fn bodies() {
    let body = Shape::Sphere { centre: [0.5, 0.5, 0.0], radius: 0.2 };
    adds(&Physics { bodies: vec![body.into()], ..Physics::default() }, &["wall_depth"]);
}

#[test]
fn friction_in_bodies_and_forces_on_them() {
    let body = Shape::Sphere { centre: [0.5, 0.5, 0.0], radius: 0.2 };
    let physics = Physics {
        viscosity: Some(Viscosity::Morris),
        bodies: vec![body.into()],
        ..Physics::default()
    };
    let names = |wall_velocity, forces_on_bodies| {
        let physics = Physics { forces_on_bodies, ..physics.clone() };
        cost_of::<f64>(&physics, &Scheme { wall_velocity, ..Scheme::default() }).1
    };
    let owned = |names: &[&str]| names.iter().map(|&n| n.to_owned()).collect::<BTreeSet<String>>();
    let linear = names(WallVelocity::Linear, false);
    let mirrored = names(WallVelocity::Mirrored, false);
    assert_eq!(&mirrored - &linear, owned(&["mirrored_velocity_x", "mirrored_velocity_y"]));
    let fitted = names(WallVelocity::Fitted, false);
    assert_eq!(&fitted - &mirrored, owned(&["surface_distance"]));
    let forces = names(WallVelocity::Fitted, true);
    assert_eq!(&forces - &fitted, owned(&["reaction_x", "reaction_y"]));
}

#[test]
fn gas() {
    let names = |shocks| cost(&gas_box::gas_box::<f64>(2, shocks).model.columns).1;
    let plain = names(None);
    let owned = |names: &[&str]| names.iter().map(|&n| n.to_owned()).collect::<BTreeSet<String>>();
    // Density is a sum: it has no rate.
    assert!(!plain.iter().any(|name| name.contains("density_rate")));
    let shocks = ShockCapturing { conductivity: 0.0, ..ShockCapturing::default() };
    let viscous = names(Some(shocks));
    assert_eq!(&viscous - &plain, owned(&["signal_speed"]));
    let conducting = names(Some(ShockCapturing::default()));
    assert!(conducting.len() <= viscous.len() + 1, "{conducting:?}");
}
