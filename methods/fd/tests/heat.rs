//! The heat equation against exact solutions.

mod solution;

use std::f64::consts::TAU;

use finegrain_fd::measure::totals;
use finegrain_fd::{Boundary, Condition, Data, Heat, Mesh, Order, Side};
use finegrain_framework::{Integrator, Settings, Simulation};
use solution::{error, order, run};

fn heat(order: Order, boundary: Boundary) -> Heat {
    Heat { diffusivity: 0.3, order, integrator: Integrator::Rk4.into(), boundary }
}

/// A time step of at most `most` of the limit that divides `time`, and how often.
fn steps(heat: &Heat, mesh: &Mesh, time: f64, most: f64) -> (f64, u64) {
    let limit = most * heat.time_step_limit(mesh).unwrap();
    let steps = (time / limit).ceil();
    (time / steps, steps as u64)
}

/// Waves in a periodic box of 1, 2 and 3 directions.
fn periodic_error<const D: usize>(order: Order, n: usize) -> f64 {
    let heat = heat(order, Boundary::all(Condition::Outflow));
    let mesh = Mesh::new([Side::periodic(n, 0.0, 1.0); D]);
    let exact = move |x: [f64; 3], t: f64| {
        let waves: f64 = (0..D).map(|a| (TAU * (x[a] + 0.1 * a as f64)).sin()).product();
        waves * (-0.3 * D as f64 * TAU * TAU * t).exp()
    };
    let (dt, steps) = steps(&heat, &mesh, 0.05, 0.5);
    let fd = heat.model::<f64>(&mesh, dt, &|x| exact(x, 0.0)).unwrap();
    let (simulation, parts) = run(fd, steps);
    error(&simulation, &parts, exact)
}

#[test]
fn every_order_is_what_it_says_in_a_periodic_box() {
    for (scheme, n) in Order::ALL.into_iter().zip([[32, 64], [16, 32], [16, 32], [12, 24]]) {
        let design = f64::from(scheme.number());
        let plane = order(n.map(|n| periodic_error::<2>(scheme, n)), n);
        assert!((plane - design).abs() < 0.1, "order {scheme} in 2-D is {plane}");
    }
    let line = order([40, 80].map(|n| periodic_error::<1>(Order::Second, n)), [40, 80]);
    assert!((line - 2.0).abs() < 0.1, "{line}");
    let space = order([10, 20].map(|n| periodic_error::<3>(Order::Fourth, n)), [10, 20]);
    assert!((space - 4.0).abs() < 0.15, "{space}");
}

/// A solution that is not periodic, `exp(0.45 t + x + y / 2) + ...`, with all of its conditions varying.
fn closed_error(order: Order, intervals: usize, condition: &str) -> f64 {
    let rate = 0.3 * (1.0 - 0.25 * 9.0);
    let exact = move |x: [f64; 3], t: f64| {
        let growing = (0.3 * 1.25 * t + x[0] + 0.5 * x[1]).exp();
        growing + (rate * t).exp() * x[0].exp() * (1.5 * x[1]).cos()
    };
    let slope = move |x: [f64; 3], t: f64, a: usize| {
        let growing = (0.3 * 1.25 * t + x[0] + 0.5 * x[1]).exp();
        let wave = (rate * t).exp() * x[0].exp();
        match a {
            0 => growing + wave * (1.5 * x[1]).cos(),
            _ => 0.5 * growing - 1.5 * wave * (1.5 * x[1]).sin(),
        }
    };
    let end = |a: usize, outwards: f64| match condition {
        "dirichlet" => Condition::Dirichlet(Data::varying(exact)),
        "neumann" => Condition::Neumann(Data::varying(move |x, t| outwards * slope(x, t, a))),
        _ => {
            let sum = move |x, t| 2.0 * exact(x, t) + 0.7 * outwards * slope(x, t, a);
            Condition::robin(2.0, 0.7, Data::varying(sum))
        }
    };
    let boundary = Boundary([0, 1, 2].map(|a| [end(a, -1.0), end(a, 1.0)]));
    let heat = heat(order, boundary);
    let mesh =
        Mesh::new([Side::ends(intervals + 1, -0.3, 0.9), Side::ends(intervals + 1, 0.1, 1.1)]);
    let (dt, steps) = steps(&heat, &mesh, 0.4, 0.9);
    let fd = heat.model::<f64>(&mesh, dt, &|x| exact(x, 0.0)).unwrap();
    let (simulation, parts) = run(fd, steps);
    error(&simulation, &parts, exact)
}

/// At least: where the error is still that of the boundary it falls half an order faster.
#[test]
fn closures_are_of_their_order_with_every_condition() {
    for (scheme, n, design) in [
        (Order::Second, [24, 48], 2.0),
        (Order::Fourth, [20, 40], 4.0),
        (Order::Sixth, [16, 32], 5.0),
    ] {
        for condition in ["dirichlet", "neumann", "robin"] {
            let errors = n.map(|n| closed_error(scheme, n, condition));
            let measured = order(errors, n);
            assert!(measured > design - 0.1, "order {scheme}, {condition}: {measured}, {errors:?}");
        }
    }
}

/// Heat that cannot leave stays: the weights of the norm are a quadrature.
#[test]
fn insulated_heat_is_kept_to_round_off() {
    for scheme in [Order::Second, Order::Fourth, Order::Sixth] {
        let heat = heat(scheme, Boundary::all(Condition::neumann(0.0)));
        let mesh = Mesh::new([Side::ends(25, 0.0, 1.0), Side::ends(18, -1.0, 1.0)]);
        let dt = 0.9 * heat.time_step_limit(&mesh).unwrap();
        let start = |x: [f64; 3]| (3.0 * x[0] - x[1] * x[1]).exp();
        let fd = heat.model::<f64>(&mesh, dt, &start).unwrap();
        let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
        let field = fd.parts.unknowns[0];
        let before = totals(&mut simulation.whole(), &fd.parts, field);
        simulation.advance(300).unwrap();
        let after = totals(&mut simulation.whole(), &fd.parts, field);
        assert!((after.integral / before.integral - 1.0).abs() < 1e-13, "{before:?} {after:?}");
        assert!(after.most < 0.99 * before.most, "{before:?} {after:?}");
    }
}

/// At the limit of every integrator the roughest start does not grow; a little beyond it is refused.
#[test]
fn nothing_grows_at_the_limit() {
    let closed = Side::ends(21, 0.0, 1.0);
    let sides = [Side::periodic(20, 0.0, 1.0), Side::cells(20, 0.0, 1.0), closed];
    for (side, scheme) in sides.into_iter().zip([Order::Eighth, Order::Second, Order::Fourth]) {
        let integrators = [Integrator::Euler, Integrator::Rk2, Integrator::SspRk3, Integrator::Rk4];
        for integrator in integrators {
            let boundary = Boundary::all(Condition::dirichlet(0.0));
            let heat = Heat { integrator: integrator.into(), ..heat(scheme, boundary) };
            let mesh = Mesh::new([side]);
            let limit = heat.time_step_limit(&mesh).unwrap();
            let rough = |x: [f64; 3]| (1e4 * x[0] + 1e3 * x[0] * x[0]).sin();
            let fd = heat.model::<f64>(&mesh, limit, &rough).unwrap();
            let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
            simulation.advance(2000).unwrap();
            let square = totals(&mut simulation.whole(), &fd.parts, fd.parts.unknowns[0]).square;
            assert!(square < 1.0, "{} of order {scheme}", integrator.name());
            assert!(heat.model::<f64>(&mesh, 1.001 * limit, &rough).is_err());
        }
    }
}
