//! Taylor-Green vortices in SPH.
//!
//! By default pressure evolves by itself (EDAC, Ramachandran & Puri 2019) and a transport velocity
//! (Adami, Hu & Adams 2013) keeps particles even, ten times as strong as theirs: with a weaker one
//! the vortices decay too fast, probably by the unevenness of particles that the strain along the
//! stagnation lines brings about, and with one half as strong again they lose their order. This was
//! chosen at Re = 100 on 50 x 50 particles, from a lattice and from one disturbed start. With the
//! Wendland kernel particles do not pair (Dehnen & Aly 2012), which they do with a quintic spline, at
//! any Reynolds number. The density-weighted pressure gradient keeps momentum to round-off; those that
//! do without a mean pressure are as accurate with a weaker drift, but do not.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::{Real, Simulation, State};
use finegrain_sph::{Fields, Fluid, Packing, Physics, Sph, Start, measure};

use super::{Flow, SphScene};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::taylor_green::{self, TaylorGreen};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [Parameter::number(
        "disturbance",
        0.2,
        [0.0, 0.5],
        "",
        "largest random displacement from the lattice at the start, in spacings",
    )];
    super::with_defaults(
        &[&taylor_green::PARAMETERS, &super::LIQUID_PARAMETERS, &super::PARAMETERS, &own],
        &[("transport", 10.0), ("smoothing_ratio", 2.0)],
        &[
            ("kernel", "wendland-c4"),
            ("viscous_form", "adami"),
            ("density", "summation"),
            ("pressure", "edac"),
            ("pressure_form", "density-weighted"),
        ],
    )
}

prepare_with!(build);

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let scene = TaylorGreen::new(parameters);
    let spacing = 1.0 / scene.resolution;
    let packing = if scene.dims == 2 { Packing::Square } else { Packing::Cubic };
    let lattice = packing.fit([1.0; 3], spacing)?;
    let positions: Vec<_> =
        lattice.displaced_positions(parameters.number("disturbance"), 1).collect();
    let start = Start {
        velocities: positions.iter().map(|&x| scene.velocity(x, 0.0)).collect(),
        positions,
        ..super::cylinder::start(scene.dims, &lattice, spacing)
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 1.0 / parameters.number("mach"),
        kinematic_viscosity: 1.0 / scene.reynolds,
        state_equation: super::state_equation(parameters),
    };
    let physics = Physics { viscosity: Some(super::viscosity(parameters)), ..Physics::default() };
    let mut sph = Sph::<T, P>::new(&start, &fluid, &physics, &super::scheme(parameters))?;
    // Density that goes with the pressure of the vortices, so that they start without sound.
    if scene.dims == 2 {
        let density = sph.model.columns.values_mut(sph.fields.density);
        for (density, &x) in density.iter_mut().zip(&start.positions) {
            *density = T::of(1.0 + scene.pressure(x) / fluid.sound_speed.powi(2));
        }
        if let Some(pressure) = sph.fields.pressure {
            for (p, &x) in sph.model.columns.values_mut(pressure).iter_mut().zip(&start.positions) {
                *p = T::of(scene.pressure(x));
            }
        }
    }
    let description = super::description("taylor-green", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(Vortices { scene }), description })
}

struct Vortices {
    scene: TaylorGreen,
}

impl<T: Real, P: Real> Flow<T, P> for Vortices {
    fn end_time(&self) -> f64 {
        1.0
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let fields = fields.clone();
        let columns = ["kinetic_energy", "largest_speed", "momentum_x", "momentum_y"];
        run.monitor("flow", Every::Time(0.02), columns, move |whole| {
            let totals = measure::totals(whole, &fields, mass);
            let [x, y, _] = totals.momentum;
            [totals.kinetic_energy, measure::largest_speed(whole, &fields), x, y]
        })
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        mass: f64,
    ) {
        let time = summary.time;
        let history = summary.histories[0].column("kinetic_energy");
        let (Some(first), true) = (history.and_then(|mut energy| energy.next()), time > 0.0) else {
            return;
        };
        let last = measure::totals(&mut simulation.whole(), fields, mass).kinetic_energy;
        let columns = simulation.columns();
        let value = |column: State<T>, i: usize| columns.values(column)[i].as_f64();
        let velocities = (0..columns.points()).map(|i| {
            let mut x = [0.0; 3];
            for (x, &position) in x.iter_mut().zip(&fields.position) {
                *x = columns.values(position)[i].as_f64();
            }
            (x, [0, 1].map(|a| value(fields.velocity[a], i)))
        });
        self.scene.judge(report, time, [first, last], velocities);
    }

    fn title(&self) -> String {
        self.scene.title()
    }

    fn spacing(&self) -> f64 {
        1.0 / self.scene.resolution
    }
}
