//! Bodies in incompressible flow, against exact and published solutions.

use std::f64::consts::PI;

use finegrain_fd::{
    Body, Compiled, Fd, FlowEnd, Mesh, NavierStokes, Parts, Side, StaggeredOrder, measure,
};
use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::Grid;
use finegrain_framework::{Integrator, Schedule, Settings, Simulation};

fn flow(body: Body) -> NavierStokes {
    NavierStokes {
        viscosity: 1.0,
        acceleration: [0.0; 3],
        ends: [[FlowEnd::REST; 2]; 3],
        bodies: vec![body],
        order: StaggeredOrder::Second,
        // To a steady state the cheapest.
        integrator: Integrator::Euler,
        courant: 0.9,
    }
}

fn begun<T: Compiled>(fd: Fd<T>) -> (Simulation<Grid>, Parts<T>) {
    let settings = Settings { schedule: Schedule::Serial, workers: 1, ..Settings::default() };
    let mut simulation = Simulation::new(fd.model, settings).unwrap();
    simulation.begin().unwrap();
    (simulation, fd.parts)
}

fn run_until<T: Compiled>(fd: Fd<T>, time: f64) -> (Simulation<Grid>, Parts<T>) {
    let (mut simulation, parts) = begun(fd);
    simulation.end_at(time);
    while simulation.clock().time() < time {
        simulation.begin().unwrap();
        simulation.advance(simulation.pace_left()).unwrap();
    }
    simulation.derive().unwrap();
    (simulation, parts)
}

fn periodic(n: usize) -> Mesh {
    Mesh::new([Side::periodic(n, 0.0, 1.0), Side::periodic(n, 0.0, 1.0)])
}

/// A cylinder that fills the part 0.04 pi of a box of side 1.
fn cylinder([x, y]: [f64; 2]) -> Body {
    Shape::Cylinder { axis: Axis::Z, centre: [x, y, 0.0], radius: 0.2 }.into()
}

/// `k = f L^2 / (nu U)` of creeping flow, for an acceleration of 1 along an axis; the force on the cylinder over the
/// body force on the fluid, less one; both across the flow; and the largest divergence over the mean velocity.
fn drag(n: usize, centre: [f64; 2], along: usize) -> [f64; 5] {
    let mut equation = flow(cylinder(centre));
    equation.acceleration[along] = 1.0;
    let fd = equation.model::<f64>(&periodic(n), &|_| [0.0; 3]).unwrap();
    let (mut simulation, parts) = run_until(fd, 0.7);
    let divergences = simulation.columns().values(*parts.derived.last().unwrap());
    let divergence = divergences.iter().fold(0.0, |most, d| d.abs().max(most));
    let mut whole = simulation.whole();
    let mean = |a: usize| parts.unknowns[a];
    let [u, v] = [along, 1 - along].map(|a| measure::totals(&mut whole, &parts, mean(a)).integral);
    let force = measure::force_on_body(&whole, &parts, 0);
    let balance = force[along] / (1.0 - 0.04 * PI) - 1.0;
    [1.0 / u, balance, v / u, force[1 - along], divergence / u]
}

/// Streamfunction series, converged to nine digits; agrees with Sangani & Acrivos (1982), Table 1.
const CREEPING: f64 = 30.35063565;

/// The error scatters with how the surface lies between faces, within an envelope of second order. Nothing goes through
/// the cylinder and what drives the fluid ends on it.
#[test]
fn creeping_flow_through_cylinders_is_of_second_order() {
    for (n, centre) in [
        (20, [0.5, 0.5]),
        (25, [0.5, 0.5]),
        (32, [0.5, 0.5]),
        (40, [0.5, 0.5]),
        (50, [0.5, 0.5]),
        // Over the ends of the box, and nowhere in particular.
        (32, [0.013, 0.977]),
        (40, [0.513, 0.477]),
    ] {
        let [k, balance, _, _, divergence] = drag(n, centre, 0);
        let error = k / CREEPING - 1.0;
        let n2 = (n * n) as f64;
        assert!(error.abs() < 6.0 / n2, "{n} {centre:?}: {error}");
        assert!(balance.abs() < 1e-3, "{n} {centre:?}: {balance}");
        assert!(divergence < 1e-10, "{divergence:e}");
    }
}

#[test]
fn flow_in_the_other_direction_is_the_same() {
    let [along_x, along_y] = [0, 1].map(|along| drag(20, [0.5, 0.5], along));
    assert!((along_x[0] / along_y[0] - 1.0).abs() < 1e-10, "{along_x:?} {along_y:?}");
    for [_, _, across, lift, _] in [along_x, along_y] {
        assert!(across.abs() < 1e-12 && lift.abs() < 1e-12, "{along_x:?} {along_y:?}");
    }
}

/// Between plates of any thickness anywhere, that slide, a parabola is exact.
#[test]
fn plates_between_faces_keep_a_parabola() {
    for (along, across) in [(0, 1), (1, 0)] {
        for [bottom, top] in [[0.313, 0.62], [0.3, 0.6], [0.87, 1.171]] {
            let (mut low, mut high) = ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
            (low[across], high[across]) = (bottom, top);
            let mut plate = Body::from(Shape::Cuboid { low, high });
            plate.surface_velocity[along] = 0.3;
            let mut equation = flow(plate);
            equation.acceleration[along] = 8.0;
            let gap = 1.0 - (top - bottom);
            let exact = |x: [f64; 3]| {
                let above = (x[across] - top).rem_euclid(1.0);
                let mut u = [0.0; 3];
                u[along] = 0.3 + if above < gap { 4.0 * above * (gap - above) } else { 0.0 };
                u
            };
            let fd = equation.model::<f64>(&periodic(20), &exact).unwrap();
            let (simulation, parts) = run_until(fd, 0.3);
            let mut largest = 0.0f64;
            let values = simulation.columns().values(parts.unknowns[along]);
            for (u, x) in values.iter().zip(parts.mesh.positions()) {
                if (x[across] - top).rem_euclid(1.0) < gap - 1e-9 {
                    largest = largest.max((u - exact(x)[along]).abs());
                }
            }
            assert!(largest < 1e-11, "{along} {bottom} {top}: {largest:e}");
        }
    }
}

/// The force while the flow starts is what the fluid does not get: its momentum grows by the rest.
#[test]
fn a_body_takes_the_momentum_that_the_fluid_loses() {
    let mut equation = flow(cylinder([0.5, 0.5]));
    (equation.viscosity, equation.integrator) = (0.05, Integrator::Rk4);
    equation.acceleration = [1.0, 0.5, 0.0];
    let fd = equation.model::<f64>(&periodic(40), &|_| [0.0; 3]).unwrap();
    let (mut simulation, parts) = begun(fd);
    let momentum = |simulation: &Simulation<Grid>| {
        [0, 1].map(|a| {
            let values = simulation.columns().values(parts.unknowns[a]);
            let faces = values.iter().zip(parts.mesh.positions());
            let fluid = faces.filter(|&(_, mut x)| {
                x[a] -= 0.5 / 40.0;
                (x[0] - 0.5).hypot(x[1] - 0.5) > 0.2
            });
            fluid.map(|(u, _)| u / 1600.0).sum::<f64>()
        })
    };
    let force = |simulation: &mut Simulation<Grid>| {
        simulation.derive().unwrap();
        measure::force_on_body(&simulation.whole(), &parts, 0)
    };
    simulation.advance(40).unwrap();
    let (before, early, begin) =
        (momentum(&simulation), force(&mut simulation), simulation.clock().time());
    simulation.advance(1).unwrap();
    let (after, late, end) =
        (momentum(&simulation), force(&mut simulation), simulation.clock().time());
    for a in 0..2 {
        let driving = equation.acceleration[a] * (1.0 - 0.04 * PI);
        let grown = (after[a] - before[a]) / (end - begin);
        let left = driving - 0.5 * (early[a] + late[a]);
        assert!((grown - left).abs() < 2e-3 * driving && left > 0.05 * driving, "{grown} {left}");
    }
}

/// At the limit of every integrator a rough flow around a body loses energy and does not gain any.
#[test]
fn steps_at_the_limit_are_stable() {
    let rough = |[x, y, _]: [f64; 3]| {
        [(17.0 * x * y).sin() + (90.0 * y).cos() + 0.3, (23.0 * x + 70.0 * y).sin() - 0.2, 0.0]
    };
    let centres = [[0.5, 0.5], [0.52, 0.49], [0.507, 0.531], [0.515, 0.485]];
    for (case, centre) in centres.into_iter().enumerate() {
        for (integrator, viscosity) in [
            (Integrator::Euler, 1.0),
            (Integrator::Euler, 1e-2),
            (Integrator::SspRk3, 0.1),
            (Integrator::Rk4, 1e-2),
        ] {
            let body = cylinder(centre);
            let equation = NavierStokes { integrator, viscosity, courant: 1.0, ..flow(body) };
            let fd = equation.model::<f64>(&periodic(23 + case), &rough).unwrap();
            let (mut simulation, parts) = begun(fd);
            let energy = |simulation: &mut Simulation<Grid>| -> f64 {
                let mut whole = simulation.whole();
                let square = |&u| measure::totals(&mut whole, &parts, u).square;
                parts.unknowns.iter().map(square).sum()
            };
            let before = energy(&mut simulation);
            simulation.advance(300).unwrap();
            let after = energy(&mut simulation);
            let name = integrator.name();
            assert!(after < 0.9 * before, "{name} {viscosity} {centre:?}: {before} {after}");
        }
    }
}
