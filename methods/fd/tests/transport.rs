//! Advection and Burgers' equation.

mod solution;

use std::f64::consts::TAU;

use finegrain_fd::{Advection, Boundary, Burgers, Condition, Data, Face, Mesh, Side, measure};
use finegrain_framework::{Integrator, Settings, Simulation};
use solution::{error, order, run};

fn advection(face: Face, integrator: Integrator, condition: Condition) -> Advection {
    Advection { face, integrator, boundary: Boundary::all(condition) }
}

/// A wave carried askew through a periodic square, `n` points long, with time steps too short to be seen.
fn carried(face: Face, n: usize) -> f64 {
    let velocity = [0.7, -0.4, 0.0];
    let scheme = advection(face, Integrator::Rk4, Condition::Outflow);
    let mesh = Mesh::new([Side::periodic(n, 0.0, 1.0), Side::periodic(n, 0.0, 1.0)]);
    let exact =
        move |x: [f64; 3], t: f64| (TAU * (x[0] - 0.7 * t)).sin() + (TAU * (x[1] + 0.4 * t)).cos();
    let limit = 0.3 * scheme.time_step_limit(&mesh, velocity).unwrap();
    let count = (0.5 / limit).ceil();
    let fd = scheme.model::<f64>(&mesh, 0.5 / count, &|_| velocity, &|x| exact(x, 0.0)).unwrap();
    let (simulation, parts) = run(fd, count as u64);
    error(&simulation, &parts, exact)
}

#[test]
fn faces_are_of_their_order() {
    for (face, n) in [
        (Face::Upwind1, [100, 150]),
        (Face::Upwind3, [32, 64]),
        (Face::Weno5, [32, 64]),
        (Face::Weno5Z, [32, 64]),
    ] {
        let measured = order(n.map(|n| carried(face, n)), n);
        let design = f64::from(face.order());
        assert!((measured - design).abs() < 0.1, "{} is of order {measured}", face.name());
    }
}

/// In at one end, out at the other: what is inside in the end is what came in. Ghost points on a straight line
/// through the value given let the order fall to one and a half, whatever it is inside.
#[test]
fn what_flows_in_flows_through_and_out() {
    let wave = |s: f64| (3.0 * s).sin() + 0.5;
    let at = |face: Face, n: usize| {
        let mut scheme = advection(face, Integrator::SspRk3, Condition::Outflow);
        scheme.boundary.0[0][0] = Condition::Dirichlet(Data::varying(move |x, t| wave(x[0] - t)));
        let mesh = Mesh::new([Side::cells(n, 0.0, 1.0)]);
        let count = 4 * n;
        let fd = scheme
            .model::<f64>(&mesh, 2.0 / count as f64, &|_| [1.0, 0.0, 0.0], &|x| wave(x[0]))
            .unwrap();
        let (simulation, parts) = run(fd, count as u64);
        error(&simulation, &parts, |x, t| wave(x[0] - t))
    };
    for face in [Face::Upwind3, Face::Weno5Z] {
        let measured = order([40, 80].map(|n| at(face, n)), [40, 80]);
        assert!((measured - 1.5).abs() < 0.1, "{} is of order {measured}", face.name());
        assert!(at(face, 80) < 3e-3);
    }
}

/// Mass is kept to round-off, and WENO makes no new extrema of a step worth mentioning.
#[test]
fn a_step_stays_one() {
    for (face, over) in [(Face::Upwind1, 1e-12), (Face::Weno5, 2e-3), (Face::Weno5Z, 2e-3)] {
        let scheme = advection(face, Integrator::SspRk3, Condition::Outflow);
        let mesh = Mesh::new([Side::periodic(64, 0.0, 1.0), Side::periodic(16, 0.0, 0.25)]);
        let velocity = [1.0, 0.5, 0.0];
        let dt = 0.6 * scheme.time_step_limit(&mesh, velocity).unwrap();
        let step = |x: [f64; 3]| if (0.2..0.6).contains(&x[0]) { 1.0 } else { 0.0 };
        let fd = scheme.model::<f64>(&mesh, dt, &|_| velocity, &step).unwrap();
        let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
        let field = fd.parts.unknowns[0];
        let before = measure::totals(&mut simulation.whole(), &fd.parts, field);
        simulation.advance(200).unwrap();
        let after = measure::totals(&mut simulation.whole(), &fd.parts, field);
        assert!((after.integral / before.integral - 1.0).abs() < 1e-13, "{after:?}");
        assert!(after.least > -over && after.most < 1.0 + over, "{}: {after:?}", face.name());
    }
}

/// Up to the limit nothing grows; a fifth past it the shortest waves do. Such a step is refused, so the flow
/// is made faster after the model has been built.
#[test]
fn the_limit_is_where_growth_begins() {
    let unstable = |face: Face, integrator: Integrator, factor: f64| {
        let scheme = advection(face, integrator, Condition::Outflow);
        let mesh = Mesh::new([Side::periodic(64, 0.0, 1.0)]);
        let limit = scheme.time_step_limit(&mesh, [1.0, 0.0, 0.0]).unwrap();
        let fd = scheme
            .model::<f64>(&mesh, limit / 2.0, &|_| [1.0, 0.0, 0.0], &|x| (1e3 * x[0].sin()).sin())
            .unwrap();
        let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
        let velocity = simulation.columns().find_state::<f64>("velocity_x").unwrap();
        let whole = simulation.whole();
        whole.columns.values_mut(velocity).fill(2.0 * factor);
        simulation.advance(400).is_err() || {
            let field = fd.parts.unknowns[0];
            measure::totals(&mut simulation.whole(), &fd.parts, field).most > 2.0
        }
    };
    for (face, integrator) in [
        (Face::Upwind1, Integrator::Euler),
        (Face::Upwind1, Integrator::Rk4),
        (Face::Upwind3, Integrator::SspRk3),
        (Face::Upwind3, Integrator::Rk4),
    ] {
        assert!(!unstable(face, integrator, 0.99), "{} {}", face.name(), integrator.name());
        assert!(unstable(face, integrator, 1.2), "{} {}", face.name(), integrator.name());
    }
}

/// Against the Cole-Hopf solution, rows of `08_burgers_basdevant.csv` at t = 0.25: (x, u).
#[test]
fn burgers_equation_follows_the_reference() {
    const ROWS: [(f64, f64); 5] = [
        (0.015, -0.187455267223),
        (0.055, -0.568055624596),
        (0.095, -0.776724849721),
        (0.35, -0.955137018513),
        (0.75, -0.430516264182),
    ];
    let burgers = Burgers {
        viscosity: 0.01 / std::f64::consts::PI,
        face: Face::Weno5Z,
        integrator: Integrator::SspRk3,
        boundary: Boundary::all(Condition::dirichlet(0.0)),
    };
    let n = 401;
    let mesh = Mesh::new([Side::cells(n, -1.0, 1.0)]);
    let limit = 0.9 * burgers.time_step_limit(&mesh, 1.0).unwrap();
    let count = (0.25 / limit).ceil();
    let fd = burgers
        .model::<f64>(&mesh, 0.25 / count, &|x| -(std::f64::consts::PI * x[0]).sin())
        .unwrap();
    let (simulation, parts) = run(fd, count as u64);
    let u = simulation.columns().values(parts.unknowns[0]);
    let h = 2.0 / n as f64;
    for (x, expected) in ROWS {
        // By a cubic through the four points around.
        let place = (x + 1.0) / h - 0.5;
        let i = place.floor();
        let s = place - i;
        let p = |k: isize| u[(i as isize + k) as usize];
        let value = -s * (s - 1.0) * (s - 2.0) / 6.0 * p(-1)
            + (s + 1.0) * (s - 1.0) * (s - 2.0) / 2.0 * p(0)
            - (s + 1.0) * s * (s - 2.0) / 2.0 * p(1)
            + (s + 1.0) * s * (s - 1.0) / 6.0 * p(2);
        assert!((value - expected).abs() < 2e-5, "{value} for {expected} at {x}");
    }
}
