//! What must not change, and what changes by what is done to it.

use std::f64::consts::TAU;

use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::{Settings, Simulation};
use finegrain_lbm::{
    Body, Collision, Fluid, LatticeKind, Lbm, Mesh, Physics, Scheme, Start, Wall, measure,
};

const FLUID: Fluid = Fluid { density: 2.0, kinematic_viscosity: 0.02, largest_speed: 1.0 };

fn mesh(lattice: LatticeKind, periodic: bool) -> Mesh {
    let depth = if lattice.dims() == 2 { 1 } else { 12 };
    Mesh {
        shape: [24, 20, depth],
        corner: [0.0; 3],
        spacing: 0.05,
        time_step: 0.005,
        periodic: [periodic, periodic, true],
    }
}

/// Mass beyond that of the reference density, over the whole, before and after some steps.
fn excess_mass(
    lattice: LatticeKind,
    collision: Collision,
    physics: &Physics,
    mesh: &Mesh,
) -> [f64; 2] {
    let scheme = Scheme { collision, wall: Wall::HalfWay, ..Scheme::on(lattice) };
    let start = Start {
        velocity: Box::new(|[x, y, _]| [0.2 * (TAU * y).sin(), 0.1 * (TAU * x / 1.2).cos(), 0.0]),
        pressure: Box::new(|[x, y, _]| 0.3 * (TAU * (x / 1.2 + y)).sin()),
    };
    let lbm = Lbm::<f64>::new(mesh, &FLUID, physics, &scheme, &start).unwrap();
    let mut simulation = Simulation::new(lbm.model, Settings::default()).unwrap();
    [0, 500].map(|steps| {
        simulation.advance(steps).unwrap();
        simulation.derive().unwrap();
        let totals = measure::totals(&mut simulation.whole(), &lbm.parts);
        totals.excess_mass / totals.mass
    })
}

const COLLISIONS: [Collision; 6] = [
    Collision::Bgk,
    Collision::Trt { magic: 0.25 },
    Collision::Mrt { magic: 0.25 },
    Collision::CentralMoments,
    Collision::Cumulant,
    Collision::Regularised,
];

#[test]
fn mass_in_a_periodic_box() {
    for lattice in [LatticeKind::D2Q9, LatticeKind::D3Q19, LatticeKind::D3Q27] {
        for collision in COLLISIONS {
            let mesh = mesh(lattice, true);
            let [before, after] = excess_mass(lattice, collision, &Physics::default(), &mesh);
            assert!((after - before).abs() < 1e-15, "{lattice:?} {collision:?}: {before} {after}");
        }
    }
}

/// Closed all around, with a lid that slides, a post and a force.
#[test]
fn mass_in_a_closed_box() {
    let wall = |point: [f64; 3], outward: [f64; 3]| Shape::HalfSpace { point, outward };
    let lid = wall([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
    let post = Shape::Cylinder { axis: Axis::Z, centre: [0.5, 0.4, 0.0], radius: 0.2 };
    let physics = Physics {
        body_acceleration: [0.3, -0.2, 0.0],
        bodies: vec![
            wall([0.0; 3], [1.0, 0.0, 0.0]).into(),
            wall([1.2, 0.0, 0.0], [-1.0, 0.0, 0.0]).into(),
            wall([0.0; 3], [0.0, 1.0, 0.0]).into(),
            Body { shape: lid, surface_velocity: [0.5, 0.0, 0.0] },
            post.into(),
        ],
        ..Physics::default()
    };
    for lattice in [LatticeKind::D2Q9, LatticeKind::D3Q19] {
        for collision in COLLISIONS {
            let mesh = mesh(lattice, false);
            let [before, after] = excess_mass(lattice, collision, &physics, &mesh);
            assert!((after - before).abs() < 1e-15, "{lattice:?} {collision:?}: {before} {after}");
        }
    }
}

/// Momentum changes in a step by the body force on the fluid less the force on the body, whatever
/// the wall: the force on the body is what the populations exchange with it.
#[test]
fn momentum_goes_into_the_body() {
    let body = Shape::Sphere { centre: [0.55, 0.52, 0.31], radius: 0.21 };
    let acceleration = [0.2, 0.1, -0.05];
    let physics = Physics {
        body_acceleration: acceleration,
        bodies: vec![body.into()],
        ..Physics::default()
    };
    for wall in [Wall::HalfWay, Wall::Interpolated] {
        let scheme = Scheme { wall, ..Scheme::on(LatticeKind::D3Q19) };
        let mesh = mesh(LatticeKind::D3Q19, true);
        let start = Start::with_velocity(|_| [0.1, 0.0, 0.0]);
        let lbm = Lbm::<f64>::new(&mesh, &FLUID, &physics, &scheme, &start).unwrap();
        let mut simulation = Simulation::new(lbm.model, Settings::default()).unwrap();
        simulation.advance(20).unwrap();
        simulation.derive().unwrap();
        let force = measure::force_on_body(&mut simulation.whole(), &lbm.parts, 0);
        let before = measure::totals(&mut simulation.whole(), &lbm.parts);
        simulation.advance(1).unwrap();
        simulation.derive().unwrap();
        let after = measure::totals(&mut simulation.whole(), &lbm.parts);
        for a in 0..3 {
            let change = (after.momentum[a] - before.momentum[a]) / mesh.time_step;
            // Half of the force of each of the two collisions is in the step between them.
            let driving = 0.5 * acceleration[a] * (before.mass + after.mass);
            assert!((change - driving + force[a]).abs() < 1e-12, "{wall:?} {a}");
            assert!(force[a].abs() > 1e-4);
        }
    }
}
