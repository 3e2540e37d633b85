//! The double shear layer by finite differences.

use finegrain_fd::{Compiled, Mesh, Parts, Side};
use finegrain_framework::Simulation;
use finegrain_framework::run::Summary;
use finegrain_framework::space::Grid;

use super::FdScene;
use super::incompressible::{self, Incompressible};
use crate::scene::double_shear_layer::{self, DoubleShearLayer, Plane};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [incompressible::ORDER, super::INTEGRATOR, super::COURANT];
    [&double_shear_layer::PARAMETERS[..], &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = DoubleShearLayer::new(parameters);
    let mesh = Mesh::new([Side::periodic(scene.resolution as usize, 0.0, 1.0); 2]);
    let order = incompressible::order(parameters);
    let equation = incompressible::equation(parameters, scene.viscosity(), order);
    let fd = equation.model(&mesh, &|x| scene.velocity(x))?;
    let description = super::description("double-shear-layer", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Incompressible(scene)), description })
}

impl incompressible::Scene for DoubleShearLayer {
    fn end_time(&self) -> f64 {
        1.0
    }

    fn sampling(&self) -> f64 {
        0.02
    }

    fn judge<T: Compiled>(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        let velocities = incompressible::velocities(simulation, parts);
        let plane = Plane {
            side: self.resolution as usize,
            velocity: velocities.map(|(_, [u, v, _])| [u, v]).collect(),
        };
        self.judge(report, summary.time, &plane);
    }

    fn title(&self) -> String {
        self.title()
    }
}
