//! Taylor-Green vortices by finite differences.

use finegrain_fd::{Compiled, Parts, Side};
use finegrain_framework::Simulation;
use finegrain_framework::run::Summary;
use finegrain_framework::space::Grid;

use super::FdScene;
use super::incompressible::{self, Incompressible};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::taylor_green::{self, TaylorGreen};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [incompressible::ORDER, super::INTEGRATOR, super::COURANT];
    [&taylor_green::PARAMETERS[..], &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = TaylorGreen::new(parameters);
    let side = Side::periodic(scene.resolution as usize, 0.0, 1.0);
    let mesh = super::in_directions(side, scene.dims);
    let order = incompressible::order(parameters);
    let equation = incompressible::equation(parameters, 1.0 / scene.reynolds, order);
    let fd = equation.model(&mesh, &|x| scene.velocity(x, 0.0))?;
    let description = super::description("taylor-green", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Incompressible(scene)), description })
}

impl incompressible::Scene for TaylorGreen {
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
        let history = &summary.histories[0];
        let energy: Vec<f64> =
            history.column("kinetic_energy").map(Iterator::collect).unwrap_or_default();
        let (Some(&first), true) = (energy.first(), summary.time > 0.0) else { return };
        let [last, _] = incompressible::energy_and_speed(&mut simulation.whole(), parts);
        let velocities = incompressible::velocities(simulation, parts);
        let velocities = velocities.map(|(position, [u, v, _])| (position, [u, v]));
        self.judge(report, summary.time, [first, last], velocities);
        if self.dims == 3 {
            self.judge_dissipation(report, history.times(), &energy);
        }
    }

    fn title(&self) -> String {
        self.title()
    }
}
