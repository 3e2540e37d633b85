//! Advection by differences of values on faces.

use finegrain_fd::{Advection, Boundary, Compiled, Condition, Parts, Side, measure};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Grid;

use super::{FdScene, Flow};
use crate::figure::Axis;
use crate::scene::advection::{self, Carried, TIME, VELOCITY};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let integrator = super::INTEGRATOR.with_default_choice("ssp-rk3");
    let own = [super::FACE, integrator, super::COURANT.with_default(0.4)];
    [&advection::PARAMETERS[..], &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = Carried::new(parameters);
    let mesh = super::in_directions(Side::periodic(scene.resolution, 0.0, 1.0), scene.dims);
    let equation = Advection {
        face: super::face(parameters),
        integrator: super::integrator(parameters),
        boundary: Boundary::all(Condition::Outflow),
    };
    let velocity = [0, 1, 2].map(|a| if a < scene.dims { VELOCITY } else { 0.0 });
    let longest = parameters.number("courant") * equation.time_step_limit(&mesh, velocity)?;
    let time_step = super::dividing(TIME, longest);
    let start = move |x| scene.quantity(x, 0.0);
    let fd = equation.model(&mesh, time_step, &move |_| velocity, &start)?;
    let description = super::description("advection", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Passing { scene }), description })
}

struct Passing {
    scene: Carried,
}

impl<T: Compiled> Flow<T> for Passing {
    fn end_time(&self) -> f64 {
        TIME
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        super::advection::monitor(run, parts, TIME)
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        self.scene.judge(report, summary.time, super::values(simulation, parts, 0));
    }

    fn picture(&self, simulation: &Simulation<Grid>, parts: &Parts<T>) -> Picture {
        let time = simulation.clock().time();
        let exact = |x| self.scene.quantity(x, time);
        super::picture(simulation, parts, self.scene.title(), Axis::new("quantity"), exact)
    }
}

/// Monitors what is carried.
pub(super) fn monitor<T: Compiled>(run: Run<Grid>, parts: &Parts<T>, time: f64) -> Run<Grid> {
    let parts = parts.clone();
    let columns = ["quantity", "largest", "smallest"];
    run.monitor("quantity", Every::Time(0.02 * time), columns, move |whole| {
        let totals = measure::totals(whole, &parts, parts.unknowns[0]);
        [totals.integral, totals.most, totals.least]
    })
}
