//! The double shear layer on a lattice.

use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Grid;
use finegrain_lbm::mesh::time_step_of_mach;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{Compiled, Fluid, LatticeKind, Mesh, Physics, Start, measure};

use super::{Final, Flow, LbmScene};
use crate::scene::double_shear_layer::{self, DoubleShearLayer, Plane};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [super::MACH];
    [&double_shear_layer::PARAMETERS[..], &super::COLLISION, &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T>, SceneError> {
    let scene = DoubleShearLayer::new(parameters);
    let spacing = 1.0 / scene.resolution;
    let n = scene.resolution as usize;
    let mesh = Mesh {
        shape: [n, n, 1],
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_mach(spacing, 1.0, parameters.number("mach")),
        periodic: [true; 3],
    };
    let fluid = Fluid { density: 1.0, kinematic_viscosity: scene.viscosity(), largest_speed: 1.0 };
    super::scene(
        Layers { scene },
        &mesh,
        fluid,
        &Physics::default(),
        &super::scheme(parameters, LatticeKind::D2Q9, false),
        &Start::with_velocity(move |x| scene.velocity(x)),
        super::description("double-shear-layer", parameters, precision),
    )
}

struct Layers {
    scene: DoubleShearLayer,
}

impl<T: Compiled> Flow<T> for Layers {
    fn end_time(&self) -> f64 {
        1.0
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let parts = parts.clone();
        let columns = ["kinetic_energy", "largest_speed", "excess_mass"];
        run.monitor("flow", Every::Time(0.02), columns, move |whole| {
            let totals = measure::totals(whole, &parts);
            let speed = measure::largest_speed(whole, &parts);
            [totals.kinetic_energy, speed, totals.excess_mass]
        })
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        lbm: &Final<T>,
    ) {
        let velocity = |site| {
            let [u, v, _] = lbm.velocity(simulation, site);
            [u, v]
        };
        let plane = Plane {
            side: self.scene.resolution as usize,
            velocity: lbm.sites().map(velocity).collect(),
        };
        self.scene.judge(report, summary.time, &plane);
    }

    fn title(&self) -> String {
        self.scene.title()
    }
}
