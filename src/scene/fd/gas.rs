//! What gas scenes by finite differences have in common.

use finegrain_fd::{Compiled, GasState, Parts, measure};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run};
use finegrain_framework::space::Grid;

use crate::scene::parameter::Parameter;
use crate::scene::riemann::Gas;

/// The Courant number itself.
pub(super) const COURANT: Parameter = Parameter::number(
    "courant",
    0.4,
    [1e-4, finegrain_fd::Gas::LARGEST_COURANT],
    "",
    "Courant number of the fastest wave; more would not keep density and pressure positive",
);

/// A gas that moves along x.
pub(super) fn state(gas: Gas) -> GasState {
    let Gas { density, velocity, pressure } = gas;
    GasState { density, velocity: [velocity, 0.0, 0.0], pressure }
}

/// Positions along x and gases of all points.
pub(super) fn gases<T: Compiled>(
    simulation: &Simulation<Grid>,
    parts: &Parts<T>,
    heat_ratio: f64,
) -> Vec<(f64, Gas)> {
    let columns = simulation.columns();
    let last = parts.unknowns.len() - 1;
    let value = |f: usize, i: usize| columns.values(parts.unknowns[f])[i].as_f64();
    let gas = |(i, x): (usize, [f64; 3])| {
        let density = value(0, i);
        let squared: f64 = (1..last).map(|f| value(f, i).powi(2)).sum();
        let pressure = (heat_ratio - 1.0) * (value(last, i) - 0.5 * squared / density);
        (x[0], Gas { density, velocity: value(1, i) / density, pressure })
    };
    parts.mesh.positions().enumerate().map(gas).collect()
}

/// Monitors mass, energy and what is least of density and pressure, every step.
pub(super) fn observe<T: Compiled>(run: Run<Grid>, parts: &Parts<T>, heat_ratio: f64) -> Run<Grid> {
    let parts = parts.clone();
    let columns = ["mass", "total_energy", "least_density", "least_pressure"];
    run.monitor("gas", Every::Steps(1), columns, move |whole| {
        let last = parts.unknowns.len() - 1;
        let mass = measure::totals(whole, &parts, parts.unknowns[0]);
        let energy = measure::totals(whole, &parts, parts.unknowns[last]);
        let [pressure] = whole.max(|near| {
            let rows: Vec<_> = parts.unknowns.iter().map(|&f| near.rows(f)).collect();
            let mut most = f64::NEG_INFINITY;
            for (j, k) in near.sub_domain().rows() {
                let row: Vec<_> = rows.iter().map(|r| r.row(j as isize, k as isize)).collect();
                for x in 0..row[0].len() {
                    let at = |f: usize| row[f][x].as_f64();
                    let squared: f64 = (1..last).map(|f| at(f).powi(2)).sum();
                    let pressure = (heat_ratio - 1.0) * (at(last) - 0.5 * squared / at(0));
                    most = if -pressure > most || pressure.is_nan() { -pressure } else { most };
                }
            }
            [most]
        });
        [mass.integral, energy.integral, mass.least, -pressure]
    })
}
