//! Incompressible flow against exact solutions, and what it keeps.

mod solution;

use std::f64::consts::TAU;

use finegrain_fd::{
    Compiled, Fd, FlowEnd, Mesh, NavierStokes, Parts, Side, StaggeredOrder, measure,
};
use finegrain_framework::space::Grid;
use finegrain_framework::{Integrator, Schedule, Settings, Simulation};
use solution::order;

fn flow(viscosity: f64, order: StaggeredOrder) -> NavierStokes {
    NavierStokes {
        viscosity,
        acceleration: [0.0; 3],
        ends: [[FlowEnd::REST; 2]; 3],
        bodies: Vec::new(),
        order,
        integrator: Integrator::Rk4,
        courant: 0.8,
    }
}

/// Small boxes are not worth a second worker.
fn alone() -> Settings {
    Settings { schedule: Schedule::Serial, workers: 1, ..Settings::default() }
}

fn run_until<T: Compiled>(fd: Fd<T>, time: f64) -> (Simulation<Grid>, Parts<T>) {
    let mut simulation = Simulation::new(fd.model, alone()).unwrap();
    simulation.end_at(time);
    while simulation.clock().time() < time {
        simulation.begin().unwrap();
        simulation.advance(simulation.pace_left()).unwrap();
    }
    (simulation, fd.parts)
}

/// L2 norm of the difference of the velocities on the faces from `exact`, over that of `exact`.
fn error<T: Compiled>(
    simulation: &Simulation<Grid>,
    parts: &Parts<T>,
    exact: impl Fn([f64; 3]) -> [f64; 3],
) -> f64 {
    let (mut difference, mut norm) = (0.0, 0.0);
    for (a, &column) in parts.unknowns.iter().enumerate() {
        let values = simulation.columns().values(column);
        for (u, mut x) in values.iter().zip(parts.mesh.positions()) {
            x[a] -= 0.5 * parts.mesh.spacing()[a];
            let exact = exact(x)[a];
            difference += (u.as_f64() - exact).powi(2);
            norm += exact * exact;
        }
    }
    (difference / norm).sqrt()
}

/// The largest divergence, 1/s.
fn largest_divergence<T: Compiled>(simulation: &mut Simulation<Grid>, parts: &Parts<T>) -> f64 {
    simulation.derive().unwrap();
    let divergence = *parts.derived.last().unwrap();
    let values = simulation.columns().values(divergence);
    values.iter().fold(0.0, |most, d| d.as_f64().abs().max(most))
}

fn energy<T: Compiled>(simulation: &mut Simulation<Grid>, parts: &Parts<T>) -> f64 {
    let mut whole = simulation.whole();
    let squares = parts.unknowns.iter().map(|&u| measure::totals(&mut whole, parts, u).square);
    0.5 * squares.sum::<f64>()
}

/// Vortices of Taylor & Green (1937) that are carried along a diagonal of the box.
fn vortices([x, y, _]: [f64; 3], t: f64) -> [f64; 3] {
    let drift = [0.7, 0.4];
    let [x, y] = [TAU * (x - drift[0] * t), TAU * (y - drift[1] * t)];
    let e = (-2.0 * 0.01 * TAU * TAU * t).exp();
    [drift[0] - e * x.cos() * y.sin(), drift[1] + e * x.sin() * y.cos(), 0.0]
}

#[test]
fn carried_vortices_have_the_order_of_the_operators() {
    for (scheme, n, design) in
        [(StaggeredOrder::Second, [16, 32], 2.0), (StaggeredOrder::Fourth, [16, 32], 4.0)]
    {
        let errors = n.map(|n| {
            let mesh = Mesh::new([Side::periodic(n, 0.0, 1.0), Side::periodic(n, 0.0, 1.0)]);
            let fd = flow(0.01, scheme).model::<f64>(&mesh, &|x| vortices(x, 0.0)).unwrap();
            let (simulation, parts) = run_until(fd, 0.5);
            error(&simulation, &parts, |x| vortices(x, 0.5))
        });
        let measured = order(errors, n);
        assert!((measured - design).abs() < 0.15, "{scheme:?}: {measured}, {errors:?}");
    }
}

/// A flow along its own vorticity (Arnold, Beltrami, Childress), which decays and keeps its shape, in a box that is no
/// cube; with its pressure, which is minus half of the square of the velocity.
#[test]
fn a_flow_in_space_has_the_order_of_the_operators() {
    let exact = |[x, y, z]: [f64; 3], t: f64| {
        let e = (-0.02 * t).exp();
        let (x, y, z) = (x + 0.3 * t, y - 0.2 * t, z + 0.1 * t);
        let [a, b, c] = [1.0, 0.7, 0.4].map(|amplitude| e * amplitude);
        let drift = [-0.3, 0.2, -0.1];
        [
            drift[0] + a * z.sin() + c * y.cos(),
            drift[1] + b * x.sin() + a * z.cos(),
            drift[2] + c * y.sin() + b * x.cos(),
        ]
    };
    for (scheme, n, design) in
        [(StaggeredOrder::Second, [12, 18], 2.0), (StaggeredOrder::Fourth, [12, 18], 4.0)]
    {
        let mut pressures = [0.0; 2];
        let errors = [0, 1].map(|case| {
            let n = n[case];
            let mesh = Mesh::new([
                Side::periodic(n, 0.0, TAU),
                Side::periodic(n, 0.0, TAU),
                Side::periodic(2 * n, 0.0, 2.0 * TAU),
            ]);
            let fd = flow(0.02, scheme).model::<f64>(&mesh, &|x| exact(x, 0.0)).unwrap();
            let (mut simulation, parts) = run_until(fd, 0.5);
            simulation.derive().unwrap();
            let found = simulation.columns().values(parts.derived[0]);
            let wanted = |x: [f64; 3]| {
                let (u, drift) = (exact(x, 0.5), [-0.3, 0.2, -0.1]);
                let squares = (0..3).map(|a| (u[a] - drift[a]).powi(2));
                0.5 * (1.0 + 0.49 + 0.16) * (-0.02f64).exp() - 0.5 * squares.sum::<f64>()
            };
            let squares =
                found.iter().zip(parts.mesh.positions()).map(|(p, x)| (p - wanted(x)).powi(2));
            pressures[case] = (squares.sum::<f64>() / found.len() as f64).sqrt();
            error(&simulation, &parts, |x| exact(x, 0.5))
        });
        let measured = order(errors, n);
        assert!((measured - design).abs() < 0.2, "{scheme:?}: {measured}, {errors:?}");
        let measured = order(pressures, n);
        assert!((measured - design).abs() < 0.3, "pressure, {scheme:?}: {measured}, {pressures:?}");
    }
}

/// A start that is no flow yet.
fn rough([x, y, z]: [f64; 3]) -> [f64; 3] {
    let wave = |a: f64, b: f64, c: f64| {
        (a * TAU * x).sin() * (b * TAU * y + 1.0).cos() + (c * TAU * z).sin()
    };
    [wave(1.0, 2.0, 1.0) + 0.3, wave(3.0, 1.0, 2.0) - 0.2, wave(2.0, 2.0, 1.0)]
}

#[test]
fn divergence_is_round_off_and_momentum_is_kept() {
    let cube = |side: fn(usize, f64, f64) -> Side| {
        Mesh::new([side(20, 0.0, 1.0), Side::periodic(18, 0.0, 1.0), Side::periodic(16, 0.0, 1.0)])
    };
    for (mesh, scheme) in [
        (
            Mesh::new([Side::periodic(40, 0.0, 1.0), Side::periodic(30, 0.0, 1.0)]),
            StaggeredOrder::Fourth,
        ),
        (Mesh::new([Side::cells(33, 0.0, 1.0), Side::cells(20, 0.0, 1.0)]), StaggeredOrder::Second),
        (cube(Side::periodic), StaggeredOrder::Fourth),
        (Mesh::new([Side::cells(33, 0.0, 1.0), Side::cells(20, 0.0, 1.0)]), StaggeredOrder::Fourth),
        (cube(Side::cells), StaggeredOrder::Second),
        (cube(Side::cells), StaggeredOrder::Fourth),
    ] {
        let fd = flow(1e-3, scheme).model::<f64>(&mesh, &rough).unwrap();
        let mut simulation = Simulation::new(fd.model, alone()).unwrap();
        simulation.begin().unwrap();
        let sums = |simulation: &mut Simulation<Grid>| -> Vec<f64> {
            let mut whole = simulation.whole();
            let sum = |&u| measure::totals(&mut whole, &fd.parts, u).integral;
            fd.parts.unknowns.iter().map(sum).collect()
        };
        let before = sums(&mut simulation);
        for steps in [0, 1, 150] {
            simulation.advance(steps).unwrap();
            let divergence = largest_divergence(&mut simulation, &fd.parts);
            // Speeds of 1 over spacings of 1/20.
            assert!(divergence < 2e-13 * 40.0, "{divergence:e} after {steps} steps");
        }
        for (a, (before, after)) in before.iter().zip(sums(&mut simulation)).enumerate() {
            let is_kept =
                mesh.sides().iter().all(|side| side.spread == finegrain_fd::Spread::Periodic);
            assert!(!is_kept || (after - before).abs() < 1e-13, "{a}: {before} {after}");
        }
    }
}

/// Almost without viscosity energy is lost by the integrator only, and so with a high power of the time step:
/// fluxes keep it, between walls, too.
#[test]
fn fluxes_keep_energy() {
    let periodic = [Side::periodic(24, 0.0, 1.0), Side::periodic(24, 0.0, 1.0)];
    let closed = [Side::cells(24, 0.0, 1.0), Side::cells(24, 0.0, 1.0)];
    for (sides, scheme) in [
        (periodic, StaggeredOrder::Second),
        (periodic, StaggeredOrder::Fourth),
        (closed, StaggeredOrder::Second),
    ] {
        let loss = [0.8, 0.4].map(|courant| {
            let equation = NavierStokes { courant, ..flow(1e-14, scheme) };
            let fd = equation.model::<f64>(&Mesh::new(sides), &rough).unwrap();
            let mut simulation = Simulation::new(fd.model, alone()).unwrap();
            simulation.begin().unwrap();
            let before = energy(&mut simulation, &fd.parts);
            simulation.end_at(0.5);
            while simulation.clock().time() < 0.5 {
                simulation.advance(1).unwrap();
            }
            1.0 - energy(&mut simulation, &fd.parts) / before
        });
        assert!(loss[0] < 0.05 && loss[0] / loss[1] > 12.0, "{scheme:?}: {loss:?}");
    }
}

/// Flow along plates, in every direction and between any walls: it stays at the steady parabola and straight line, for
/// next to walls velocities are taken to lie on a parabola.
#[test]
fn plates_in_every_direction() {
    let all = [(0, 1), (1, 0), (0, 2), (2, 1), (1, 2), (2, 0)];
    let schemes = [StaggeredOrder::Second, StaggeredOrder::Fourth];
    for ((along, across), scheme) in all.into_iter().flat_map(|axes| schemes.map(|s| (axes, s))) {
        let mut sides = [Side::periodic(6, 0.0, 0.5); 3];
        sides[across] = Side::cells(9, 0.0, 1.0);
        let mut equation = flow(1.0, scheme);
        equation.acceleration[along] = 8.0;
        let sliding = |speed: f64| {
            let mut velocity = [0.0; 3];
            velocity[along] = speed;
            FlowEnd::Wall(velocity)
        };
        equation.ends[across] = [sliding(-0.2), sliding(0.5)];
        let exact = |x: [f64; 3]| {
            let mut u = [0.0; 3];
            u[along] = 4.0 * x[across] * (1.0 - x[across]) + 0.7 * x[across] - 0.2;
            u
        };
        let fd = equation.model::<f64>(&Mesh::new(sides), &exact).unwrap();
        let (simulation, parts) = run_until(fd, 0.5);
        let error = error(&simulation, &parts, exact);
        assert!(error < 1e-13, "{along} {across}: {error:e}");
    }
}

/// A wall that slides along an axis at speed 1.
fn sliding(along: usize) -> FlowEnd {
    let mut velocity = [0.0; 3];
    velocity[along] = 1.0;
    FlowEnd::Wall(velocity)
}

/// A cavity under a lid that moves along x, and the same lying on its side.
#[test]
fn a_cavity_that_lies_on_its_side_is_the_same() {
    for scheme in [StaggeredOrder::Second, StaggeredOrder::Fourth] {
        turned_cavity(scheme);
    }
}

fn turned_cavity(scheme: StaggeredOrder) {
    let cavity = |lid: usize, along: usize| {
        let mut equation = flow(0.01, scheme);
        equation.ends[lid][1] = sliding(along);
        let mesh = Mesh::new([Side::cells(20, 0.0, 1.0); 2]);
        let fd = equation.model::<f64>(&mesh, &|_| [0.0; 3]).unwrap();
        let (simulation, parts) = run_until(fd, 1.0);
        parts.unknowns.iter().map(|&u| simulation.columns().values(u).to_vec()).collect::<Vec<_>>()
    };
    let (upright, lying) = (cavity(1, 0), cavity(0, 1));
    for a in 0..2 {
        for (n, u) in upright[a].iter().enumerate() {
            let turned = lying[1 - a][n % 20 * 20 + n / 20];
            assert!((u - turned).abs() < 1e-12, "{a} {n}: {u} {turned}");
        }
    }
    // The lid drags the fluid along, and what goes out comes back.
    let top: f64 = upright[0][19 * 20..].iter().sum::<f64>() / 20.0;
    let flux: f64 = upright[0].iter().skip(10).step_by(20).sum();
    assert!(top > 0.4 && flux.abs() < 1e-13, "{top} {flux}");
}

/// A box under a lid: the same numbers on whichever of the six sides it is, and along whichever of the others it moves.
#[test]
fn a_box_with_its_lid_on_any_side_is_the_same() {
    for scheme in [StaggeredOrder::Second, StaggeredOrder::Fourth] {
        turned_box(scheme);
    }
}

fn turned_box(scheme: StaggeredOrder) {
    const N: usize = 10;
    let mesh = Mesh::new([Side::cells(N, 0.0, 1.0); 3]);
    let cavity = |lid: usize, end: usize, along: usize| {
        let mut equation = flow(0.02, scheme);
        equation.ends[lid][end] = sliding(along);
        let fd = equation.model::<f64>(&mesh, &|_| [0.0; 3]).unwrap();
        let (simulation, parts) = run_until(fd, 0.5);
        [0, 1, 2].map(|a| simulation.columns().values(parts.unknowns[a]).to_vec())
    };
    let place = |point: [usize; 3]| (point[2] * N + point[1]) * N + point[0];
    let upright = cavity(1, 1, 0);
    for (lid, along) in [(0, 1), (1, 2), (2, 0), (0, 2), (1, 0), (2, 1)] {
        let axes = [along, lid, 3 - lid - along];
        for end in [0, 1] {
            let turned = cavity(lid, end, along);
            for (a, &axis) in axes.iter().enumerate() {
                for n in 0..N * N * N {
                    let point = [n % N, n / N % N, n / (N * N)];
                    let (mut there, mut sign) = ([0; 3], 1.0);
                    (0..3).for_each(|b| there[axes[b]] = point[b]);
                    if end == 0 {
                        // Upside down; of faces along this axis the first is on the wall.
                        there[lid] = if a == 1 { (N - point[1]) % N } else { N - 1 - point[1] };
                        sign = if a == 1 { -1.0 } else { 1.0 };
                    }
                    let (u, v) = (upright[a][n], sign * turned[axis][place(there)]);
                    assert!((u - v).abs() < 1e-12, "{lid} {end} {along} {a} {point:?}: {u} {v}");
                }
            }
        }
    }
    let speed = upright.iter().map(|u| u.iter().fold(0.0f64, |most, u| most.max(u.abs())));
    let speeds: Vec<f64> = speed.collect();
    assert!(speeds[0] > 0.4 && speeds[1] > 0.1 && speeds[2] > 0.005, "{speeds:?}");
}

/// A wave of shear between plates across z, of which one moves.
#[test]
fn shear_across_z_decays_in_second_order() {
    let exact = |x: [f64; 3], t: f64| {
        let decay = (-std::f64::consts::PI.powi(2) * t).exp();
        let shear = x[2] + decay * (std::f64::consts::PI * x[2]).sin();
        [shear, -0.5 * shear, 0.0]
    };
    // The error at walls, of third order, has the other sign: the order comes up from below.
    let n = [24, 48];
    let errors = n.map(|n| {
        let across = Side::cells(n, 0.0, 1.0);
        let mesh = Mesh::new([Side::periodic(4, 0.0, 1.0), Side::periodic(4, 0.0, 1.0), across]);
        let mut equation = flow(1.0, StaggeredOrder::Second);
        equation.ends[2][1] = FlowEnd::Wall([1.0, -0.5, 0.0]);
        let fd = equation.model::<f64>(&mesh, &|x| exact(x, 0.0)).unwrap();
        let (simulation, parts) = run_until(fd, 0.1);
        error(&simulation, &parts, |x| exact(x, 0.1))
    });
    let measured = order(errors, n);
    assert!((measured - 2.0).abs() < 0.2, "{measured} {errors:?}");
}

/// At the limit of every integrator a rough flow loses energy and does not gain any.
#[test]
fn steps_at_the_limit_are_stable() {
    let periodic = Mesh::new([Side::periodic(16, 0.0, 1.0); 2]);
    let closed = Mesh::new([Side::cells(16, 0.0, 1.0); 2]);
    let schemes = [
        (&periodic, StaggeredOrder::Second),
        (&periodic, StaggeredOrder::Fourth),
        (&closed, StaggeredOrder::Second),
        (&closed, StaggeredOrder::Fourth),
    ];
    for integrator in [Integrator::Rk2, Integrator::SspRk3, Integrator::Rk4] {
        for viscosity in [1e-3, 0.1] {
            for (mesh, scheme) in schemes {
                let equation = NavierStokes { integrator, courant: 1.0, ..flow(viscosity, scheme) };
                let fd = equation.model::<f64>(mesh, &rough).unwrap();
                let mut simulation = Simulation::new(fd.model, alone()).unwrap();
                simulation.begin().unwrap();
                let before = energy(&mut simulation, &fd.parts);
                simulation.advance(300).unwrap();
                let after = energy(&mut simulation, &fd.parts);
                let case = format!("{} {viscosity} {scheme:?}", integrator.name());
                assert!(after < before, "{case}: {before} {after}");
            }
        }
    }
}

/// The cavity at Re = 1000 on a coarse mesh: least velocity along the lid on the line through the middle, which is
/// -0.3885698 (Botella & Peyret 1998, Comput. Fluids 27). Nearly all of the error of second order is that of advection and
/// diffusion inside.
#[test]
fn fourth_order_between_walls_takes_away_most_of_the_error() {
    const N: usize = 48;
    let error = |scheme: StaggeredOrder| {
        let mut equation = flow(1e-3, scheme);
        equation.ends[1][1] = sliding(0);
        let mesh = Mesh::new([Side::cells(N, 0.0, 1.0); 2]);
        let fd = equation.model::<f64>(&mesh, &|_| [0.0; 3]).unwrap();
        let (simulation, parts) = run_until(fd, 120.0);
        let u = simulation.columns().values(parts.unknowns[0]);
        let middle: Vec<f64> = u.iter().skip(N / 2).step_by(N).copied().collect();
        let j = (1..N).min_by(|&a, &b| middle[a].total_cmp(&middle[b])).unwrap();
        // The least of the parabola through three points.
        let [low, least, high] = [middle[j - 1], middle[j], middle[j + 1]];
        let found = least - (high - low).powi(2) / (8.0 * (high - 2.0 * least + low));
        found / -0.3885698 - 1.0
    };
    let [second, fourth] = [StaggeredOrder::Second, StaggeredOrder::Fourth].map(error);
    assert!(second < -0.07 && fourth.abs() < 0.045, "{second} {fourth}");
}
