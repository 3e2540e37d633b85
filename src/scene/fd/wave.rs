//! Standing waves by central differences and leapfrog.

use finegrain_fd::equation::wave::energy;
use finegrain_fd::{Compiled, Parts, Wave};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Grid;

use super::{FdScene, Flow};
use crate::figure::Axis;
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::wave::{self, SPEED, StandingWaves, TIME};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    [&wave::PARAMETERS[..], &[super::ORDER, super::COURANT.with_default(0.5)]].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = StandingWaves::new(parameters);
    let (mesh, boundary) = super::unit_box(scene.dims, scene.resolution, scene.ends);
    let equation = Wave { speed: SPEED, order: super::order(parameters), boundary };
    let longest = parameters.number("courant") * equation.time_step_limit(&mesh)?;
    let time_step = super::dividing(TIME, longest);
    let fd = equation.model(&mesh, time_step, &move |x| scene.start(x), &|_| 0.0)?;
    let description = super::description("wave", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Swinging { scene, time_step }), description })
}

struct Swinging {
    scene: StandingWaves,
    time_step: f64,
}

impl<T: Compiled> Flow<T> for Swinging {
    fn end_time(&self) -> f64 {
        TIME
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let (parts, time_step) = (parts.clone(), self.time_step);
        run.monitor("energy", Every::Time(0.02 * TIME), ["energy"], move |whole| {
            [energy(whole, &parts, time_step)]
        })
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        let energies = summary.histories[0].column("energy").into_iter().flatten();
        let displacements = super::values(simulation, parts, 0);
        self.scene.judge(report, summary.time, displacements, energies);
    }

    fn picture(&self, simulation: &Simulation<Grid>, parts: &Parts<T>) -> Picture {
        let time = simulation.clock().time();
        let quantity = Axis::new("displacement").unit("m");
        super::picture(simulation, parts, self.scene.title(), quantity, |x| {
            self.scene.displacement(x, time)
        })
    }
}
