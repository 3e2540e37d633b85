//! Implicit steps: by the equations that define them, against exact solutions, and far past explicit limits.
#![cfg(feature = "implicit")]

mod solution;

use std::f64::consts::PI;

use finegrain_fd::measure::totals;
use finegrain_fd::{Boundary, Condition, Data, Fd, Heat, Implicit, Mesh, Order, Side};
use finegrain_framework::{Integrator, Settings, Simulation};
use solution::{error, order, run};

const DIFFUSIVITY: f64 = 0.3;

fn heat(order: Order, scheme: Implicit, boundary: Boundary) -> Heat {
    Heat { diffusivity: DIFFUSIVITY, order, integrator: scheme.into(), boundary }
}

/// The longest time step of Euler's method.
fn explicit_limit(heat: &Heat, mesh: &Mesh) -> f64 {
    Heat { integrator: Integrator::Euler.into(), ..heat.clone() }.time_step_limit(mesh).unwrap()
}

/// All conditions, that vary in space and in the time since `t0`.
fn conditions(t0: f64) -> Boundary {
    let lower = Condition::Neumann(Data::varying(move |x, t| (x[1] + 3.0 * x[2] + t0 + t).sin()));
    let upper = Condition::Dirichlet(Data::varying(move |x, t| (2.0 * x[1] - x[2] + t0 + t).cos()));
    let front = Data::varying(move |x, t| (x[0] + x[2] - t0 - t).cos());
    let back = Condition::Dirichlet(Data::varying(move |x, t| (x[0] * (t0 + t)).sin()));
    let (front, above) = (Condition::robin(1.5, 0.2, front), Condition::robin(1.0, 0.05, 0.4));
    Boundary([[lower, upper], [front, back], [Condition::neumann(-0.3), above]])
}

/// The rate of change of a temperature as the explicit stage evaluates it.
fn rate(heat: &Heat, mesh: &Mesh, time: f64, temperature: &[f64]) -> Vec<f64> {
    let (boundary, integrator) = (conditions(time), Integrator::Euler.into());
    let heat = Heat { integrator, boundary, ..heat.clone() };
    let dt = heat.time_step_limit(mesh).unwrap();
    let Fd { model, parts } = heat.model::<f64>(mesh, dt, &|_| 0.0).unwrap();
    let mut simulation = Simulation::new(model, Settings::default()).unwrap();
    simulation.whole().columns.values_mut(parts.unknowns[0]).copy_from_slice(temperature);
    simulation.advance(1).unwrap();
    let next = simulation.columns().values(parts.unknowns[0]);
    next.iter().zip(temperature).map(|(next, u)| (next - u) / dt).collect()
}

/// Whatever lies at the ends, steps fulfil the equations that define them, with the rates of explicit steps.
#[test]
fn steps_fulfil_their_equations() {
    let (periodic, ends, cells) = (Side::periodic, Side::ends, Side::cells);
    let mut cases = vec![
        (Order::Second, Mesh::new([cells(14, 0.0, 1.0), ends(9, 0.0, 0.7), cells(7, 0.0, 0.5)])),
        (Order::Eighth, Mesh::new([periodic(17, 0.0, 1.0), cells(12, 0.0, 0.7)])),
    ];
    for scheme in [Order::Second, Order::Fourth, Order::Sixth] {
        cases.push((scheme, Mesh::new([ends(19, 0.0, 1.0)])));
        let sides = [ends(17, 0.0, 1.0), ends(15, 0.0, 0.7), periodic(11, 0.0, 0.5)];
        cases.push((scheme, Mesh::new(sides)));
        cases.push((scheme, Mesh::new([cells(16, 0.0, 1.0), cells(11, 0.0, 0.7)])));
    }
    for (scheme, (order, mesh)) in
        Implicit::ALL.into_iter().flat_map(|scheme| cases.iter().map(move |case| (scheme, case)))
    {
        let heat = heat(*order, scheme, conditions(0.0));
        let dt = 1000.0 * explicit_limit(&heat, mesh);
        let start = |x: [f64; 3]| (3.0 * x[0]).sin() + (5.0 * x[1] * x[2]).cos();
        let Fd { model, parts } = heat.model::<f64>(mesh, dt, &start).unwrap();
        let mut simulation = Simulation::new(model, Settings::default()).unwrap();
        let mut last: Option<Vec<f64>> = None;
        for n in 0..3 {
            let before = simulation.columns().values(parts.unknowns[0]).to_vec();
            simulation.advance(1).unwrap();
            let now = simulation.columns().values(parts.unknowns[0]).to_vec();
            let rate = |at: usize, u: &[f64]| rate(&heat, mesh, at as f64 * dt, u);
            let (early, late) = (rate(n, &before), rate(n + 1, &now));
            for i in 0..now.len() {
                let change = match (scheme, &last) {
                    (Implicit::CrankNicolson, _) => 0.5 * dt * (early[i] + late[i]),
                    (Implicit::Bdf2, Some(last)) => {
                        (before[i] - last[i]) / 3.0 + 2.0 / 3.0 * dt * late[i]
                    }
                    _ => dt * late[i],
                };
                let left = now[i] - before[i] - change;
                let case = format!("{} of order {order} on {:?}", scheme.name(), mesh.sides());
                assert!(left.abs() < 1e-10, "step {n}, point {i}: {left:e} is left of {case}");
            }
            last = Some(before);
        }
    }
}

/// What a step makes of `u' = -k u` with `k dt = z`, `n` times, from 1.
fn amplitude(scheme: Implicit, z: f64, n: usize) -> f64 {
    let euler = 1.0 / (1.0 + z);
    let (mut last, mut now) = (1.0, if n == 0 { 1.0 } else { euler });
    match scheme {
        Implicit::BackwardEuler => euler.powi(n as i32),
        Implicit::CrankNicolson => ((1.0 - z / 2.0) / (1.0 + z / 2.0)).powi(n as i32),
        Implicit::Bdf2 => {
            for _ in 1..n {
                (last, now) = (now, (4.0 * now - last) / (3.0 + 2.0 * z));
            }
            now
        }
    }
}

/// The shortest wave of a periodic box, its rate of decay `4 kappa / h^2` in every direction, and the time step.
fn shortest_wave(scheme: Implicit, times_limit: f64) -> (Fd<f64>, f64, f64) {
    let heat = heat(Order::Second, scheme, Boundary::all(Condition::Outflow));
    let mesh = Mesh::new([Side::periodic(12, 0.0, 1.0), Side::periodic(16, 0.0, 1.0)]);
    let dt = times_limit * explicit_limit(&heat, &mesh);
    let wave = |x: [f64; 3]| (12.0 * PI * x[0]).cos() * (16.0 * PI * x[1]).cos();
    let decay = 4.0 * DIFFUSIVITY * (144.0 + 256.0);
    (heat.model(&mesh, dt, &wave).unwrap(), decay, dt)
}

/// A thousand times past the explicit limit. That wave is the stiffest: backward Euler divides it by 2001, and
/// Crank-Nicolson changes its sign and hardly anything else.
#[test]
fn waves_are_damped_as_theory_says() {
    for scheme in Implicit::ALL {
        for times_limit in [0.3, 1.0, 1000.0] {
            let (Fd { model, parts }, decay, dt) = shortest_wave(scheme, times_limit);
            let mut simulation = Simulation::new(model, Settings::default()).unwrap();
            for n in 0..6 {
                let found = simulation.columns().values(parts.unknowns[0])[0];
                let expected = amplitude(scheme, decay * dt, n);
                let case = format!("{} at {times_limit}, step {n}", scheme.name());
                assert!((found - expected).abs() < 1e-12, "{case}: {found} for {expected}");
                simulation.advance(1).unwrap();
            }
        }
    }
}

/// Steps that are made shorter to hit an end have a factor of their own; BDF2 is not made shorter.
#[test]
fn an_end_is_hit_with_the_right_matrix() {
    for scheme in Implicit::ALL {
        let (Fd { model, parts }, decay, dt) = shortest_wave(scheme, 0.5);
        let z = decay * dt;
        let mut simulation = Simulation::new(model, Settings::default()).unwrap();
        simulation.advance(2).unwrap();
        simulation.end_at(2.25 * dt);
        simulation.advance(1).unwrap();
        let found = simulation.columns().values(parts.unknowns[0])[0];
        let (time, expected) = match scheme {
            Implicit::Bdf2 => (3.0, amplitude(scheme, z, 3)),
            _ => (2.25, amplitude(scheme, z, 2) * amplitude(scheme, 0.25 * z, 1)),
        };
        assert!((simulation.clock().time() / dt - time).abs() < 1e-12, "{}", scheme.name());
        assert!((found - expected).abs() < 1e-14, "{}: {found} for {expected}", scheme.name());
    }
}

/// Stokes' layer, `exp(-b s) cos(w t - b s)` with `b^2 = w / 2 kappa` along an oblique direction: temperatures, fluxes
/// and sums of both that vary in time at the four ends.
fn stokes_layer_error(scheme: Implicit, steps: u64) -> (f64, f64) {
    const FREQUENCY: f64 = PI;
    let b = (FREQUENCY / (2.0 * DIFFUSIVITY)).sqrt();
    let direction = [0.8, 0.6];
    let phase = move |x: [f64; 3]| b * (direction[0] * x[0] + direction[1] * x[1]);
    let exact = move |x: [f64; 3], t: f64| (-phase(x)).exp() * (FREQUENCY * t - phase(x)).cos();
    let slope = move |x: [f64; 3], t: f64, a: usize| {
        let turn = FREQUENCY * t - phase(x);
        b * direction[a] * (-phase(x)).exp() * (turn.sin() - turn.cos())
    };
    let sum = move |x, t| 2.0 * exact(x, t) + 0.7 * slope(x, t, 1);
    let boundary = Boundary([
        [Condition::Dirichlet(Data::varying(exact)), Condition::Dirichlet(Data::varying(exact))],
        [
            Condition::Neumann(Data::varying(move |x, t| -slope(x, t, 1))),
            Condition::robin(2.0, 0.7, Data::varying(sum)),
        ],
        [Condition::Outflow, Condition::Outflow],
    ]);
    let heat = heat(Order::Sixth, scheme, boundary);
    let mesh = Mesh::new([Side::ends(111, 0.0, 1.0), Side::ends(41, 0.0, 0.5)]);
    let dt = 1.0 / steps as f64;
    let times_limit = dt / explicit_limit(&heat, &mesh);
    let fd = heat.model::<f64>(&mesh, dt, &|x| exact(x, 0.0)).unwrap();
    let (simulation, parts) = run(fd, steps);
    (error(&simulation, &parts, exact), times_limit)
}

#[test]
fn orders_are_what_they_say_a_thousand_times_past_the_explicit_limit() {
    for scheme in Implicit::ALL {
        let steps = [24, 48];
        let [coarse, fine] = steps.map(|n| stokes_layer_error(scheme, n));
        assert!(fine.1 > 1000.0, "{} times the explicit limit", fine.1);
        let measured = order([coarse.0, fine.0], steps.map(|n| n as usize));
        let (name, design) = (scheme.name(), f64::from(scheme.order()));
        assert!((measured - design).abs() < 0.1, "{name}: {measured}, {coarse:?} {fine:?}");
    }
}

/// The roughest start, with every condition: what is left after 20 steps of what a million times the explicit limit
/// makes stiff.
#[test]
fn nothing_grows_and_only_crank_nicolson_rings() {
    for scheme in Implicit::ALL {
        let mut boundary = conditions(0.0);
        for condition in boundary.0.iter_mut().flatten() {
            *condition = match *condition {
                Condition::Robin { value, slope, .. } => Condition::robin(value, slope, 0.0),
                _ => Condition::dirichlet(0.0),
            };
        }
        let heat = heat(Order::Fourth, scheme, boundary);
        let mesh = Mesh::new([Side::ends(21, 0.0, 1.0), Side::ends(22, 0.0, 1.0)]);
        let rough = |x: [f64; 3]| (1e4 * x[0] + 1e3 * x[0] * x[0] + 3e3 * x[1]).sin();
        let dt = 1e6 * explicit_limit(&heat, &mesh);
        let Fd { model, parts } = heat.model::<f64>(&mesh, dt, &rough).unwrap();
        let mut simulation = Simulation::new(model, Settings::default()).unwrap();
        let mut square = |steps| {
            simulation.advance(steps).unwrap();
            totals(&mut simulation.whole(), &parts, parts.unknowns[0]).square
        };
        let first = square(0);
        let mut before = first;
        for n in 0..20 {
            let now = square(1);
            assert!(now <= before * (1.0 + 1e-12), "{}, step {n}: {before} {now}", scheme.name());
            before = now;
        }
        let is_left = before > 0.9 * first;
        assert!(is_left || before < 1e-20 * first, "{}: {first} {before}", scheme.name());
        assert_eq!(is_left, scheme == Implicit::CrankNicolson);
    }
}

/// Heat that cannot leave stays, whatever the step.
#[test]
fn insulated_heat_is_kept_to_round_off() {
    for scheme in Implicit::ALL {
        for order in [Order::Second, Order::Fourth, Order::Sixth] {
            let heat = heat(order, scheme, Boundary::all(Condition::neumann(0.0)));
            let mesh = Mesh::new([Side::ends(25, 0.0, 1.0), Side::ends(18, -1.0, 1.0)]);
            let dt = 200.0 * explicit_limit(&heat, &mesh);
            let start = |x: [f64; 3]| (3.0 * x[0] - x[1] * x[1]).exp();
            let fd = heat.model::<f64>(&mesh, dt, &start).unwrap();
            let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
            let field = fd.parts.unknowns[0];
            let before = totals(&mut simulation.whole(), &fd.parts, field);
            simulation.advance(30).unwrap();
            let after = totals(&mut simulation.whole(), &fd.parts, field);
            assert!((after.integral / before.integral - 1.0).abs() < 1e-12, "{before:?} {after:?}");
            assert!(after.most < 0.99 * before.most, "{before:?} {after:?}");
        }
    }
}

/// The factor is in `f64` whatever the unknown is in.
#[test]
fn single_precision_comes_to_the_same_but_for_its_rounding() {
    let heat = heat(Order::Fourth, Implicit::Bdf2, conditions(0.0));
    let mesh = Mesh::new([Side::ends(25, 0.0, 1.0), Side::ends(18, 0.0, 1.0)]);
    let dt = 100.0 * explicit_limit(&heat, &mesh);
    let start = |x: [f64; 3]| (3.0 * x[0]).sin() * x[1];
    let (double, parts) = run(heat.model::<f64>(&mesh, dt, &start).unwrap(), 20);
    let (single, of_single) = run(heat.model::<f32>(&mesh, dt, &start).unwrap(), 20);
    let double = double.columns().values(parts.unknowns[0]);
    let single = single.columns().values(of_single.unknowns[0]);
    let off =
        double.iter().zip(single).map(|(&a, &b)| (a - f64::from(b)).abs()).fold(0.0, f64::max);
    assert!(off > 0.0 && off < 1e-4, "{off:e}");
}
