//! The same flow gives the same bits for any number of workers, schedule and hand-out order.

use std::f64::consts::TAU;

use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::{Domain, HandOut, Schedule, Settings, Simulation, VectorField};
use finegrain_lbm::{
    Body, Collision, Compiled, Condition, Fluid, LatticeKind, Lbm, Mesh, Opening, Physics, Scheme,
    Start, Streaming, Wall,
};

/// A wall that slides, a body across a periodic end, a force that varies, in place.
fn in_place<T: Compiled>(lattice: LatticeKind, collision: Collision) -> Lbm<T> {
    let (streaming, wall) = (Some(Streaming::InPlace), Wall::HalfWay);
    let depth = if lattice.dims() == 2 { 1 } else { 11 };
    between_walls([45, 21, depth], Scheme { collision, streaming, wall, ..Scheme::on(lattice) })
}

/// The same where every row or two are a tile: on either side of a tile lie several others.
fn in_many_tiles<T: Compiled>(lattice: LatticeKind, collision: Collision) -> Lbm<T> {
    let (streaming, wall) = (Some(Streaming::InPlace), Wall::HalfWay);
    let scheme = Scheme { collision, streaming, wall, ..Scheme::on(lattice) };
    let shape = if lattice.dims() == 2 { [2800, 13, 1] } else { [2800, 4, 4] };
    let lbm = between_walls(shape, scheme);
    assert!(lbm.model.domain.partition().len() >= 7);
    lbm
}

/// Everything at once: walls that slide, a curved body across a periodic end, a force that varies.
fn model<T: Compiled>(lattice: LatticeKind, collision: Collision) -> Lbm<T> {
    let depth = if lattice.dims() == 2 { 1 } else { 11 };
    between_walls([45, 21, depth], Scheme { collision, ..Scheme::on(lattice) })
}

fn between_walls<T: Compiled>(shape: [usize; 3], scheme: Scheme) -> Lbm<T> {
    let [length, height] = [shape[0], shape[1]].map(|n| 0.1 * n as f64);
    let mesh = Mesh {
        shape,
        corner: [0.0; 3],
        spacing: 0.1,
        time_step: 0.01,
        periodic: [true, false, true],
    };
    let fluid = Fluid { density: 2.0, kinematic_viscosity: 0.05, largest_speed: 0.5 };
    let wall = |y: f64, up: f64| Shape::HalfSpace { point: [0.0, y, 0.0], outward: [0.0, up, 0.0] };
    let post = Shape::Cylinder {
        axis: Axis::Z,
        centre: [length - 0.1, 0.5 * height - 0.05, 0.0],
        radius: 0.33 * height / 2.1,
    };
    let physics = Physics {
        body_acceleration: [0.1, 0.0, 0.0],
        acceleration_field: Some(VectorField::new(|[x, y, _], t| {
            [0.1 * (x + t).sin(), 0.1 * (y - t).cos(), 0.0]
        })),
        bodies: vec![
            wall(0.03, 1.0).into(),
            Body { shape: wall(height - 0.02, -1.0), surface_velocity: [0.3, 0.0, 0.0] },
            post.into(),
        ],
        ..Physics::default()
    };
    let start = Start::with_velocity(|[x, _, _]| [0.0, 0.1 * (TAU * x / 4.5).sin(), 0.0]);
    Lbm::new(&mesh, &fluid, &physics, &scheme, &start).unwrap()
}

/// A channel with an inlet that varies, an outlet that is open to waves, and eddies.
fn channel<T: Compiled>(lattice: LatticeKind, collision: Collision) -> Lbm<T> {
    let outlet = Condition::NonReflecting { pressure: 0.01, relaxation: 0.1 };
    with_open_ends(outlet, Scheme { collision, ..Scheme::on(lattice) })
}

/// The same with an outlet that in-place streaming covers.
fn open_in_place<T: Compiled>(lattice: LatticeKind, collision: Collision) -> Lbm<T> {
    let (streaming, wall) = (Some(Streaming::InPlace), Wall::HalfWay);
    let scheme = Scheme { collision, streaming, wall, ..Scheme::on(lattice) };
    with_open_ends(Condition::Pressure(0.01), scheme)
}

fn with_open_ends<T: Compiled>(outlet: Condition, scheme: Scheme) -> Lbm<T> {
    let lattice = scheme.lattice;
    let depth = if lattice.dims() == 2 { 1 } else { 11 };
    let mesh = Mesh {
        shape: [45, 21, depth],
        corner: [0.0; 3],
        spacing: 0.1,
        time_step: 0.01,
        periodic: [false, false, true],
    };
    let fluid = Fluid { density: 2.0, kinematic_viscosity: 0.01, largest_speed: 0.5 };
    let wall = |y: f64, up: f64| Shape::HalfSpace { point: [0.0, y, 0.0], outward: [0.0, up, 0.0] };
    let inlet = VectorField::new(|[_, y, _], t| [0.3 * y * (2.1 - y) * (1.0 + t).sin(), 0.0, 0.0]);
    let opening = |is_upper, condition| Opening { axis: Axis::X, is_upper, condition };
    let post = Shape::Cylinder { axis: Axis::Z, centre: [2.0, 1.0, 0.0], radius: 0.33 };
    let physics = Physics {
        bodies: vec![wall(0.03, 1.0).into(), wall(2.08, -1.0).into(), post.into()],
        openings: vec![opening(false, Condition::Velocity(inlet)), opening(true, outlet)],
        ..Physics::default()
    };
    let scheme = Scheme { smagorinsky: Some(0.15), ..scheme };
    Lbm::new(&mesh, &fluid, &physics, &scheme, &Start::default()).unwrap()
}

/// Builds a model on a lattice with a collision.
type Build<T> = fn(LatticeKind, Collision) -> Lbm<T>;

fn same_bits<T: Compiled>(model: Build<T>, lattice: LatticeKind, collision: Collision) {
    let hash = |settings: Settings| {
        let lbm = model(lattice, collision);
        let mut simulation = Simulation::new(lbm.model, settings).unwrap();
        simulation.advance(13).unwrap();
        simulation.state_hash()
    };
    let serial = Settings { schedule: Schedule::Serial, workers: 1, ..Settings::default() };
    let expected = hash(serial);
    for schedule in Schedule::ALL {
        for workers in [1, 2, 3, 8] {
            for hand_out in [HandOut::Natural, HandOut::Shuffled { seed: 3 }] {
                let settings = Settings { schedule, workers, hand_out, ..Settings::default() };
                assert_eq!(hash(settings.clone()), expected, "{settings:?}");
            }
        }
    }
}

#[test]
fn in_the_plane() {
    same_bits::<f64>(model, LatticeKind::D2Q9, Collision::default());
    same_bits::<f64>(model, LatticeKind::D2Q9, Collision::Bgk);
}

#[test]
fn in_space() {
    same_bits::<f64>(model, LatticeKind::D3Q19, Collision::Trt { magic: 0.25 });
    same_bits::<f64>(model, LatticeKind::D3Q27, Collision::Regularised);
}

#[test]
fn streamed_in_place() {
    same_bits::<f64>(in_place, LatticeKind::D2Q9, Collision::default());
    same_bits::<f64>(in_place, LatticeKind::D3Q19, Collision::default());
    same_bits::<f32>(in_place, LatticeKind::D3Q27, Collision::Bgk);
}

#[test]
fn streamed_in_place_in_many_tiles() {
    same_bits::<f64>(in_many_tiles, LatticeKind::D2Q9, Collision::default());
    same_bits::<f32>(in_many_tiles, LatticeKind::D3Q27, Collision::Bgk);
}

#[test]
fn streamed_in_place_between_open_ends() {
    same_bits::<f64>(open_in_place, LatticeKind::D2Q9, Collision::default());
    same_bits::<f64>(open_in_place, LatticeKind::D3Q19, Collision::default());
}

#[test]
fn in_single_precision() {
    same_bits::<f32>(model, LatticeKind::D3Q19, Collision::default());
    same_bits::<f32>(model, LatticeKind::D2Q9, Collision::Regularised);
}

#[test]
fn in_a_channel_with_open_ends() {
    same_bits::<f64>(channel, LatticeKind::D2Q9, Collision::CentralMoments);
    same_bits::<f64>(channel, LatticeKind::D3Q19, Collision::Mrt { magic: 0.25 });
    same_bits::<f32>(channel, LatticeKind::D3Q27, Collision::Cumulant);
}

/// From a checkpoint written in the middle, with the populations in either set of columns.
#[test]
fn after_a_restart() {
    for build in [model::<f64>, channel::<f64>, in_place::<f64>, open_in_place::<f64>] {
        restart(build);
    }
}

fn restart(build: Build<f64>) {
    let folder = tempfile::tempdir().unwrap();
    let start = |settings| {
        let lbm = build(LatticeKind::D2Q9, Collision::default());
        Simulation::new(lbm.model, settings).unwrap()
    };
    let mut whole = start(Settings::default());
    whole.advance(25).unwrap();
    for steps in [0, 7, 12] {
        let path = folder.path().join(format!("{steps}.ckpt"));
        let mut first = start(Settings::default());
        first.advance(steps).unwrap();
        first.save(&path, 1).unwrap();
        let other = Settings { schedule: Schedule::PeerToPeer, workers: 3, ..Settings::default() };
        let mut second = start(other);
        second.restore(&path, 1).unwrap();
        second.advance(25 - steps).unwrap();
        assert_eq!(second.state_hash(), whole.state_hash(), "from step {steps}");
    }
}
