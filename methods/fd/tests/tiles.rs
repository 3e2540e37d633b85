//! A problem on long rows, cut into many tiles along y, is the same as with x and y exchanged, cut elsewhere.

mod solution;

use finegrain_fd::{
    Advection, Boundary, Condition, Data, Face, Fd, Gas, GasEnd, GasState, Heat, Mesh, Order, Side,
    Wave,
};
use finegrain_framework::{Domain, Integrator};
use solution::run;

/// Points along x and y, and along z where there is one.
const LONG: usize = 700;
const SHORT: usize = 46;
const DEEP: usize = 9;

fn exchanged([x, y, z]: [f64; 3]) -> [f64; 3] {
    [y, x, z]
}

/// What is given as a function of the position, of the problem and of the exchanged one.
fn start(is_exchanged: bool) -> impl Fn([f64; 3]) -> f64 {
    move |x| {
        let [x, y, z] = if is_exchanged { exchanged(x) } else { x };
        (3.0 * x).sin() + (50.0 * y + 2.0 * z).cos()
    }
}

fn mesh(is_exchanged: bool, is_space: bool, side: fn(usize, f64, f64) -> Side) -> Mesh {
    let [mut x, mut y] = [side(LONG, 0.0, 5.0), side(SHORT, 0.0, 0.4)];
    if is_exchanged {
        (x, y) = (y, x);
    }
    if is_space { Mesh::new([x, y, Side::periodic(DEEP, 0.0, 0.3)]) } else { Mesh::new([x, y]) }
}

/// That both have several tiles along y, and the same first unknown.
fn is_same(model: impl Fn(bool) -> Fd<f64>) {
    let [one, other] = [false, true].map(|is_exchanged| {
        let (simulation, parts) = run(model(is_exchanged), 5);
        let tile = simulation.domain().sub_domain(0).extent();
        let rows = if is_exchanged { LONG } else { SHORT };
        assert!(tile[0].len() < rows, "one tile has all rows");
        simulation.columns().values(parts.unknowns[0]).to_vec()
    });
    let largest = one.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    for (n, u) in one.iter().enumerate() {
        let (x, y, z) = (n % LONG, n / LONG % SHORT, n / (LONG * SHORT));
        let turned = other[y + SHORT * (x + LONG * z)];
        assert!((u - turned).abs() < 1e-12 * largest, "({x}, {y}, {z}): {u} and {turned}");
    }
}

/// Given on the ends of the long direction, a slope elsewhere.
fn conditions(is_exchanged: bool) -> Boundary {
    let mut boundary = Boundary::all(Condition::neumann(0.1));
    let a = usize::from(is_exchanged);
    boundary.0[a][1] = Condition::Dirichlet(Data::varying(move |x, t| (x[1 - a] + t).sin()));
    boundary
}

/// The eighth has no formulas for ends.
fn orders(is_periodic: bool) -> impl Iterator<Item = Order> {
    Order::ALL.into_iter().filter(move |&order| is_periodic || order != Order::Eighth)
}

#[test]
fn of_heat() {
    for (is_space, side) in [(false, Side::ends as fn(_, _, _) -> _), (true, Side::periodic)] {
        for order in orders(is_space) {
            is_same(|is_exchanged| {
                let boundary = conditions(is_exchanged);
                let integrator = Integrator::Euler.into();
                let heat = Heat { diffusivity: 0.2, order, integrator, boundary };
                let mesh = mesh(is_exchanged, is_space, side);
                let dt = 0.5 * heat.time_step_limit(&mesh).unwrap();
                heat.model(&mesh, dt, &start(is_exchanged)).unwrap()
            });
        }
    }
}

#[test]
fn of_waves() {
    for (is_space, side) in [(true, Side::ends as fn(_, _, _) -> _), (false, Side::periodic)] {
        for order in orders(!is_space) {
            is_same(|is_exchanged| {
                let wave = Wave { speed: 0.2, order, boundary: conditions(is_exchanged) };
                let mesh = mesh(is_exchanged, is_space, side);
                let dt = 0.5 * wave.time_step_limit(&mesh).unwrap();
                wave.model(&mesh, dt, &start(is_exchanged), &start(is_exchanged)).unwrap()
            });
        }
    }
}

#[test]
fn of_what_flows() {
    for is_space in [false, true] {
        is_same(|is_exchanged| {
            let boundary = Boundary::all(Condition::Outflow);
            let (face, integrator) = (Face::Weno5Z, Integrator::SspRk3);
            let advection = Advection { face, integrator, boundary };
            let velocity = |x: [f64; 3]| {
                let [x, y, _] = if is_exchanged { exchanged(x) } else { x };
                let velocity = [1.0 + y, 0.5 * x - 1.0, 0.3];
                if is_exchanged { exchanged(velocity) } else { velocity }
            };
            let mesh = mesh(is_exchanged, is_space, Side::cells);
            advection.model(&mesh, 1e-3, &velocity, &start(is_exchanged)).unwrap()
        });
    }
    is_same(|is_exchanged| {
        let mut ends = [[GasEnd::Open, GasEnd::Wall], [GasEnd::Wall, GasEnd::Open]];
        if is_exchanged {
            ends.swap(0, 1);
        }
        let gas = Gas { heat_ratio: 1.4, courant: 0.45, ends };
        let state = |x: [f64; 3]| {
            let [x, y, z] = if is_exchanged { exchanged(x) } else { x };
            let velocity = if is_exchanged { [-0.2, 0.1, z] } else { [0.1, -0.2, z] };
            let pressure = if x + 0.5 * y < 2.0 { 100.0 } else { 0.1 };
            GasState { density: 1.0 + 0.2 * y, velocity, pressure }
        };
        gas.model(&mesh(is_exchanged, false, Side::cells), &state).unwrap()
    });
}
