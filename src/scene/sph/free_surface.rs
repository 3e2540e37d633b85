//! What the scenes with a free surface share: parameters, the scheme they name, and monitors of
//! energy and regularity.

use finegrain_framework::run::{Every, History, Run};
use finegrain_framework::space::Cells;
use finegrain_framework::{Real, Simulation, Whole};
use finegrain_sph::{
    ArtificialViscosity, DensityDiffusion, DiffusionForm, Fields, Fluid, Scheme, Stabilisation,
    StateEquation, measure,
};

use crate::scene::Report;
use crate::scene::parameter::{Parameter, Parameters};

/// Parameters of the discretisation besides those of all liquids.
const PARAMETERS: [Parameter; 6] = [
    Parameter::choice("state_equation", &["tait", "linear"], "pressure from density"),
    Parameter::number("artificial_viscosity", 0.0, [0.0, 10.0], "", "alpha of Monaghan (1992)"),
    Parameter::choice(
        "density_diffusion",
        &["antuono", "fourtakas", "molteni-colagrossi", "none"],
        "Antuono et al. (2010), Fourtakas et al. (2019) or Molteni & Colagrossi (2009)",
    ),
    Parameter::number("delta", 0.1, [0.0, 1.0], "", "strength of the density diffusion"),
    Parameter::choice(
        "tension",
        &["none", "control", "artificial-pressure"],
        "against clumping under tension: Sun et al. (2018) or Monaghan (2000)",
    ),
    Parameter::choice("shifting", &["off", "on"], "shifting of particles, Sun et al. (2017)"),
];

/// All parameters of a scene with a free surface, with its own defaults put over those that are
/// shared; unless it has another, the kernel is Wendland's C2 (1995).
pub(super) fn parameters(
    own: &[&[Parameter]],
    numbers: &[(&str, f64)],
    choices: &[(&str, &'static str)],
) -> Vec<Parameter> {
    let shared: [&[Parameter]; 2] = [&super::LIQUID_PARAMETERS, &PARAMETERS];
    let choices = [choices, &[("kernel", "wendland-c2")]].concat();
    super::with_defaults(&[own, &shared].concat(), numbers, &choices)
}

/// The scheme that the parameters name, for a flow with this largest speed, m/s.
pub(super) fn scheme(parameters: &Parameters, speed: f64) -> Scheme {
    let alpha = parameters.number("artificial_viscosity");
    let form = match parameters.choice("density_diffusion") {
        "antuono" => Some(DiffusionForm::Antuono),
        "molteni-colagrossi" => Some(DiffusionForm::MolteniColagrossi),
        "fourtakas" => Some(DiffusionForm::Fourtakas),
        _ => None,
    };
    let tension = parameters.choice("tension");
    Scheme {
        stabilisation: Stabilisation {
            artificial_viscosity: (alpha > 0.0).then_some(ArtificialViscosity { alpha, beta: 0.0 }),
            density_diffusion: form
                .map(|form| DensityDiffusion { form, delta: parameters.number("delta") }),
            artificial_pressure: (tension == "artificial-pressure").then_some(0.2),
            tensile_control: tension == "control",
            shifting: (parameters.choice("shifting") == "on").then_some(speed),
            repulsion: None,
        },
        ..super::liquid_scheme(parameters)
    }
}

/// The equation of state that the parameters name.
pub(super) fn state_equation(parameters: &Parameters) -> StateEquation {
    match parameters.choice("state_equation") {
        "linear" => StateEquation::Linear { background: 0.0 },
        _ => StateEquation::Tait { exponent: 7.0, background: 0.0 },
    }
}

/// Gives particles the density that goes with a pressure, so that they start without sound.
pub(super) fn set_pressure<T: Real, P: Real>(
    sph: &mut finegrain_sph::Sph<T, P>,
    fluid: &Fluid,
    positions: &[[f64; 3]],
    pressure: impl Fn([f64; 3]) -> f64,
) {
    let density = sph.model.columns.values_mut(sph.fields.density);
    for (density, &x) in density.iter_mut().zip(positions) {
        let rho = fluid.state_equation.density(pressure(x), fluid.density, fluid.sound_speed);
        *density = T::of(rho);
    }
}

/// Monitors energy, `potential` being that of the body force per mass, J/kg.
pub(super) fn monitor_energy<T: Real, P: Real>(
    run: Run<Cells<P>>,
    every: Every,
    fields: &Fields<T, P>,
    fluid: Fluid,
    mass: f64,
    potential: impl Fn([f64; 3]) -> f64 + Send + Sync + Clone + 'static,
) -> Run<Cells<P>> {
    let fields = fields.clone();
    let columns = ["kinetic_energy", "potential_energy", "elastic_energy", "total_energy"];
    run.monitor("energy", every, columns, move |whole| {
        let energies = measure::energies(whole, &fields, &fluid, mass, potential.clone());
        [energies.kinetic, energies.potential, energies.elastic, energies.total()]
    })
}

/// How much the total energy grew at most after any moment, over the energy `scale`; and its
/// change from the beginning to the end.
pub(super) fn energy_changes(histories: &[History], scale: f64) -> Option<[f64; 2]> {
    let history = histories.iter().find(|history| history.name() == "energy")?;
    let energy: Vec<f64> = history.column("total_energy")?.collect();
    let (mut least, mut growth) = (f64::INFINITY, 0.0f64);
    for &e in &energy {
        least = least.min(e);
        growth = growth.max(e - least);
    }
    Some([growth / scale, (energy.last()? - energy.first()?) / scale])
}

/// Adds `energy_growth` and `energy_change`, over the energy `scale`.
pub(super) fn judge_energy(report: &mut Report, histories: &[History], scale: f64) {
    if let Some([growth, change]) = energy_changes(histories, scale) {
        report.result("energy_growth", growth, None);
        report.result("energy_change", change, None);
    }
}

/// Mean pressure of the fluid within `radius` of a point, Pa; NaN if there is none.
pub(super) fn pressure_near<T: Real, P: Real>(
    whole: &mut Whole<'_, Cells<P>>,
    fields: &Fields<T, P>,
    fluid: &Fluid,
    point: [f64; 3],
    radius: f64,
) -> f64 {
    let [sum, count] = whole.sum(|near| {
        let density = near.state(fields.density).own().whole();
        let mut sums = [0.0; 2];
        for i in 0..density.len() {
            let mut squared = 0.0;
            for (&position, at) in fields.position.iter().zip(point) {
                squared += (near.state(position).own().whole()[i].as_f64() - at).powi(2);
            }
            if squared < radius * radius {
                let (rho, c) = (density[i].as_f64(), fluid.sound_speed);
                sums[0] += fluid.state_equation.pressure(rho, fluid.density, c);
                sums[1] += 1.0;
            }
        }
        sums
    });
    sum / count
}

/// Area of the holes in a flow in the plane over the area of the fluid: what is further than
/// `radius` from all particles and not connected to the outside.
pub(super) fn voids<T: Real, P: Real>(
    simulation: &Simulation<Cells<P>>,
    fields: &Fields<T, P>,
    spacing: f64,
    radius: f64,
) -> f64 {
    let columns = simulation.columns();
    let points: Vec<[f64; 2]> = (0..columns.points())
        .map(|i| [0, 1].map(|a| columns.values(fields.position[a])[i].as_f64()))
        .collect();
    let pixel = 0.2 * spacing;
    let lower = [0, 1].map(|a| points.iter().fold(f64::INFINITY, |low, x| low.min(x[a])));
    let upper = [0, 1].map(|a| points.iter().fold(f64::NEG_INFINITY, |high, x| high.max(x[a])));
    // A margin all around, so that the outside is connected.
    let reach = (radius / pixel).ceil() as isize;
    let margin = reach + 2;
    let place = |x: f64, a: usize| ((x - lower[a]) / pixel).round() as isize + margin;
    let [columns, rows] = [0, 1].map(|a| (place(upper[a], a) + margin + 1) as usize);
    let mut is_taken = vec![false; columns * rows];
    for x in &points {
        let [i, j] = [0, 1].map(|a| place(x[a], a));
        for dj in -reach..=reach {
            for di in -reach..=reach {
                let at = [(i + di - margin) as f64, (j + dj - margin) as f64];
                let [dx, dy] = [0, 1].map(|a| lower[a] + at[a] * pixel - x[a]);
                if dx * dx + dy * dy <= radius * radius {
                    is_taken[(j + dj) as usize * columns + (i + di) as usize] = true;
                }
            }
        }
    }
    let mut waiting = vec![0];
    while let Some(k) = waiting.pop() {
        if std::mem::replace(&mut is_taken[k], true) {
            continue;
        }
        let (i, j) = (k % columns, k / columns);
        waiting.extend((i > 0).then(|| k - 1));
        waiting.extend((i + 1 < columns).then_some(k + 1));
        waiting.extend((j > 0).then(|| k - columns));
        waiting.extend((j + 1 < rows).then_some(k + columns));
    }
    let holes = is_taken.iter().filter(|&&taken| !taken).count();
    holes as f64 * pixel * pixel / (points.len() as f64 * spacing * spacing)
}
