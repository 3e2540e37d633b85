//! Zalesak's disk by differences of values on faces.

use finegrain_fd::{Advection, Boundary, Compiled, Condition, Mesh, Parts, Side};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Run, Summary};
use finegrain_framework::space::Grid;

use super::{FdScene, Flow};
use crate::figure::Axis;
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::zalesak::{self, Zalesak};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let integrator = super::INTEGRATOR.with_default_choice("ssp-rk3");
    [&zalesak::PARAMETERS[..], &[super::FACE, integrator, super::COURANT]].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = Zalesak::new(parameters);
    let mesh = Mesh::new([Side::cells(scene.resolution, 0.0, 1.0); 2]);
    let equation = Advection {
        face: super::face(parameters),
        integrator: super::integrator(parameters),
        boundary: Boundary::all(Condition::dirichlet(0.0)),
    };
    let fastest = std::f64::consts::PI;
    let limit = equation.time_step_limit(&mesh, [fastest, fastest, 0.0])?;
    let time_step = super::dividing(scene.turns, parameters.number("courant") * limit);
    let (velocity, disk) = (move |x| scene.velocity(x), move |x| scene.disk(x));
    let fd = equation.model(&mesh, time_step, &velocity, &disk)?;
    let description = super::description("zalesak", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Turning { scene }), description })
}

struct Turning {
    scene: Zalesak,
}

impl<T: Compiled> Flow<T> for Turning {
    fn end_time(&self) -> f64 {
        self.scene.turns
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        super::advection::monitor(run, parts, self.scene.turns)
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        let turns = summary.time;
        if turns > 0.0 && (turns - turns.round()).abs() < 1e-9 {
            self.scene.judge(report, super::values(simulation, parts, 0));
        }
    }

    fn picture(&self, simulation: &Simulation<Grid>, parts: &Parts<T>) -> Picture {
        let exact = |x| self.scene.disk(x);
        super::picture(simulation, parts, self.scene.title(), Axis::new("quantity"), exact)
    }
}
