//! The same problem gives the same bits for any number of workers, schedule and hand-out order, and after a
//! restart.

use finegrain_fd::{
    Advection, Boundary, Compiled, Condition, Data, Face, Fd, FlowEnd, Gas, GasEnd, GasState, Heat,
    Mesh, NavierStokes, Order, Side, Spread, StaggeredOrder, Wave,
};
use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::{Domain, HandOut, Integrator, Schedule, Settings, Simulation};

/// Conditions that vary along every end of a brick of which two directions are closed; its rows are so long that
/// tiles end between them.
fn brick() -> (Mesh, Boundary) {
    let mut boundary = Boundary::all(Condition::neumann(0.1));
    boundary.0[0][1] = Condition::Dirichlet(Data::varying(|x, t| (x[1] + x[2] + t).sin()));
    boundary.0[1][0] = Condition::robin(1.0, 0.5, Data::varying(|x, t| (x[0] - t).cos()));
    let sides =
        [Side::ends(371, 0.0, 10.0), Side::ends(46, 0.0, 1.4), Side::periodic(9, 0.0, 0.25)];
    (Mesh::new(sides), boundary)
}

fn start(x: [f64; 3]) -> f64 {
    (3.0 * x[0]).sin() + (5.0 * x[1] * x[2]).cos()
}

fn heat<T: Compiled>(order: Order, integrator: Integrator) -> Fd<T> {
    let (mesh, boundary) = brick();
    let heat = Heat { diffusivity: 0.2, order, integrator: integrator.into(), boundary };
    let dt = 0.9 * heat.time_step_limit(&mesh).unwrap();
    heat.model(&mesh, dt, &start).unwrap()
}

fn wave<T: Compiled>(order: Order) -> Fd<T> {
    let (mesh, boundary) = brick();
    let wave = Wave { speed: 0.2, order, boundary };
    let dt = 0.9 * wave.time_step_limit(&mesh).unwrap();
    wave.model(&mesh, dt, &start, &|x| x[0]).unwrap()
}

fn advection<T: Compiled>() -> Fd<T> {
    let mut boundary = Boundary::all(Condition::Outflow);
    boundary.0[0][0] = Condition::Dirichlet(Data::varying(|x, t| (x[1] + t).sin()));
    let (face, integrator) = (Face::Weno5Z, Integrator::SspRk3);
    let advection = Advection { face, integrator, boundary };
    let sides =
        [Side::cells(371, 0.0, 10.0), Side::cells(46, 0.0, 1.4), Side::periodic(9, 0.0, 0.25)];
    let velocity = |x: [f64; 3]| [1.0 + x[1], 0.5 * x[0], -0.3];
    advection.model(&Mesh::new(sides), 2e-3, &velocity, &start).unwrap()
}

fn gas<T: Compiled>() -> Fd<T> {
    let ends = [[GasEnd::Open, GasEnd::Wall], [GasEnd::Wall, GasEnd::Open]];
    let gas = Gas { heat_ratio: 1.4, courant: 0.45, ends };
    let mesh = Mesh::new([Side::cells(370, 0.0, 10.0), Side::cells(59, 0.0, 1.6)]);
    let state = |x: [f64; 3]| {
        let pressure = if x[0] + 0.5 * x[1] < 5.0 { 100.0 } else { 0.1 };
        GasState { density: 1.0 + 0.2 * x[1], velocity: [0.1, -0.2, 0.0], pressure }
    };
    gas.model(&mesh, &state).unwrap()
}

/// Flow along a duct with a moving wall, and in a periodic box.
fn flow<T: Compiled>(
    order: StaggeredOrder,
    integrator: Integrator,
    closed: fn(usize, f64, f64) -> Side,
) -> Fd<T> {
    let mut ends = [[FlowEnd::REST; 2]; 3];
    ends[1][1] = FlowEnd::Wall([1.0, 0.0, 0.5]);
    let acceleration = [0.1, 0.0, 0.0];
    let flow = NavierStokes {
        viscosity: 0.01,
        acceleration,
        ends,
        bodies: Vec::new(),
        order,
        integrator,
        courant: 0.9,
    };
    let mesh =
        Mesh::new([Side::periodic(37, 0.0, 1.0), closed(22, 0.0, 0.7), closed(19, 0.0, 0.5)]);
    flow.model(&mesh, &|x| [start(x), start([x[1], x[2], x[0]]), x[0].sin()]).unwrap()
}

/// Flow past a cylinder between walls, in a ring or from an end to the other.
fn flow_past_a_body<T: Compiled>(is_through: bool) -> Fd<T> {
    let (mut ends, mut along) = ([[FlowEnd::REST; 2]; 3], Side::periodic(300, 0.0, 5.0));
    let mut centre = [4.95, 0.46, 0.0];
    if is_through {
        (ends[0], along.spread) = ([FlowEnd::Inflow, FlowEnd::Outflow], Spread::Cells);
        centre[0] = 1.0;
    }
    let shape = Shape::Cylinder { axis: Axis::Z, centre, radius: 0.13 };
    let flow = NavierStokes {
        viscosity: 0.01,
        acceleration: [0.1, 0.0, 0.0],
        ends,
        bodies: vec![shape.into()],
        order: StaggeredOrder::Second,
        integrator: Integrator::Rk4,
        courant: 0.9,
    };
    let mesh = Mesh::new([along, Side::cells(60, 0.0, 1.0)]);
    flow.model(&mesh, &|x| [start(x), start([x[1], x[0], 0.0]), 0.0]).unwrap()
}

#[test]
fn of_flow_past_a_body() {
    for is_through in [false, true] {
        same_bits(|| flow_past_a_body::<f64>(is_through));
        same_bits(|| flow_past_a_body::<f32>(is_through));
    }
}

fn same_bits<T: Compiled>(model: impl Fn() -> Fd<T>) {
    let hash = |settings: Settings| {
        let mut simulation = Simulation::new(model().model, settings).unwrap();
        assert!(simulation.domain().partition().len() > 1, "nothing to hand out");
        simulation.advance(7).unwrap();
        simulation.state_hash()
    };
    let serial = Settings { schedule: Schedule::Serial, workers: 1, ..Settings::default() };
    let expected = hash(serial);
    for schedule in Schedule::ALL {
        for workers in [1, 3] {
            for hand_out in [HandOut::Natural, HandOut::Shuffled { seed: 3 }] {
                let settings = Settings { schedule, workers, hand_out, ..Settings::default() };
                assert_eq!(hash(settings.clone()), expected, "{settings:?}");
            }
        }
    }
}

#[test]
fn of_heat() {
    same_bits(|| heat::<f64>(Order::Second, Integrator::Euler));
    same_bits(|| heat::<f64>(Order::Sixth, Integrator::SspRk3));
    same_bits(|| heat::<f32>(Order::Fourth, Integrator::Rk2));
}

/// In the plane, where a factor is small; of so many rows that there are several tiles.
#[cfg(feature = "implicit")]
fn implicit_heat<T: Compiled>(
    order: Order,
    scheme: finegrain_fd::Implicit,
    side: impl Fn(usize, f64, f64) -> Side,
) -> Fd<T> {
    let (integrator, boundary) = (scheme.into(), brick().1);
    let heat = Heat { diffusivity: 0.2, order, integrator, boundary };
    heat.model(&Mesh::new([side(341, 0.0, 1.0), side(62, 0.0, 0.7)]), 0.1, &start).unwrap()
}

/// The last of a matrix that is not symmetric.
#[cfg(feature = "implicit")]
#[test]
fn of_implicit_heat() {
    use finegrain_fd::Implicit::{BackwardEuler, Bdf2, CrankNicolson};
    same_bits(|| implicit_heat::<f64>(Order::Second, BackwardEuler, Side::ends));
    same_bits(|| implicit_heat::<f64>(Order::Sixth, CrankNicolson, Side::ends));
    same_bits(|| implicit_heat::<f32>(Order::Fourth, Bdf2, Side::ends));
    same_bits(|| implicit_heat::<f64>(Order::Fourth, Bdf2, Side::cells));
    restarts(|| implicit_heat::<f64>(Order::Sixth, BackwardEuler, Side::ends));
    restarts(|| implicit_heat::<f64>(Order::Fourth, CrankNicolson, Side::ends));
    restarts(|| implicit_heat::<f64>(Order::Fourth, Bdf2, Side::cells));
    restarts(|| implicit_heat::<f32>(Order::Second, Bdf2, Side::ends));
}

#[test]
fn of_waves() {
    same_bits(|| wave::<f64>(Order::Fourth));
    same_bits(|| wave::<f32>(Order::Sixth));
}

#[test]
fn of_what_flows() {
    same_bits(advection::<f64>);
    same_bits(gas::<f64>);
    same_bits(gas::<f32>);
    same_bits(|| flow::<f64>(StaggeredOrder::Second, Integrator::Rk4, Side::cells));
    same_bits(|| flow::<f64>(StaggeredOrder::Fourth, Integrator::SspRk3, Side::periodic));
    same_bits(|| flow::<f64>(StaggeredOrder::Fourth, Integrator::Rk4, Side::cells));
    same_bits(|| flow::<f32>(StaggeredOrder::Second, Integrator::Rk2, Side::cells));
}

/// From a checkpoint written in the middle, with fields in either set of columns.
fn restarts<T: Compiled>(model: impl Fn() -> Fd<T>) {
    let folder = tempfile::tempdir().unwrap();
    let start = |settings| Simulation::new(model().model, settings).unwrap();
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

#[test]
fn after_a_restart() {
    restarts(|| heat::<f64>(Order::Second, Integrator::Euler));
    restarts(|| heat::<f64>(Order::Fourth, Integrator::Rk4));
    restarts(|| wave::<f64>(Order::Sixth));
    restarts(advection::<f64>);
    restarts(gas::<f64>);
    restarts(|| flow::<f64>(StaggeredOrder::Second, Integrator::SspRk3, Side::cells));
    restarts(|| flow_past_a_body::<f64>(true));
}
