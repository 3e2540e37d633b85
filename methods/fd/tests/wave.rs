//! The wave equation by leapfrog.

mod solution;

use std::f64::consts::{PI, TAU};

use finegrain_fd::equation::wave::energy;
use finegrain_fd::{Boundary, Condition, Mesh, Order, Side, Wave};
use finegrain_framework::{Settings, Simulation};
use solution::{error, order, run};

/// Steps of at most a fraction of the limit to a time.
fn steps(wave: &Wave, mesh: &Mesh, time: f64, fraction: f64) -> (f64, u64) {
    let steps = (time / (fraction * wave.time_step_limit(mesh).unwrap())).ceil();
    (time / steps, steps as u64)
}

/// A wave that runs askew through a periodic square.
fn running(scheme: Order, n: usize, fraction: f64) -> f64 {
    let wave = Wave { speed: 2.0, order: scheme, boundary: Boundary::all(Condition::Outflow) };
    let mesh = Mesh::new([Side::periodic(n, 0.0, 1.0), Side::periodic(n, 0.0, 1.0)]);
    let phase = |x: [f64; 3], t: f64| TAU * (x[0] + x[1] - 2.0 * 2f64.sqrt() * t);
    let rate = -TAU * 2.0 * 2f64.sqrt();
    let (dt, count) = steps(&wave, &mesh, 0.3, fraction);
    let fd = wave
        .model::<f64>(&mesh, dt, &|x| phase(x, 0.0).sin(), &|x| rate * phase(x, 0.0).cos())
        .unwrap();
    let (simulation, parts) = run(fd, count);
    error(&simulation, &parts, |x, t| phase(x, t).sin())
}

/// With time steps so short that those in space are what is seen.
#[test]
fn every_order_is_what_it_says() {
    for (scheme, n, fraction) in [
        (Order::Second, [24, 48], 0.1),
        (Order::Fourth, [16, 32], 0.02),
        (Order::Sixth, [12, 18], 0.003),
    ] {
        let measured = order(n.map(|n| running(scheme, n, fraction)), n);
        let design = f64::from(scheme.number());
        assert!((measured - design).abs() < 0.1, "order {scheme} is {measured}");
    }
}

/// With time steps that follow the spacing, two and two cancel at the limit in one direction (`c dt = h`):
/// the solution is exact.
#[test]
fn at_the_limit_waves_along_a_line_are_exact() {
    let wave =
        Wave { speed: 1.0, order: Order::Second, boundary: Boundary::all(Condition::Outflow) };
    let mesh = Mesh::new([Side::periodic(20, 0.0, 1.0)]);
    let limit = wave.time_step_limit(&mesh).unwrap();
    assert!((limit - 0.05).abs() < 1e-15, "{limit}");
    // It is exact from a start that is a sum of waves to both sides.
    let fd = wave.model::<f64>(&mesh, limit, &|x| (TAU * x[0]).cos(), &|_| 0.0).unwrap();
    let (simulation, parts) = run(fd, 63);
    let exact = |x: [f64; 3], t: f64| (TAU * x[0]).cos() * (TAU * t).cos();
    let error = error(&simulation, &parts, exact);
    assert!(error < 1e-12, "{error}");
}

/// A membrane that swings for long: with any order, on closed and periodic meshes, the energy changes by
/// round-off alone.
#[test]
fn energy_is_kept_to_round_off() {
    let closed = |n| Side::ends(n, 0.0, 1.0);
    let periodic = |n| Side::periodic(n, 0.0, 1.0);
    for scheme in Order::ALL {
        let mut meshes = vec![Mesh::new([periodic(20), periodic(22)])];
        if scheme != Order::Eighth {
            meshes.push(Mesh::new([closed(21), closed(23)]));
        }
        for mesh in meshes {
            for condition in [Condition::dirichlet(0.0), Condition::neumann(0.0)] {
                let wave = Wave { speed: 1.5, order: scheme, boundary: Boundary::all(condition) };
                let dt = 0.95 * wave.time_step_limit(&mesh).unwrap();
                let bump =
                    |x: [f64; 3]| (-60.0 * ((x[0] - 0.4).powi(2) + (x[1] - 0.6).powi(2))).exp();
                let fd = wave.model::<f64>(&mesh, dt, &bump, &|x| (PI * x[0]).sin()).unwrap();
                let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
                let mut energies = Vec::new();
                for _ in 0..6 {
                    simulation.advance(100).unwrap();
                    simulation.derive().unwrap();
                    energies.push(energy(&mut simulation.whole(), &fd.parts, dt));
                }
                for e in &energies {
                    let drift = (e / energies[0] - 1.0).abs();
                    assert!(drift < 1e-12, "order {scheme}, {energies:?}");
                }
                assert!(energies[0] > 0.1);
            }
        }
    }
}

/// Modes of a string with fixed and with free ends: the largest error at many times, because what is wrong swings,
/// too.
#[test]
fn closures_are_of_their_order() {
    let at = |scheme: Order, intervals: usize, condition: &Condition| {
        let mesh = Mesh::new([Side::ends(intervals + 1, 0.0, 1.0)]);
        let boundary = Boundary::all(condition.clone());
        let wave = Wave { speed: 1.0, order: scheme, boundary };
        let is_free = matches!(condition, Condition::Neumann(_));
        let shape = move |x: f64| if is_free { (3.0 * PI * x).cos() } else { (3.0 * PI * x).sin() };
        let (dt, count) = steps(&wave, &mesh, 0.1, 0.01);
        let fd = wave.model::<f64>(&mesh, dt, &|x| shape(x[0]), &|_| 0.0).unwrap();
        let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
        let mut largest = 0.0f64;
        for _ in 0..20 {
            simulation.advance(count).unwrap();
            let exact = |x: [f64; 3], t: f64| shape(x[0]) * (3.0 * PI * t).cos();
            largest = largest.max(error(&simulation, &fd.parts, exact));
        }
        largest
    };
    for (scheme, n, design) in [
        (Order::Second, [32, 64], 2.0),
        (Order::Fourth, [32, 64], 4.0),
        (Order::Sixth, [32, 64], 5.0),
    ] {
        for condition in [Condition::dirichlet(0.0), Condition::neumann(0.0)] {
            let errors = n.map(|n| at(scheme, n, &condition));
            let measured = order(errors, n);
            assert!(
                measured > design - 0.1,
                "order {scheme}, {condition:?}: {measured} {errors:?}"
            );
        }
    }
}
