//! Bad input gets an error that names what and where, and never a panic.

use finegrain_framework::shape::{Axis, Shape};
use finegrain_lbm::{
    Body, Collision, Condition, Fluid, LatticeKind, Lbm, Mesh, Opening, Physics, Scheme, Start,
};

const MESH: Mesh =
    Mesh { shape: [8, 8, 1], corner: [0.0; 3], spacing: 0.1, time_step: 0.01, periodic: [true; 3] };
const FLUID: Fluid = Fluid { density: 1.0, kinematic_viscosity: 0.1, largest_speed: 0.5 };

fn said(mesh: &Mesh, fluid: &Fluid, physics: &Physics, scheme: &Scheme, start: &Start) -> String {
    match Lbm::<f64>::new(mesh, fluid, physics, scheme, start) {
        Ok(_) => panic!("must be refused"),
        Err(error) => error.to_string(),
    }
}

fn of_mesh(mesh: Mesh) -> String {
    let scheme = Scheme::on(LatticeKind::D2Q9);
    said(&mesh, &FLUID, &Physics::default(), &scheme, &Start::default())
}

fn of_fluid(fluid: Fluid) -> String {
    let scheme = Scheme::on(LatticeKind::D2Q9);
    said(&MESH, &fluid, &Physics::default(), &scheme, &Start::default())
}

fn of_bodies(mesh: &Mesh, bodies: Vec<Body>) -> String {
    let physics = Physics { bodies, ..Physics::default() };
    said(mesh, &FLUID, &physics, &Scheme::on(LatticeKind::D2Q9), &Start::default())
}

#[test]
fn numbers_outside_their_range() {
    assert!(of_mesh(Mesh { spacing: 0.0, ..MESH }).contains("spacing is 0"));
    assert!(of_mesh(Mesh { time_step: f64::NAN, ..MESH }).contains("time_step is NaN"));
    assert!(of_mesh(Mesh { corner: [0.0, f64::INFINITY, 0.0], ..MESH }).contains("corner is inf"));
    assert!(of_mesh(Mesh { shape: [8, 0, 1], ..MESH }).contains("[8, 0, 1]"));
    assert!(of_mesh(Mesh { shape: [8, 8, 2], ..MESH }).contains("D2Q9"));
    assert!(of_fluid(Fluid { density: -1.0, ..FLUID }).contains("density is -1"));
    assert!(of_fluid(Fluid { kinematic_viscosity: 0.0, ..FLUID }).contains("kinematic_viscosity"));
    let collision = Collision::Trt { magic: 0.0 };
    let scheme = Scheme { collision, ..Scheme::on(LatticeKind::D2Q9) };
    let (physics, start) = (Physics::default(), Start::default());
    assert!(said(&MESH, &FLUID, &physics, &scheme, &start).contains("magic is 0"));
    let scheme = Scheme { smagorinsky: Some(-0.1), ..Scheme::on(LatticeKind::D2Q9) };
    assert!(said(&MESH, &FLUID, &physics, &scheme, &start).contains("smagorinsky is -0.1"));
    let physics = Physics { body_acceleration: [0.0, f64::NAN, 0.0], ..Physics::default() };
    let scheme = Scheme::on(LatticeKind::D2Q9);
    assert!(said(&MESH, &FLUID, &physics, &scheme, &start).contains("body_acceleration is NaN"));
}

#[test]
fn a_relaxation_time_next_to_one_half_or_far_from_it() {
    let text = of_fluid(Fluid { kinematic_viscosity: 1e-7, ..FLUID });
    assert!(text.contains("relaxation time is 0.5000003") && text.contains("0.500001"), "{text}");
    let text = of_fluid(Fluid { kinematic_viscosity: 1e3, ..FLUID });
    assert!(text.contains("between 0.500001 and 100"), "{text}");
}

#[test]
fn a_flow_that_is_too_fast() {
    let text = of_fluid(Fluid { largest_speed: 2.0, ..FLUID });
    assert!(
        text.contains("Mach number") && text.contains("2 m/s") && text.contains("0.3"),
        "{text}"
    );
}

#[test]
fn bodies_that_make_no_sense() {
    let body = Shape::Cylinder { axis: Axis::Z, centre: [0.5; 3], radius: -0.1 };
    assert!(of_bodies(&MESH, vec![body.into()]).contains("body 0"));
    let body = Shape::Sphere { centre: [0.4, 0.4, 0.0], radius: 0.2 };
    let fast = Body { shape: body, surface_velocity: [0.0, f64::INFINITY, 0.0] };
    assert!(of_bodies(&MESH, vec![fast]).contains("surface_velocity is inf"));
    let everything = Shape::Sphere { centre: [0.4, 0.4, 0.0], radius: 5.0 };
    assert!(of_bodies(&MESH, vec![everything.into()]).contains("fill the whole mesh"));
    assert!(of_bodies(&MESH, vec![body.into(); 256]).contains("256 bodies"));
}

#[test]
fn an_open_end() {
    let mesh = Mesh { periodic: [true, false, true], ..MESH };
    let floor = Shape::HalfSpace { point: [0.0; 3], outward: [0.0, 1.0, 0.0] };
    let text = of_bodies(&mesh, vec![floor.into()]);
    // The first place above the mesh.
    assert!(text.contains("0.85") && text.contains("without a wall"), "{text}");
}

#[test]
fn openings_that_make_no_sense() {
    let of = |mesh: &Mesh, openings: Vec<Opening>, bodies: Vec<Body>| {
        let physics = Physics { openings, bodies, ..Physics::default() };
        said(mesh, &FLUID, &physics, &Scheme::on(LatticeKind::D2Q9), &Start::default())
    };
    let end = |axis, condition| Opening { axis, is_upper: false, condition };
    let outlet = |axis| end(axis, Condition::Pressure(0.0));
    let text = of(&MESH, vec![outlet(Axis::X)], vec![]);
    assert!(text.contains("no opening across x") && text.contains("periodic"), "{text}");
    let mesh = Mesh { periodic: [false; 3], ..MESH };
    assert!(of(&mesh, vec![outlet(Axis::Z)], vec![]).contains("across z"));
    // The corner at the lower ends.
    let text = of(&mesh, vec![outlet(Axis::X), outlet(Axis::Y)], vec![]);
    assert!(text.contains("two openings meet at [0.05") && text.contains("wall"), "{text}");
    let mesh = Mesh { periodic: [false, true, true], ..MESH };
    assert!(of(&mesh, vec![outlet(Axis::X); 2], vec![]).contains("two openings meet"));
    assert!(of(&mesh, vec![outlet(Axis::X); 7], vec![]).contains("7 openings"));
    let end_wall = Shape::HalfSpace { point: [0.8, 0.0, 0.0], outward: [-1.0, 0.0, 0.0] };
    let box_of_sites = Shape::Cuboid { low: [0.1, 0.2, -1.0], high: [0.4, 0.5, 1.0] };
    let text = of(&mesh, vec![outlet(Axis::X)], vec![box_of_sites.into(), end_wall.into()]);
    assert!(text.contains("blocks the opening at [0.05, 0.25"), "{text}");
    assert!(of(&mesh, vec![outlet(Axis::X)], vec![]).contains("without a wall"));
    let text = of(&mesh, vec![end(Axis::X, Condition::Pressure(f64::NAN))], vec![]);
    assert!(text.contains("pressure is NaN"), "{text}");
    let waves = Condition::NonReflecting { pressure: 0.0, relaxation: -1.0 };
    assert!(of(&mesh, vec![end(Axis::X, waves)], vec![]).contains("relaxation is -1"));
}

#[test]
fn a_start_that_is_not_a_number() {
    let scheme = Scheme::on(LatticeKind::D2Q9);
    let physics = Physics::default();
    let start = Start::with_velocity(|[x, _, _]| [1.0 / (x - 0.35).max(0.0), 0.0, 0.0]);
    let text = said(&MESH, &FLUID, &physics, &scheme, &start);
    assert!(text.contains("initial velocity at [0.05"), "{text}");
    let start = Start { pressure: Box::new(|_| f64::NAN), ..Start::default() };
    assert!(said(&MESH, &FLUID, &physics, &scheme, &start).contains("initial pressure"));
}
