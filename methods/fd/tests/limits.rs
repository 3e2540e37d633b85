//! Every explicit scheme up to its computed limit and beyond it: the longest time step with which nothing grows.
//!
//! `cargo test -p finegrain-fd --test limits -- --nocapture` prints the measured limits beside the computed ones.

use finegrain_fd::{
    Advection, Boundary, Condition, Drift, Face, Fd, Heat, Mesh, Order, Side, Wave,
};
use finegrain_framework::{FixedPace, Integrator, Schedule, Settings, Simulation};

const POINTS: usize = 36;

fn line(closed: bool) -> (Mesh, Boundary) {
    let side = if closed { Side::ends } else { Side::periodic };
    (Mesh::new([side(POINTS, 0.0, 1.0)]), Boundary::all(Condition::dirichlet(0.0)))
}

/// Every wave that the mesh can hold.
fn rough(x: [f64; 3]) -> f64 {
    (1e4 * x[0] + 1e3 * x[0] * x[0]).sin()
}

/// Whether it stays bounded with a time step so many times that of the model.
fn is_stable(fd: Fd<f64>, time_step: f64) -> bool {
    let Fd { mut model, parts } = fd;
    model.pacing = Box::new(FixedPace(time_step));
    let settings = Settings {
        schedule: Schedule::Serial,
        workers: 1,
        check_every: None,
        ..Settings::default()
    };
    let mut simulation = Simulation::new(model, settings).unwrap();
    simulation.advance(4000).unwrap();
    // Leapfrog lets the largest grow to several times the start, and no further.
    simulation.columns().values(parts.unknowns[0]).iter().all(|u| u.abs() < 100.0)
}

/// The largest multiple of the computed limit with which it is stable, to one part in a thousand.
fn measured(limit: f64, model: impl Fn(f64) -> Fd<f64>) -> f64 {
    let (mut stable, mut unstable) = (0.5f64, 2.0);
    while unstable - stable > 1e-3 {
        let middle = 0.5 * (stable + unstable);
        // A model accepts no more than its limit; its pace is set to more afterwards.
        let is_stable = is_stable(model(limit * middle.min(1.0)), limit * middle);
        *if is_stable { &mut stable } else { &mut unstable } = middle;
    }
    stable
}

const INTEGRATORS: [Integrator; 4] =
    [Integrator::Euler, Integrator::Rk2, Integrator::SspRk3, Integrator::Rk4];

fn check(scheme: &str, number: f64, measured: f64, within: [f64; 2]) {
    println!("{scheme:45} {number:8.4} {:8.4}", number * measured);
    assert!(within[0] < measured && measured < within[1], "{scheme}: {measured} of the limit");
}

/// `kappa dt / h^2`. In periodic boxes as computed; between ends the computed limit is on the safe side by a hair.
#[test]
fn of_heat() {
    for (order, closed) in Order::ALL
        .into_iter()
        .flat_map(|order| [(order, false), (order, true)])
        .filter(|case| *case != (Order::Eighth, true))
    {
        for integrator in INTEGRATORS {
            let (mesh, boundary) = line(closed);
            let heat = Heat { diffusivity: 0.7, order, integrator: integrator.into(), boundary };
            let limit = heat.time_step_limit(&mesh).unwrap();
            let measured = measured(limit, |dt| heat.model(&mesh, dt, &rough).unwrap());
            let ends = if closed { "closed" } else { "periodic" };
            let scheme = format!("heat, order {order}, {ends}, {}", integrator.name());
            let number = 0.7 * limit / mesh.spacing()[0].powi(2);
            check(&scheme, number, measured, [0.998, 1.005]);
        }
    }
}

/// `c dt / h`, by leapfrog.
#[test]
fn of_waves() {
    for order in Order::ALL {
        let (mesh, boundary) = line(false);
        let wave = Wave { speed: 1.3, order, boundary };
        let limit = wave.time_step_limit(&mesh).unwrap();
        let measured = measured(limit, |dt| wave.model(&mesh, dt, &rough, &|_| 0.0).unwrap());
        let number = 1.3 * limit / mesh.spacing()[0];
        check(&format!("wave, order {order}, leapfrog"), number, measured, [0.998, 1.002]);
    }
}

/// `v dt / h`. Just past the limit some schemes grow too slowly to be seen, in 4000 steps on as many points. Weights of
/// WENO schemes are not those that the limit is computed with: they damp what is rough.
#[test]
fn of_advection() {
    for face in Face::ALL {
        for integrator in INTEGRATORS {
            let (mesh, boundary) = line(false);
            let advection = Advection { face, integrator, boundary };
            let Ok(limit) = advection.time_step_limit(&mesh, [1.1, 0.0, 0.0]) else { continue };
            let model = |dt| advection.model(&mesh, dt, &|_| [1.1, 0.0, 0.0], &rough).unwrap();
            let measured = measured(limit, model);
            let is_linear = matches!(face, Face::Upwind1 | Face::Upwind3);
            let scheme = format!("advection, {}, {}", face.name(), integrator.name());
            let most = if is_linear { 1.1 } else { 2.0 };
            check(&scheme, 1.1 * limit / mesh.spacing()[0], measured, [0.998, most]);
        }
    }
    for order in Order::ALL {
        for integrator in [Integrator::SspRk3, Integrator::Rk4] {
            let (mesh, boundary) = line(false);
            let drift = Drift { velocity: [1.1, 0.0, 0.0], order, integrator, boundary };
            let limit = drift.time_step_limit(&mesh).unwrap();
            let measured = measured(limit, |dt| drift.model(&mesh, dt, &rough).unwrap());
            let scheme = format!("advection, central of order {order}, {}", integrator.name());
            check(&scheme, 1.1 * limit / mesh.spacing()[0], measured, [0.998, 1.02]);
        }
    }
}
