//! Riemann problems by WENO.

use finegrain_fd::{Compiled, Gas, GasEnd, Mesh, Parts, Side};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Run, Summary};
use finegrain_framework::space::Grid;

use super::{FdScene, Flow, gas};
use crate::figure::Axis;
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::toro::{self, Toro};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    [&toro::PARAMETERS[..], &[gas::COURANT]].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = Toro::new(parameters);
    let mesh = Mesh::new([Side::cells(scene.resolution, 0.0, 1.0)]);
    let equation = Gas {
        heat_ratio: scene.tube.heat_ratio,
        courant: parameters.number("courant"),
        ends: [[GasEnd::Open; 2]; 2],
    };
    let fd = equation.model(&mesh, &|x| gas::state(scene.exact(x[0], 0.0)))?;
    let description = super::description("toro", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Tube { scene }), description })
}

struct Tube {
    scene: Toro,
}

impl<T: Compiled> Flow<T> for Tube {
    fn end_time(&self) -> f64 {
        self.scene.end_time
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        gas::observe(run, parts, self.scene.tube.heat_ratio)
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        if summary.time <= 0.0 {
            return;
        }
        let gases = gas::gases(simulation, parts, self.scene.tube.heat_ratio);
        let least = ["least_density", "least_pressure"].map(|name| {
            let history = summary.histories[0].column(name).into_iter().flatten();
            history.fold(f64::INFINITY, f64::min)
        });
        self.scene.judge(report, summary.time, gases.into_iter(), least);
    }

    fn picture(&self, simulation: &Simulation<Grid>, parts: &Parts<T>) -> Picture {
        let time = simulation.clock().time();
        let quantity = Axis::new("density").unit("kg/m^3");
        super::picture(simulation, parts, self.scene.title(), quantity, |x| {
            self.scene.exact(x[0], time).density
        })
    }
}
