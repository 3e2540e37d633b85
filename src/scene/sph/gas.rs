//! What gas scenes in SPH have in common.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::{Integrator, Real, Simulation};
use finegrain_sph::{
    Fields, Fluid, Physics, Scheme, ShockCapturing, Smoothing, Sph, Start, StateEquation, measure,
};

use crate::figure::{Axis, Chart};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Report, SceneError};

/// Parameters of the discretisation of a gas.
pub(super) const PARAMETERS: [Parameter; 6] = [
    Parameter::choice(
        "kernel",
        &[
            "wendland-c4",
            "wendland-c2",
            "wendland-c6",
            "cubic-spline",
            "quartic-spline",
            "quintic-spline",
        ],
        "smoothing kernel",
    ),
    Parameter::number(
        "smoothing_ratio",
        1.5,
        [0.8, 4.0],
        "",
        "smoothing length over the spacing that goes with the density",
    ),
    Parameter::number("shock_viscosity", 1.0, [0.0, 10.0], "", "alpha of Monaghan (1997)"),
    Parameter::number("conductivity", 1.0, [0.0, 10.0], "", "alpha_u of Price (2008)"),
    Parameter::choice("integrator", &["leapfrog", "rk2", "ssp-rk3", "rk4"], "how time is stepped"),
    Parameter::number("courant", 0.5, [1e-3, 10.0], "", "fraction of the time step limits"),
];

/// A gas of particles of one mass; `thinnest` is the spacing of the thinnest gas, m, and `energies`
/// are the specific internal energies at the start.
pub(super) fn build<T: Real, P: Real>(
    parameters: &Parameters,
    start: &Start,
    heat_ratio: f64,
    thinnest: f64,
    densities: &[f64],
    energies: &[f64],
) -> Result<Sph<T, P>, SceneError> {
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 1.0,
        kinematic_viscosity: 0.0,
        state_equation: StateEquation::IdealGas { heat_ratio },
    };
    let physics = Physics {
        energy: true,
        shock_capturing: Some(ShockCapturing {
            viscosity: parameters.number("shock_viscosity"),
            conductivity: parameters.number("conductivity"),
            ..ShockCapturing::default()
        }),
        ..Physics::default()
    };
    let smoothing_ratio = parameters.number("smoothing_ratio");
    let scheme = Scheme {
        kernel: super::kernel(parameters),
        smoothing_ratio,
        smoothing: Smoothing::Adaptive { longest: smoothing_ratio * thinnest },
        integrator: parameters.choice("integrator").parse().unwrap_or(Integrator::Leapfrog),
        courant_number: parameters.number("courant"),
        ..Scheme::default()
    };
    let mut sph = Sph::<T, P>::new(start, &fluid, &physics, &scheme)?;
    let columns = &mut sph.model.columns;
    for (density, &given) in columns.values_mut(sph.fields.density).iter_mut().zip(densities) {
        *density = T::of(given);
    }
    if let Some(energy) = sph.fields.energy {
        for (energy, &given) in columns.values_mut(energy).iter_mut().zip(energies) {
            *energy = T::of(given);
        }
    }
    Ok(sph)
}

/// Monitors energies and momentum.
pub(super) fn observe<T: Real, P: Real>(
    run: Run<Cells<P>>,
    fields: &Fields<T, P>,
    mass: f64,
    every: f64,
) -> Run<Cells<P>> {
    let fields = fields.clone();
    let columns = ["total_energy", "kinetic_energy", "internal_energy", "momentum_x"];
    run.monitor("energy", Every::Time(every), columns, move |whole| {
        let totals = measure::totals(whole, &fields, mass);
        let (kinetic, internal) = (totals.kinetic_energy, totals.internal_energy);
        [kinetic + internal, kinetic, internal, totals.momentum[0]]
    })
}

/// Adds `energy_drift`: the largest change of the total energy at any time, relative to that at the
/// beginning.
pub(super) fn judge_energy<T: Real, P: Real>(
    report: &mut Report,
    summary: &Summary,
    simulation: &mut Simulation<Cells<P>>,
    fields: &Fields<T, P>,
    mass: f64,
) {
    let totals = measure::totals(&mut simulation.whole(), fields, mass);
    let last = totals.kinetic_energy + totals.internal_energy;
    let history = summary.histories[0].column("total_energy").into_iter().flatten();
    let history: Vec<f64> = history.chain([last]).collect();
    let drift = history.iter().map(|e| (e / history[0] - 1.0).abs()).fold(0.0, f64::max);
    report.error("energy_drift", drift);
}

/// A chart of the density along a line, in at most 150 pieces, with the exact one.
pub(super) fn chart(
    title: String,
    x: Axis,
    mut points: Vec<[f64; 2]>,
    exact: impl Fn(f64) -> f64,
) -> Chart {
    points.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
    let mean = |piece: &[[f64; 2]], k: usize| {
        piece.iter().map(|point| point[k]).sum::<f64>() / piece.len() as f64
    };
    let piece = points.len().div_ceil(150).max(1);
    let shown: Vec<_> = points.chunks(piece).map(|p| [mean(p, 0), mean(p, 1)]).collect();
    let (low, high) = match (points.first(), points.last()) {
        (Some(first), Some(last)) => (first[0], last[0]),
        _ => (0.0, 0.0),
    };
    let line = (0..=1000).map(|k| {
        let x = low + (high - low) * f64::from(k) / 1000.0;
        [x, exact(x)]
    });
    Chart::new(title)
        .x(x)
        .y(Axis::new("density").unit("kg/m^3"))
        .series("SPH", shown)
        .reference("exact", line)
}
