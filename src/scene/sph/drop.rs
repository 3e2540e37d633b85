//! The drops in SPH: a square lattice cut to a disc.
//!
//! The defaults: the pressure is positive throughout, so that particles need nothing against
//! tension. Without shifting the lattice is drawn out with the drop, to rows four times as far
//! apart as their particles: the short semi-axis of the elliptic drop then ends 5 % too long
//! (40 particles along the radius), with it 0.7 %. The delta-SPH diffusion keeps the pressure
//! smooth, and a little artificial viscosity damps the sound that the stepped edge of the lattice
//! makes. A wider kernel lets shifting raise the energy of the oscillating drop by 0.2 %; with this
//! one it is 0.06 %.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Simulation, VectorField, Whole};
use finegrain_sph::{Fields, Fluid, Physics, Sph, Start, measure};

use super::{Flow, SphScene, free_surface};
use crate::scene::drop::{self, Drop};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Prepared, Report, SceneError};

/// All parameters of the elliptic drop.
pub fn elliptic_parameters() -> Vec<Parameter> {
    // c = 1400 m/s where the edge of the elliptic drop moves at 100 m/s, as Monaghan (1994).
    let mach = ("mach", 1.0 / 14.0);
    free_surface::parameters(
        &[&drop::PARAMETERS],
        &[mach, ("smoothing_ratio", 1.5), ("artificial_viscosity", 0.01)],
        &[("shifting", "on")],
    )
}

/// All parameters of the oscillating drop.
pub fn oscillating_parameters() -> Vec<Parameter> {
    elliptic_parameters()
}

/// Prepares the elliptic drop.
pub fn prepare_elliptic(
    parameters: &Parameters,
    precision: Precision,
) -> Result<Box<dyn Prepared>, SceneError> {
    prepare("elliptic-drop", Drop::elliptic(parameters), parameters, precision)
}

/// Prepares the oscillating drop.
pub fn prepare_oscillating(
    parameters: &Parameters,
    precision: Precision,
) -> Result<Box<dyn Prepared>, SceneError> {
    prepare("oscillating-drop", Drop::oscillating(parameters), parameters, precision)
}

fn prepare(
    name: &str,
    drop: Drop,
    parameters: &Parameters,
    precision: Precision,
) -> Result<Box<dyn Prepared>, SceneError> {
    let description = super::description(name, parameters, precision);
    Ok(match precision {
        Precision::F32 => Box::new(build::<f32, f32>(drop, parameters, description)?),
        Precision::F64 => Box::new(build::<f64, f64>(drop, parameters, description)?),
        Precision::Mixed => Box::new(build::<f32, f64>(drop, parameters, description)?),
    })
}

fn build<T: Real, P: Real>(
    drop: Drop,
    parameters: &Parameters,
    description: String,
) -> Result<SphScene<T, P>, SceneError> {
    let spacing = drop.radius / drop.resolution;
    // The centre is between four particles.
    let half = drop.resolution as i32;
    let places = || (-half..half).map(|i| (f64::from(i) + 0.5) * spacing);
    let positions: Vec<_> = places()
        .flat_map(|y| places().map(move |x| [x, y, 0.0]))
        .filter(|x| x[0].hypot(x[1]) < drop.radius)
        .collect();
    let start = Start {
        // The drop doubles its length.
        region: Region {
            lower: vec![-2.2 * drop.radius; 2],
            upper: vec![2.2 * drop.radius; 2],
            periodic: vec![false; 2],
        },
        spacing,
        particle_volume: spacing * spacing,
        velocities: positions.iter().map(|&x| drop.velocity(x)).collect(),
        positions,
    };
    let speed = drop.strain_rate * drop.radius;
    let fluid = Fluid {
        density: drop.density,
        sound_speed: speed / parameters.number("mach"),
        kinematic_viscosity: 0.0,
        state_equation: free_surface::state_equation(parameters),
    };
    let has_force = drop.frequency > 0.0;
    let physics = Physics {
        acceleration_field: has_force.then(|| VectorField::new(move |x, _| drop.acceleration(x))),
        ..Physics::default()
    };
    let scheme = free_surface::scheme(parameters, speed);
    let mut sph = Sph::<T, P>::new(&start, &fluid, &physics, &scheme)?;
    free_surface::set_pressure(&mut sph, &fluid, &start.positions, |x| drop.pressure(x));
    Ok(SphScene { sph, flow: Box::new(DropFlow { drop, fluid }), description })
}

struct DropFlow {
    drop: Drop,
    fluid: Fluid,
}

/// Semi-axes of the ellipse with the particles' second moments.
fn semi_axes<T: Real, P: Real>(whole: &mut Whole<'_, Cells<P>>, fields: &Fields<T, P>) -> [f64; 2] {
    let sums = whole.sum(|near| {
        let mut sums = [0.0; 2];
        for (sum, &position) in sums.iter_mut().zip(&fields.position) {
            let x = near.state(position).own().whole();
            *sum = x.iter().map(|x| x.as_f64().powi(2)).sum();
        }
        sums
    });
    let points = whole.columns.points() as f64;
    sums.map(|sum| 2.0 * (sum / points).sqrt())
}

impl<T: Real, P: Real> Flow<T, P> for DropFlow {
    /// When the elliptic drop is twice as long as at the beginning, about; two periods of the
    /// oscillating one.
    fn end_time(&self) -> f64 {
        if self.drop.frequency > 0.0 { 2.02 * self.drop.period() } else { 0.0076 }
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let every = Every::Time(Flow::<T, P>::end_time(self) / 400.0);
        let (drop, watched) = (self.drop, fields.clone());
        let run = free_surface::monitor_energy(run, every, fields, self.fluid, mass, move |x| {
            drop.potential(x)
        });
        let columns = ["semi_axis_x", "semi_axis_y", "momentum_x", "momentum_y", "largest_speed"];
        run.monitor("drop", every, columns, move |whole| {
            let [a, b] = semi_axes(whole, &watched);
            let [x, y, _] = measure::totals(whole, &watched, mass).momentum;
            [a, b, x, y, measure::largest_speed(whole, &watched)]
        })
    }

    /// `semi_axis_x` and `semi_axis_y` at the end; `period` from the moments when the drop is
    /// round; `energy_growth` and `energy_change` over the energy at the beginning.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        _: f64,
    ) {
        let exact = self.drop.ellipse(summary.time).semi_axes;
        let [a, b] = semi_axes(&mut simulation.whole(), fields);
        report.result("semi_axis_x", a, Some(exact[0]));
        report.result("semi_axis_y", b, Some(exact[1]));
        let (energy, drop) = (&summary.histories[0], &summary.histories[1]);
        let first = |name| energy.column(name).and_then(|mut column| column.next());
        let (Some(kinetic), Some(potential)) = (first("kinetic_energy"), first("potential_energy"))
        else {
            return;
        };
        free_surface::judge_energy(report, &summary.histories, kinetic + potential);
        let (Some(a), Some(b)) = (drop.column("semi_axis_x"), drop.column("semi_axis_y")) else {
            return;
        };
        let excess: Vec<f64> = a.zip(b).map(|(a, b)| a - b).collect();
        let times = drop.times();
        let mut round = Vec::new();
        for k in 2..excess.len() {
            if excess[k - 1] * excess[k] < 0.0 {
                let part = excess[k - 1] / (excess[k - 1] - excess[k]);
                round.push(times[k - 1] + part * (times[k] - times[k - 1]));
            }
        }
        // Round at the beginning and after every half of a period.
        if let (Some(&last), true) = (round.last(), self.drop.frequency > 0.0) {
            let period = 2.0 * last / round.len() as f64;
            report.result("period", period, Some(self.drop.period()));
        }
    }

    fn title(&self) -> String {
        if self.drop.frequency > 0.0 { "Oscillating drop" } else { "Elliptic drop" }.to_owned()
    }

    fn spacing(&self) -> f64 {
        self.drop.radius / self.drop.resolution
    }
}
