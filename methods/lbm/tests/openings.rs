//! Ends of the mesh through which fluid comes and goes.

use std::f64::consts::TAU;

use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::Grid;
use finegrain_framework::{Settings, Simulation, VectorField};
use finegrain_lbm::mesh::{time_step_of_mach, time_step_of_relaxation_time};
use finegrain_lbm::{
    Collision, Condition, Fields, Fluid, LatticeKind, Lbm, Mesh, Opening, Physics, Scheme, Start,
    Wall,
};

const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];

fn opening(axis: usize, is_upper: bool, condition: Condition) -> Opening {
    Opening { axis: AXES[axis], is_upper, condition }
}

/// A run and its columns.
struct Running {
    simulation: Simulation<Grid>,
    fields: Fields<f64>,
    shape: [usize; 3],
}

impl Running {
    fn new(
        lattice: LatticeKind,
        mesh: &Mesh,
        fluid: &Fluid,
        physics: &Physics,
        start: &Start,
    ) -> Self {
        let scheme = Scheme {
            collision: Collision::Trt { magic: 3.0 / 16.0 },
            wall: Wall::HalfWay,
            ..Scheme::on(lattice)
        };
        let lbm = Lbm::<f64>::new(mesh, fluid, physics, &scheme, start).unwrap();
        let simulation = Simulation::new(lbm.model, Settings::default()).unwrap();
        Self { simulation, fields: lbm.fields, shape: mesh.shape }
    }

    fn advance(&mut self, steps: u64) {
        self.simulation.advance(steps).unwrap();
        self.simulation.derive().unwrap();
    }

    fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.shape[1] + y) * self.shape[0] + x
    }

    fn velocity(&self, site: [usize; 3], a: usize) -> f64 {
        self.simulation.columns().values(self.fields.velocity[a])[self.number(site)]
    }

    fn pressure(&self, site: [usize; 3]) -> f64 {
        self.simulation.columns().values(self.fields.pressure)[self.number(site)]
    }
}

const WIDTH: usize = 12;
const LENGTH: usize = 30;
const VISCOSITY: f64 = 0.1;
const SPEED: f64 = 0.02;

/// A channel of width 1 along `axis` (3: not in the plane), with a parabola at its inlet, plates across
/// the next direction, and `force` times the body force that needs no pressure gradient.
fn channel(lattice: LatticeKind, axis: usize, force: f64, outlet: Condition) -> Running {
    let across = (axis + 1) % lattice.dims();
    let spacing = 1.0 / WIDTH as f64;
    let mut shape = [3, 3, if lattice.dims() == 2 { 1 } else { 3 }];
    (shape[axis], shape[across]) = (LENGTH, WIDTH);
    let mut periodic = [true; 3];
    (periodic[axis], periodic[across]) = (false, false);
    let mesh = Mesh {
        shape,
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_relaxation_time(spacing, VISCOSITY, 0.8),
        periodic,
    };
    let fluid = Fluid { density: 2.0, kinematic_viscosity: VISCOSITY, largest_speed: SPEED };
    let along = move |value: f64| {
        let mut vector = [0.0; 3];
        vector[axis] = value;
        vector
    };
    let parabola = move |x: [f64; 3]| along(4.0 * SPEED * x[across] * (1.0 - x[across]));
    let plate = |at: f64, up: f64| {
        let (mut point, mut outward) = ([0.0; 3], [0.0; 3]);
        (point[across], outward[across]) = (at, up);
        Shape::HalfSpace { point, outward }.into()
    };
    let inlet = Condition::Velocity(VectorField::new(move |x, _| parabola(x)));
    let physics = Physics {
        body_acceleration: along(force * 8.0 * VISCOSITY * SPEED),
        bodies: vec![plate(0.0, 1.0), plate(1.0, -1.0)],
        openings: vec![opening(axis, false, inlet), opening(axis, true, outlet)],
        ..Physics::default()
    };
    Running::new(lattice, &mesh, &fluid, &physics, &Start::with_velocity(parabola))
}

fn exact(y: usize) -> f64 {
    let y = (y as f64 + 0.5) / WIDTH as f64;
    4.0 * SPEED * y * (1.0 - y)
}

/// Place in the channel `n` from the inlet and `y` from the plate.
fn place(lattice: LatticeKind, axis: usize, [n, y]: [usize; 2]) -> [usize; 3] {
    let mut site = [1, 1, if lattice.dims() == 2 { 0 } else { 1 }];
    (site[axis], site[(axis + 1) % lattice.dims()]) = (n, y);
    site
}

/// With a body force that needs no pressure gradient the parabola is a solution from end to end, in the
/// plane of every opening with all its corners.
#[test]
fn a_parabola_goes_through() {
    for (lattice, axis) in [
        (LatticeKind::D2Q9, 0),
        (LatticeKind::D2Q9, 1),
        (LatticeKind::D3Q19, 2),
        (LatticeKind::D3Q27, 0),
    ] {
        let mut running = channel(lattice, axis, 1.0, Condition::Pressure(0.0));
        running.advance(4000);
        let worst = |n: usize| {
            let error =
                |y: usize| running.velocity(place(lattice, axis, [n, y]), axis) / exact(y) - 1.0;
            (0..WIDTH).map(|y| error(y).abs()).fold(0.0, f64::max)
        };
        assert!(worst(0) < 1e-13, "{lattice:?} {axis}: {}", worst(0));
        // What the stress alone does not say about the populations at the ends dies out inside.
        assert!(worst(LENGTH / 2) < 1e-6, "{lattice:?} {axis}: {}", worst(LENGTH / 2));
        let most = (0..LENGTH).map(worst).fold(0.0, f64::max);
        assert!(most < 1e-3, "{lattice:?} {axis}: {most}");
    }
}

/// Without the force the pressure drives the flow: it falls as in the parabola from the inlet to what the
/// outlet prescribes, and as much mass goes through every section.
#[test]
fn pressure_falls_to_that_of_the_outlet() {
    let outlets =
        [Condition::Pressure(0.01), Condition::NonReflecting { pressure: 0.01, relaxation: 1.0 }];
    for (outlet, within) in outlets.into_iter().zip([1e-15, 1e-3]) {
        let mut running = channel(LatticeKind::D2Q9, 0, 0.0, outlet);
        running.advance(40_000);
        let pressure = |x: usize| running.pressure([x, WIDTH / 2, 0]);
        let at_outlet = pressure(LENGTH - 1) - 0.01;
        assert!(at_outlet.abs() < within, "{at_outlet}");
        let gradient = (pressure(20) - pressure(8)) / 12.0 * WIDTH as f64;
        let expected = -8.0 * 2.0 * VISCOSITY * SPEED;
        // Less than the density falls.
        assert!((gradient / expected - 1.0).abs() < 1.5e-3, "{gradient} {expected}");
        // c_s^2 rho, with the unit of velocity squared: dt = 0.1 dx^2 / nu.
        let unit = VISCOSITY * WIDTH as f64 / 0.1;
        let flux = |x: usize| -> f64 {
            let of = |y: usize| {
                let density = 1.0 + 3.0 * running.pressure([x, y, 0]) / (2.0 * unit * unit);
                density * running.velocity([x, y, 0], 0)
            };
            (0..WIDTH).map(of).sum()
        };
        for x in 2..LENGTH - 1 {
            assert!((flux(x) / flux(1) - 1.0).abs() < 1e-9, "{x}: {} {}", flux(x), flux(1));
        }
    }
}

#[test]
fn an_inlet_follows_its_function_of_time_and_place() {
    let spacing = 0.1;
    let time_step = time_step_of_mach(spacing, 1.0, 0.1);
    let mesh = Mesh {
        shape: [12, 10, 1],
        corner: [0.0; 3],
        spacing,
        time_step,
        periodic: [false, true, true],
    };
    let fluid = Fluid { density: 1.0, kinematic_viscosity: 0.01, largest_speed: 1.0 };
    let gust = |x: [f64; 3], t: f64| {
        [0.5 * (3.0 * t).sin(), 0.3 * (TAU * x[1]).cos() * (2.0 * t).sin(), 0.0]
    };
    let inlet = Condition::Velocity(VectorField::new(gust));
    let outlet = Condition::NonReflecting { pressure: 0.0, relaxation: 0.1 };
    let physics = Physics {
        body_acceleration: [0.2, -0.1, 0.0],
        openings: vec![opening(0, false, inlet), opening(0, true, outlet)],
        ..Physics::default()
    };
    let mut running = Running::new(LatticeKind::D2Q9, &mesh, &fluid, &physics, &Start::default());
    for _ in 0..5 {
        running.advance(17);
        let time = running.simulation.clock().time();
        for y in 0..10 {
            let expected = gust(mesh.position([0, y as isize, 0]), time);
            for a in 0..2 {
                let error = running.velocity([0, y, 0], a) - expected[a];
                assert!(error.abs() < 1e-13, "{y}, {a}: {error}");
            }
        }
    }
}

/// A pulse of pressure that runs out of a tube, with ends across `axis`: the largest pressure that is
/// left inside when it should be gone, over its amplitude.
fn reflected(axis: usize, outlet: Condition) -> f64 {
    let (length, spacing) = (200, 0.01);
    let mut shape = [3, 3, 1];
    shape[axis] = length;
    let mut periodic = [true; 3];
    periodic[axis] = false;
    let (speed, amplitude) = (1.0, 1e-3);
    let time_step = time_step_of_mach(spacing, speed, 0.1);
    let mesh = Mesh { shape, corner: [0.0; 3], spacing, time_step, periodic };
    let fluid = Fluid { density: 1.0, kinematic_viscosity: 1e-3, largest_speed: speed };
    // Both ends let waves out, so what starts at rest splits in two and leaves.
    let physics = Physics {
        openings: vec![opening(axis, false, outlet.clone()), opening(axis, true, outlet)],
        ..Physics::default()
    };
    let start = Start {
        pressure: Box::new(move |x| amplitude * (-((x[axis] - 1.0) / 0.1).powi(2)).exp()),
        ..Start::default()
    };
    let mut running = Running::new(LatticeKind::D2Q9, &mesh, &fluid, &physics, &start);
    // At the speed of sound half of the tube takes 173 steps, and the pulse is 60 long.
    running.advance(300);
    let mut most = 0.0f64;
    for i in 0..length {
        let mut site = [1, 1, 0];
        site[axis] = i;
        most = most.max(running.pressure(site).abs());
    }
    most / (0.5 * amplitude)
}

#[test]
fn a_non_reflecting_outlet_lets_sound_out() {
    for axis in [0, 1] {
        let plain = reflected(axis, Condition::Pressure(0.0));
        let quiet = Condition::NonReflecting { pressure: 0.0, relaxation: 0.0 };
        let quiet = reflected(axis, quiet);
        // The plain one reflects all but what viscosity takes.
        assert!(plain > 0.95, "{plain}");
        assert!(quiet < 0.002, "{quiet}");
    }
}
