//! Advection by central differences against what should come out.

mod solution;

use std::f64::consts::TAU;

use finegrain_fd::{Boundary, Condition, Data, Drift, Mesh, Order, Side, measure};
use finegrain_framework::{Integrator, Settings, Simulation};
use solution::{error, order, run};

const VELOCITY: [f64; 3] = [0.7, -0.4, 0.0];

fn exact(x: [f64; 3], t: f64) -> f64 {
    (TAU * (x[0] - VELOCITY[0] * t)).sin() + (TAU * (x[1] - VELOCITY[1] * t)).cos()
}

/// A wave carried askew through a square, for so short a time step that it is not seen.
fn carried(scheme: Order, side: impl Fn(usize) -> Side, n: usize) -> f64 {
    let mut boundary = Boundary::all(Condition::Outflow);
    // In at the left and at the top.
    boundary.0[0][0] = Condition::Dirichlet(Data::varying(exact));
    boundary.0[1][1] = Condition::Dirichlet(Data::varying(exact));
    let drift = Drift { velocity: VELOCITY, order: scheme, integrator: Integrator::Rk4, boundary };
    let mesh = Mesh::new([side(n), side(n)]);
    let steps = (0.7 / (0.2 * drift.time_step_limit(&mesh).unwrap())).ceil();
    let fd = drift.model::<f64>(&mesh, 0.7 / steps, &|x| exact(x, 0.0)).unwrap();
    let (simulation, parts) = run(fd, steps as u64);
    error(&simulation, &parts, exact)
}

#[test]
fn every_order_is_what_it_says_in_a_periodic_box() {
    for (scheme, n) in
        [(Order::Second, [32, 64]), (Order::Fourth, [16, 32]), (Order::Sixth, [16, 32])]
    {
        let measured = order(n.map(|n| carried(scheme, |n| Side::periodic(n, 0.0, 1.0), n)), n);
        let design = f64::from(scheme.number());
        assert!((measured - design).abs() < 0.1, "order {scheme} is {measured}");
    }
}

/// Closures of order p make a solution of order p + 1; at least, because inside it is better.
#[test]
fn closures_are_of_their_order() {
    for (scheme, n, design) in [
        (Order::Second, [32, 64], 2.0),
        (Order::Fourth, [32, 64], 3.0),
        (Order::Sixth, [48, 96], 4.0),
    ] {
        let errors = n.map(|n| carried(scheme, |n| Side::ends(n + 1, 0.0, 1.0), n));
        let measured = order(errors, n);
        assert!(measured > design - 0.1, "order {scheme} is {measured}: {errors:?}");
    }
}

/// What comes in is zero: the energy in the norm of the closure falls, and at the limit of the time step
/// nothing grows.
#[test]
fn what_is_inside_flows_out_and_nothing_grows() {
    for scheme in [Order::Second, Order::Fourth, Order::Sixth] {
        for integrator in [Integrator::SspRk3, Integrator::Rk4] {
            let mut boundary = Boundary::all(Condition::Outflow);
            boundary.0[0][0] = Condition::dirichlet(0.0);
            let velocity = [1.0, 0.0, 0.0];
            let drift = Drift { velocity, order: scheme, integrator, boundary };
            let mesh = Mesh::new([Side::ends(41, 0.0, 1.0)]);
            let dt = drift.time_step_limit(&mesh).unwrap();
            let rough = |x: [f64; 3]| (1e4 * x[0] + 1e3 * x[0] * x[0]).sin();
            let fd = drift.model::<f64>(&mesh, dt, &rough).unwrap();
            let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
            let mut last = f64::INFINITY;
            for _ in 0..200 {
                let field = fd.parts.unknowns[0];
                let square = measure::totals(&mut simulation.whole(), &fd.parts, field).square;
                assert!(square <= last * (1.0 + 1e-12), "order {scheme}: {square} after {last}");
                last = square;
                simulation.advance(10).unwrap();
            }
            assert!(last < 1e-6, "order {scheme}: {last}");
        }
    }
}
