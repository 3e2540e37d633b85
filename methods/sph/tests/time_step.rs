//! The time step is the smallest of its limits (Morris, Fox & Zhu 1997), each in its regime.

use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation};
use finegrain_sph::{Fluid, Packing, Physics, Scheme, Sph, Start, StateEquation, Viscosity};

const SPACING: f64 = 0.1;

/// The first time step of a fluid that moves along x at `speed`.
fn time_step(sound_speed: f64, viscosity: f64, body_acceleration: f64, speed: f64) -> f64 {
    let lattice = Packing::Square.fit([1.0; 3], SPACING).unwrap();
    let positions: Vec<_> = lattice.positions().collect();
    let start = Start {
        region: Region { lower: vec![0.0; 2], upper: vec![1.0; 2], periodic: vec![true; 2] },
        spacing: SPACING,
        particle_volume: lattice.volume_per_particle(),
        velocities: vec![[speed, 0.0, 0.0]; positions.len()],
        positions,
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed,
        kinematic_viscosity: viscosity,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let physics = Physics {
        viscosity: Some(Viscosity::Morris),
        body_acceleration: [body_acceleration, 0.0, 0.0],
        ..Physics::default()
    };
    let sph = Sph::<f64>::new(&start, &fluid, &physics, &Scheme::default()).unwrap();
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    simulation.begin().unwrap();
    simulation.clock().dt()
}

fn is(a: f64, b: f64) {
    assert!((a / b - 1.0).abs() < 1e-12, "{a} for {b}");
}

#[test]
fn sound() {
    is(time_step(10.0, 1e-6, 0.0, 0.0), 0.25 * SPACING / 10.0);
    is(time_step(10.0, 1e-6, 0.0, 1.0), 0.25 * SPACING / 11.0);
}

#[test]
fn viscosity() {
    is(time_step(1e-3, 2.0, 0.0, 0.0), 0.125 * SPACING * SPACING / 2.0);
}

#[test]
fn body_force() {
    // The skin of 0.2 spacings is tighter than 0.25 sqrt(h / a): 0.8 of half of it is a t^2.
    let skin = (0.8 * 0.1 * SPACING / 50.0f64).sqrt();
    assert!(skin > 0.25 * (SPACING / 50.0f64).sqrt());
    is(time_step(1e-3, 1e-6, 50.0, 0.0), 0.25 * (SPACING / 50.0f64).sqrt());
}

#[test]
fn no_particle_leaves_the_skin_in_one_step() {
    // 0.25 h / (c + v) would carry it 0.1 h, the skin allows 0.08 h.
    is(time_step(30.0, 1e-6, 0.0, 20.0), 0.8 * 0.1 * SPACING / 20.0);
}
