//! The shear wave on a lattice.

use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Grid;
use finegrain_lbm::mesh::time_step_of_relaxation_time;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{Compiled, Fluid, Mesh, Physics, Start, measure};

use super::{Final, Flow, LbmScene};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::shear_wave::{self, ShearWave};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [super::LATTICE, super::RELAXATION_TIME];
    let dim = [Parameter::integer("dim", 2, [2, 3], "dimensions")];
    [&shear_wave::PARAMETERS[..], &super::without_eddies(), &own, &dim].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T>, SceneError> {
    let scene = ShearWave::new(parameters);
    let dims = parameters.number("dim") as usize;
    let spacing = 1.0 / scene.resolution;
    let n = scene.resolution as usize;
    let mesh = Mesh {
        shape: [n, n, if dims == 3 { n } else { 1 }],
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_relaxation_time(
            spacing,
            scene.viscosity(),
            parameters.number("relaxation_time"),
        ),
        periodic: [true; 3],
    };
    let fluid = Fluid { density: 1.0, kinematic_viscosity: scene.viscosity(), largest_speed: 1.0 };
    let lattice = super::lattice(parameters, dims);
    super::scene(
        Wave { scene },
        &mesh,
        fluid,
        &Physics::default(),
        &super::scheme(parameters, lattice, false),
        &Start::with_velocity(move |x| scene.velocity(x)),
        super::description("shear-wave", parameters, precision),
    )
}

struct Wave {
    scene: ShearWave,
}

impl<T: Compiled> Flow<T> for Wave {
    fn end_time(&self) -> f64 {
        0.5 * self.scene.decay_time()
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let parts = parts.clone();
        let every = Every::Time(0.05 * self.scene.decay_time());
        run.monitor("flow", every, ["kinetic_energy", "excess_mass"], move |whole| {
            let totals = measure::totals(whole, &parts);
            [totals.kinetic_energy, totals.excess_mass]
        })
    }

    /// `viscosity`, from the kinetic energy at the beginning and the end.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        lbm: &Final<T>,
    ) {
        let history = summary.histories[0].column("kinetic_energy");
        let Some(first) = history.and_then(|mut energy| energy.next()) else { return };
        if summary.time > 0.0 {
            let last = measure::totals(&mut simulation.whole(), &lbm.parts).kinetic_energy;
            let decays = (first / last).ln() / 2.0;
            let exact = self.scene.viscosity();
            let viscosity = exact * decays * self.scene.decay_time() / summary.time;
            report.result("viscosity", viscosity, Some(exact));
        }
    }

    fn title(&self) -> String {
        format!("Decaying wave of shear, Re = {}", self.scene.reynolds)
    }
}
