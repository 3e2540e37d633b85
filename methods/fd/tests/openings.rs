//! Incompressible flow that comes in at one end and leaves at the other.

use finegrain_fd::{Fd, FlowEnd, Mesh, NavierStokes, Parts, Side, StaggeredOrder};
use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::Grid;
use finegrain_framework::{Integrator, Schedule, Settings, Simulation};

/// Of flow along an axis.
fn through(along: usize, viscosity: f64) -> NavierStokes {
    let mut ends = [[FlowEnd::REST; 2]; 3];
    ends[along] = [FlowEnd::Inflow, FlowEnd::Outflow];
    NavierStokes {
        viscosity,
        acceleration: [0.0; 3],
        ends,
        bodies: Vec::new(),
        order: StaggeredOrder::Second,
        integrator: Integrator::Rk4,
        courant: 0.8,
    }
}

/// Of cells that are `length / cells` long, the last of them beyond the outflow.
fn open(cells: usize, length: f64) -> Side {
    Side::cells(cells + 1, 0.0, length * (cells + 1) as f64 / cells as f64)
}

fn started(fd: Fd<f64>) -> (Simulation<Grid>, Parts<f64>) {
    let settings = Settings { schedule: Schedule::Serial, workers: 1, ..Settings::default() };
    let mut simulation = Simulation::new(fd.model, settings).unwrap();
    simulation.begin().unwrap();
    (simulation, fd.parts)
}

fn run_until(fd: Fd<f64>, time: f64) -> (Simulation<Grid>, Parts<f64>) {
    let (mut simulation, parts) = started(fd);
    simulation.end_at(time);
    while simulation.clock().time() < time {
        simulation.advance(simulation.pace_left()).unwrap();
        simulation.begin().unwrap();
    }
    simulation.derive().unwrap();
    (simulation, parts)
}

/// Whatever is in a channel at the beginning, the parabola that comes in fills it, with a pressure that falls along
/// a straight line to none at the outflow.
#[test]
fn a_parabola_comes_through_in_every_direction() {
    for (dims, along, across) in [(2, 0, 1), (2, 1, 0), (3, 0, 1), (3, 1, 2), (3, 2, 0), (3, 1, 0)]
    {
        let side = |a: usize| match a {
            _ if a == along => open(8, 1.0),
            _ if a == across => Side::cells(9, 0.0, 1.0),
            _ => Side::periodic(4, 0.0, 0.5),
        };
        let mesh = match dims {
            2 => Mesh::new([side(0), side(1)]),
            _ => Mesh::new([side(0), side(1), side(2)]),
        };
        let parabola = |x: [f64; 3]| 4.0 * x[across] * (1.0 - x[across]);
        let start = |x: [f64; 3]| {
            let mut u = [0.3 * x[along], 0.2 * x[across], 0.0];
            u[along] = parabola(x) + 0.5 * (5.0 * x[along] * (x[across] + x[2])).sin();
            u
        };
        let (simulation, parts) = run_until(through(along, 1.0).model(&mesh, &start).unwrap(), 5.0);
        let columns = simulation.columns();
        for (a, &column) in parts.unknowns.iter().enumerate() {
            for (u, x) in columns.values(column).iter().zip(mesh.positions()) {
                let wanted = if a == along { parabola(x) } else { 0.0 };
                assert!((u - wanted).abs() < 1e-12, "{along} {across} {a} {x:?}: {u} {wanted}");
            }
        }
        for (p, x) in columns.values(parts.derived[0]).iter().zip(mesh.positions()) {
            let wanted = 8.0 * (1.0 - x[along]);
            assert!((p - wanted).abs() < 1e-10, "{along} {across} {x:?}: {p} {wanted}");
        }
    }
}

/// What goes through every line across, lower to upper end.
fn fluxes(simulation: &Simulation<Grid>, parts: &Parts<f64>, along: usize) -> Vec<f64> {
    let [nx, ny, _] = parts.mesh.shape();
    let u = simulation.columns().values(parts.unknowns[along]);
    let sum = |i: usize| match along {
        0 => (0..ny).map(|j| u[j * nx + i]).sum::<f64>(),
        _ => u[i * nx..][..nx].iter().sum(),
    };
    (0..[nx, ny][along]).map(sum).map(|sum| sum * parts.mesh.spacing()[1 - along]).collect()
}

/// Past a cylinder between walls, from a start that is no flow yet: as much comes out as goes in at every step, there is
/// no divergence, and it is the same along either axis.
#[test]
fn nothing_is_lost_on_the_way() {
    let flow = |along: usize| {
        let turned = |x: [f64; 3]| [x[along], x[1 - along]];
        let mut sides = [open(60, 2.0), Side::cells(30, 0.0, 1.0)];
        let mut equation = through(along, 0.01);
        let mut centre = [0.61, 0.48, 0.0];
        if along == 1 {
            sides.swap(0, 1);
            centre.swap(0, 1);
        }
        equation.bodies = vec![Shape::Cylinder { axis: Axis::Z, centre, radius: 0.17 }.into()];
        let start = |x: [f64; 3]| {
            let [s, n] = turned(x);
            let mut u = [0.3 * (9.0 * s * n).sin(); 3];
            u[along] = 4.0 * n * (1.0 - n) + 0.2 * (7.0 * s).cos() * n;
            u
        };
        let (mut simulation, parts) =
            started(equation.model::<f64>(&Mesh::new(sides), &start).unwrap());
        let brought = fluxes(&simulation, &parts, along)[0];
        for steps in [0, 1, 150] {
            simulation.advance(steps).unwrap();
            simulation.derive().unwrap();
            let through = fluxes(&simulation, &parts, along);
            for flux in &through[..61] {
                assert!((flux / brought - 1.0).abs() < 1e-12, "{steps}: {flux} of {brought}");
            }
            let divergence = simulation.columns().values(*parts.derived.last().unwrap());
            let most = divergence.iter().fold(0.0f64, |most, d| most.max(d.abs()));
            // Speeds of 1 over spacings of 1/30.
            assert!(most < 2e-11, "{most:e} after {steps} steps");
        }
        parts.unknowns.iter().map(|&u| simulation.columns().values(u).to_vec()).collect::<Vec<_>>()
    };
    let (lying, upright) = (flow(0), flow(1));
    for a in 0..2 {
        for (n, u) in lying[a].iter().enumerate() {
            let turned = upright[1 - a][n % 61 * 30 + n / 61];
            assert!((u - turned).abs() < 1e-9, "{a} {n}: {u} {turned}");
        }
    }
}

/// A vortex in a stream leaves, and next to nothing comes back.
#[test]
fn a_vortex_leaves() {
    let (n, strength, radius) = (40, 0.3, 0.1);
    let mesh = Mesh::new([open(n, 1.0), Side::periodic(n, 0.0, 1.0)]);
    let start = |[x, y, _]: [f64; 3]| {
        let [dx, dy] = [(x - 0.5) / radius, (y - 0.5) / radius];
        let around = strength * (0.5 - 0.5 * (dx * dx + dy * dy)).exp();
        [1.0 - around * dy, around * dx, 0.0]
    };
    let left = |time: f64| {
        let (simulation, parts) = run_until(through(0, 1e-4).model(&mesh, &start).unwrap(), time);
        let [u, v] = [0, 1].map(|a| simulation.columns().values(parts.unknowns[a]));
        let squares = u.iter().zip(v).map(|(u, v)| (u - 1.0).powi(2) + v * v);
        (squares.sum::<f64>() / (n * n) as f64).sqrt()
    };
    let [begin, leaving, gone] = [0.0, 0.5, 1.3].map(left);
    assert!(leaving < 0.9 * begin && gone < 0.02 * begin, "{begin} {leaving} {gone}");
}

/// At the limit of every integrator a rough flow calms down; it does not where the pressure beyond the outflow drives
/// anything along it.
#[test]
fn steps_at_the_limit_are_stable() {
    let rough = |[x, y, _]: [f64; 3]| {
        let noise = (17.0 * x * y).sin() * (90.0 * y).cos();
        [1.0 + 0.4 * noise, 0.5 * (23.0 * x + 70.0 * y).sin(), 0.0]
    };
    for across in [Side::cells(20, 0.0, 1.0), Side::periodic(20, 0.0, 1.0)] {
        for (integrator, viscosity) in [
            (Integrator::Euler, 1.0),
            (Integrator::Euler, 1e-2),
            (Integrator::Rk2, 0.1),
            (Integrator::SspRk3, 1e-3),
            (Integrator::Rk4, 1e-3),
            (Integrator::Rk4, 1.0),
        ] {
            let equation = NavierStokes { integrator, courant: 1.0, ..through(0, viscosity) };
            let fd = equation.model::<f64>(&Mesh::new([open(30, 1.5), across]), &rough).unwrap();
            let (mut simulation, parts) = started(fd);
            let roughness = |simulation: &Simulation<Grid>| -> f64 {
                let v = simulation.columns().values(parts.unknowns[1]);
                v.iter().map(|v| v * v).sum()
            };
            let before = roughness(&simulation);
            simulation.advance(400).unwrap();
            let after = roughness(&simulation);
            let name = integrator.name();
            assert!(after < before, "{name} {viscosity}: {before} {after}");
        }
    }
}
