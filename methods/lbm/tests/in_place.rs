//! Streaming in place computes the same bits as two grids, whatever is modelled.

use std::f64::consts::TAU;

use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::{Settings, Simulation, VectorField};
use finegrain_lbm::{
    Body, Collision, Compiled, Condition, Fluid, LatticeKind, Lbm, LbmError, Mesh, Opening,
    Physics, Scheme, Start, Streaming, Wall, measure,
};

const STEPS: u64 = 23;

fn wall(point: [f64; 3], outward: [f64; 3]) -> Shape {
    Shape::HalfSpace { point, outward }
}

fn mesh(lattice: LatticeKind, periodic: [bool; 3]) -> Mesh {
    let depth = if lattice.dims() == 2 { 1 } else { 9 };
    Mesh { shape: [37, 12, depth], corner: [0.0; 3], spacing: 0.1, time_step: 0.01, periodic }
}

/// A force that varies, and bodies inside: one across a periodic end, one that slides.
fn obstacles(lattice: LatticeKind) -> (Mesh, Physics) {
    let cylinder = |x, y| Shape::Cylinder { axis: Axis::Z, centre: [x, y, 0.0], radius: 0.27 };
    let belt = Body { shape: cylinder(1.5, 0.6), surface_velocity: [0.2, 0.1, 0.0] };
    let field = VectorField::new(|[x, y, _], t| [0.1 * (x + t).sin(), 0.1 * (y - t).cos(), 0.05]);
    let physics = Physics {
        body_acceleration: [0.1, 0.0, 0.0],
        acceleration_field: Some(field),
        bodies: vec![belt, cylinder(3.65, 1.17).into()],
        ..Physics::default()
    };
    (mesh(lattice, [true; 3]), physics)
}

/// A closed box with a lid, its walls beyond the last sites of the mesh: what leaves at one end of the
/// mesh is kept at the other.
fn cavity(lattice: LatticeKind) -> (Mesh, Physics) {
    let is_plane = lattice.dims() == 2;
    let mesh = mesh(lattice, [false, false, is_plane]);
    let ends = [0, 1, 2].map(|a| mesh.shape[a] as f64 * mesh.spacing);
    let mut bodies = Vec::new();
    for a in 0..lattice.dims() {
        let mut outward = [0.0; 3];
        outward[a] = 1.0;
        bodies.push(Body::from(wall([0.0; 3], outward)));
        outward[a] = -1.0;
        let surface_velocity = if a == 1 { [0.3, 0.0, 0.0] } else { [0.0; 3] };
        bodies.push(Body { shape: wall(ends, outward), surface_velocity });
    }
    (mesh, Physics { bodies, ..Physics::default() })
}

/// A channel along `axis`, in with a velocity and out to a pressure, around a post.
fn channel(lattice: LatticeKind, axis: usize) -> (Mesh, Physics) {
    let across = 1 - axis;
    let mesh = mesh(lattice, [false, false, true]);
    let ends = [0, 1, 2].map(|a| mesh.shape[a] as f64 * mesh.spacing);
    let mut outward = [0.0; 3];
    outward[across] = 1.0;
    let walls = [wall([0.0; 3], outward), wall(ends, outward.map(|n| -n))];
    let post = Shape::Cylinder { axis: Axis::Z, centre: [0.6, 0.55, 0.0], radius: 0.12 };
    let inlet = VectorField::new(move |x, t| {
        let mut velocity = [0.0; 3];
        velocity[axis] = 0.2 * (TAU * x[across] / ends[across] + t).sin().powi(2);
        velocity
    });
    let opening =
        |is_upper, condition| Opening { axis: [Axis::X, Axis::Y][axis], is_upper, condition };
    let physics = Physics {
        bodies: walls.into_iter().chain([post]).map(Body::from).collect(),
        openings: vec![
            opening(false, Condition::Velocity(inlet)),
            opening(true, Condition::Pressure(0.01)),
        ],
        ..Physics::default()
    };
    (mesh, physics)
}

/// Everything that is looked at after some steps, as bits.
fn outcome<T: Compiled>(
    (mesh, physics): &(Mesh, Physics),
    scheme: Scheme,
    streaming: Streaming,
) -> Vec<u64> {
    let fluid = Fluid { density: 2.0, kinematic_viscosity: 0.02, largest_speed: 0.5 };
    let start = Start {
        velocity: Box::new(|[x, y, _]| {
            [0.1 * (TAU * y / 1.2).sin(), 0.1 * (TAU * x / 3.7).cos(), 0.05]
        }),
        pressure: Box::new(|[x, _, z]| 0.01 * (x + z).sin()),
    };
    let scheme = Scheme { streaming: Some(streaming), ..scheme };
    let lbm = Lbm::<T>::new(mesh, &fluid, physics, &scheme, &start).unwrap();
    let mut simulation = Simulation::new(lbm.model, Settings::default()).unwrap();
    let mut bits = Vec::new();
    for steps in [1, STEPS - 1] {
        simulation.advance(steps).unwrap();
        simulation.derive().unwrap();
        let columns = simulation.columns();
        for &column in lbm.fields.velocity.iter().chain([&lbm.fields.pressure]) {
            bits.extend(columns.values(column).iter().map(|value| value.as_f64().to_bits()));
        }
        let mut whole = simulation.whole();
        let totals = measure::totals(&mut whole, &lbm.parts);
        bits.push(totals.excess_mass.to_bits());
        for body in 0..physics.bodies.len() {
            let force = measure::force_on_body(&mut whole, &lbm.parts, body);
            assert!(force != [0.0; 3]);
            bits.extend(force.map(f64::to_bits));
        }
    }
    bits
}

fn same<T: Compiled>(lattice: LatticeKind, collision: Collision) {
    let smagorinsky = Some(0.1);
    let scheme = Scheme { collision, wall: Wall::HalfWay, smagorinsky, ..Scheme::on(lattice) };
    let all = [obstacles(lattice), cavity(lattice), channel(lattice, 0), channel(lattice, 1)];
    for (number, modelled) in all.iter().enumerate() {
        let two_grids = outcome::<T>(modelled, scheme, Streaming::TwoGrids);
        let in_place = outcome::<T>(modelled, scheme, Streaming::InPlace);
        assert!(two_grids == in_place, "model {number} on {lattice:?}");
    }
}

#[test]
fn in_place_has_the_bits_of_two_grids() {
    same::<f64>(LatticeKind::D2Q9, Collision::default());
    same::<f64>(LatticeKind::D3Q19, Collision::Trt { magic: 0.25 });
    same::<f64>(LatticeKind::D3Q27, Collision::Cumulant);
    same::<f32>(LatticeKind::D3Q19, Collision::default());
}

/// One set of populations instead of two, besides what is derived for those who look.
#[test]
fn in_place_takes_half_of_the_memory() {
    let lattice = LatticeKind::D3Q19;
    let memory = |streaming| {
        let (mesh, physics) = obstacles(lattice);
        let fluid = Fluid { density: 2.0, kinematic_viscosity: 0.02, largest_speed: 0.5 };
        let scheme =
            Scheme { streaming: Some(streaming), wall: Wall::HalfWay, ..Scheme::on(lattice) };
        let lbm = Lbm::<f64>::new(&mesh, &fluid, &physics, &scheme, &Start::default()).unwrap();
        let derived = 1 + lbm.fields.velocity.len();
        lbm.model.columns.memory() as f64 / mesh.sites() as f64 / 8.0 - derived as f64
    };
    assert!(memory(Streaming::InPlace) < 1.15 * 19.0);
    assert!(memory(Streaming::TwoGrids) > 38.0);
}

#[test]
fn what_streaming_in_place_does_not_cover_is_refused() {
    let lattice = LatticeKind::D2Q9;
    let build_with = |streaming, (mesh, physics): (Mesh, Physics), wall| {
        let fluid = Fluid { density: 2.0, kinematic_viscosity: 0.02, largest_speed: 0.5 };
        let scheme = Scheme { streaming, wall, ..Scheme::on(lattice) };
        let lbm = Lbm::<f64>::new(&mesh, &fluid, &physics, &scheme, &Start::default());
        lbm.map(|lbm| {
            lbm.model.columns.iter().filter(|(_, c)| c.name().starts_with("in_place")).count()
        })
    };
    let build = |modelled, wall| build_with(Some(Streaming::InPlace), modelled, wall);
    let error = build(cavity(lattice), Wall::Interpolated).unwrap_err();
    assert_eq!(error, LbmError::InPlace { what: "interpolated walls" });
    assert!(error.to_string().contains("half-way"));
    assert_eq!(build(cavity(lattice), Wall::HalfWay), Ok(9));
    // Nobody is refused who did not ask for it.
    assert_eq!(build_with(None, cavity(lattice), Wall::Interpolated), Ok(0));
    assert_eq!(build_with(None, cavity(lattice), Wall::HalfWay), Ok(9));
    let (mesh, mut physics) = channel(lattice, 0);
    physics.openings[1].condition = Condition::NonReflecting { pressure: 0.0, relaxation: 0.0 };
    let channel = (mesh, physics);
    let error = build(channel.clone(), Wall::HalfWay).unwrap_err();
    assert_eq!(error, LbmError::InPlace { what: "non-reflecting openings" });
    assert_eq!(build_with(None, channel, Wall::HalfWay), Ok(0));
    // Without bodies there are no walls.
    let open = (self::mesh(lattice, [true; 3]), Physics::default());
    assert_eq!(build(open.clone(), Wall::Interpolated), Ok(9));
    assert_eq!(build_with(Some(Streaming::TwoGrids), open, Wall::Interpolated), Ok(0));
}
