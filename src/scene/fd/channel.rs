//! Couette and Poiseuille flow by finite differences: a short periodic strip between two walls.

use finegrain_fd::{Compiled, FlowEnd, Mesh, Parts, Side, StaggeredOrder};
use finegrain_framework::Simulation;
use finegrain_framework::run::Summary;
use finegrain_framework::space::Grid;

use super::FdScene;
use super::incompressible::{self, Incompressible};
use crate::scene::channel::{self, Channel, Drive, GAP, TIME, VISCOSITY};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// Length of the periodic strip, in spacings: the flow does not vary along it.
const LENGTH: usize = 8;

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    [&channel::PARAMETERS[..], &[super::INTEGRATOR, super::COURANT]].concat()
}

prepare_with!(prepare_couette: build, Drive::Couette);
prepare_with!(prepare_poiseuille: build, Drive::Poiseuille);

fn build<T: Compiled>(
    drive: Drive,
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = Channel::new(drive, parameters);
    let length = GAP * LENGTH as f64 / scene.resolution;
    let across = Side::cells(scene.resolution as usize, 0.0, GAP);
    let mesh = Mesh::new([Side::periodic(LENGTH, 0.0, length), across]);
    let mut equation = incompressible::equation(parameters, VISCOSITY, StaggeredOrder::Second);
    equation.acceleration[0] = scene.body_acceleration();
    equation.ends[1][1] = FlowEnd::Wall([scene.plate_velocity(), 0.0, 0.0]);
    let fd = equation.model(&mesh, &|_| [0.0; 3])?;
    let description = super::description(drive.scene(), parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Incompressible(scene)), description })
}

impl incompressible::Scene for Channel {
    fn end_time(&self) -> f64 {
        TIME
    }

    fn sampling(&self) -> f64 {
        0.02 * TIME
    }

    fn judge<T: Compiled>(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        if summary.time <= 0.0 {
            return;
        }
        let velocities = incompressible::velocities(simulation, parts);
        let profile = velocities.map(|([_, y, _], [u, v, _])| (y, [u, v]));
        self.judge(report, summary.time, profile);
    }

    fn title(&self) -> String {
        self.title()
    }
}
