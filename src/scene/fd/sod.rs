//! Sod's shock tube by WENO.

use finegrain_fd::{Compiled, Gas, GasEnd, Mesh, Parts, Side};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Run, Summary};
use finegrain_framework::space::Grid;

use super::{FdScene, Flow, gas};
use crate::figure::Axis;
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::sod::{self, DIAPHRAGM, Sod, TUBE};
use crate::scene::{Precision, Report, SceneError, at_time};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    [&sod::PARAMETERS[..], &[gas::COURANT]].concat()
}

prepare_with!(build);

/// Rows of the tube in 2-D.
const ROWS: usize = 8;

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = Sod::new(parameters);
    let points = 2 * scene.resolution as usize;
    let along = Side::periodic(points, DIAPHRAGM - 1.0, DIAPHRAGM + 1.0);
    // The first point lies half a spacing in, as those in the middle of cells do.
    let half = 0.5 * along.spacing();
    let along = Side { lower: along.lower + half, upper: along.upper + half, ..along };
    let mesh = match scene.dims {
        1 => Mesh::new([along]),
        _ => Mesh::new([along, Side::periodic(ROWS, 0.0, ROWS as f64 * along.spacing())]),
    };
    let equation = Gas {
        heat_ratio: TUBE.heat_ratio,
        courant: parameters.number("courant"),
        ends: [[GasEnd::Open; 2]; 2],
    };
    let fd = equation.model(&mesh, &|x| gas::state(TUBE.around(x[0] - DIAPHRAGM, 0.0)))?;
    let description = super::description("sod", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Tube { scene }), description })
}

struct Tube {
    scene: Sod,
}

impl<T: Compiled> Flow<T> for Tube {
    fn end_time(&self) -> f64 {
        0.2
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        gas::observe(run, parts, TUBE.heat_ratio)
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
        let length = parts.mesh.spacing()[0];
        let gases = gas::gases(simulation, parts, TUBE.heat_ratio).into_iter();
        let inside = gases.filter(|(x, _)| (0.0..=1.0).contains(x));
        self.scene.judge(report, summary.time, inside.map(|(x, gas)| (x, length, gas)));
    }

    fn picture(&self, simulation: &Simulation<Grid>, parts: &Parts<T>) -> Picture {
        let time = simulation.clock().time();
        let title = at_time(format!("Sod's shock tube, {}-D", self.scene.dims), time);
        let quantity = Axis::new("density").unit("kg/m^3");
        // Where the tube is, and of its rows one.
        let gases = gas::gases(simulation, parts, TUBE.heat_ratio).into_iter();
        let row = gases.take(parts.mesh.shape()[0]).filter(|(x, _)| (0.0..=1.0).contains(x));
        let points = row.map(|(x, gas)| [x, gas.density]).collect();
        super::chart(title, quantity, points, |x| self.scene.exact(x, time).density).into()
    }
}
