//! Heat in a box by central differences.

use finegrain_fd::{Compiled, Heat, Parts, measure};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Grid;

use super::{FdScene, Flow};
use crate::figure::Axis;
use crate::scene::heat::{self, DIFFUSIVITY, HeatBox, TIME};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    [&heat::PARAMETERS[..], &[super::ORDER, super::INTEGRATOR, super::COURANT]].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T, Spreading>, SceneError> {
    let scene = HeatBox::new(parameters);
    let (mesh, boundary) = super::unit_box(scene.dims, scene.resolution, scene.ends);
    let equation = Heat {
        diffusivity: DIFFUSIVITY,
        order: super::order(parameters),
        integrator: super::integrator(parameters),
        boundary,
    };
    let longest = parameters.number("courant") * equation.time_step_limit(&mesh)?;
    let start = move |x| scene.temperature(x, 0.0);
    let fd = equation.model(&mesh, super::dividing(TIME, longest), &start)?;
    let description = super::description("heat", parameters, precision);
    Ok(FdScene { fd, flow: Spreading { scene }, description })
}

struct Spreading {
    scene: HeatBox,
}

impl<T: Compiled> Flow<T> for Spreading {
    fn end_time(&self) -> f64 {
        TIME
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let parts = parts.clone();
        let columns = ["heat", "largest", "smallest"];
        run.monitor("temperature", Every::Time(0.02 * TIME), columns, move |whole| {
            let totals = measure::totals(whole, &parts, parts.unknowns[0]);
            [totals.integral, totals.most, totals.least]
        })
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
        let title = format!("{}, t = {time:.3} s", self.scene.title());
        let quantity = Axis::new("temperature").unit("K");
        super::picture(simulation, parts, title, quantity, |x| self.scene.temperature(x, time))
    }
}
