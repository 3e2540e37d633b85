//! Running models up to a time, and comparing them with what they should come to.
#![allow(dead_code, reason = "every test binary uses its own share of these")]

use finegrain_fd::{Compiled, Fd};
use finegrain_framework::space::Grid;
use finegrain_framework::{Settings, Simulation};

/// A simulation that has been run for so many steps.
pub fn run<T: Compiled>(fd: Fd<T>, steps: u64) -> (Simulation<Grid>, finegrain_fd::Parts<T>) {
    let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
    simulation.advance(steps).unwrap();
    (simulation, fd.parts)
}

/// L2 norm of the difference of the first unknown from `exact`.
pub fn error<T: Compiled>(
    simulation: &Simulation<Grid>,
    parts: &finegrain_fd::Parts<T>,
    exact: impl Fn([f64; 3], f64) -> f64,
) -> f64 {
    let time = simulation.clock().time();
    let values = simulation.columns().values(parts.unknowns[0]);
    let squares: f64 = values
        .iter()
        .zip(parts.mesh.positions())
        .map(|(u, x)| (u.as_f64() - exact(x, time)).powi(2))
        .sum();
    (squares / values.len() as f64).sqrt()
}

/// The order with which errors fall from `n[0]` to `n[1]` intervals.
pub fn order(errors: [f64; 2], n: [usize; 2]) -> f64 {
    (errors[0] / errors[1]).ln() / (n[1] as f64 / n[0] as f64).ln()
}
