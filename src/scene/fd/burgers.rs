//! Burgers' equation by differences of values on faces, and viscosity by central ones of sixth order.

use finegrain_fd::{Boundary, Burgers, Compiled, Condition, Mesh, Parts, Side};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Grid;

use super::{FdScene, Flow};
use crate::figure::Axis;
use crate::scene::burgers::{self, Steepening, TIME, VISCOSITY};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let integrator = super::INTEGRATOR.with_default_choice("ssp-rk3");
    [&burgers::PARAMETERS[..], &[super::FACE, integrator, super::COURANT]].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = Steepening::new(parameters);
    let mesh = Mesh::new([Side::cells(scene.resolution, -1.0, 1.0)]);
    let equation = Burgers {
        viscosity: VISCOSITY,
        face: super::face(parameters),
        integrator: super::integrator(parameters),
        boundary: Boundary::all(Condition::dirichlet(0.0)),
    };
    let longest = parameters.number("courant") * equation.time_step_limit(&mesh, 1.0)?;
    let start = move |x: [f64; 3]| scene.start(x[0]);
    let fd = equation.model(&mesh, super::dividing(TIME, longest), &start)?;
    let description = super::description("burgers", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Wave { scene }), description })
}

struct Wave {
    scene: Steepening,
}

impl<T: Compiled> Flow<T> for Wave {
    fn end_time(&self) -> f64 {
        TIME
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let parts = parts.clone();
        let every = Every::Time(1e-3 * TIME);
        run.monitor("slope", every, ["largest_slope"], move |whole| {
            let h = parts.mesh.spacing()[0];
            let [slope] = whole.max(|near| {
                let row = near.rows(parts.unknowns[0]).row(0, 0);
                let u = |i: usize| row[i].as_f64();
                // Of sixth order.
                let slope = |i: usize| {
                    let pairs = [(1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0)];
                    pairs.iter().map(|&(k, a)| a * (u(i + k) - u(i - k))).sum::<f64>() / h
                };
                [(3..row.len() - 3).map(|i| slope(i).abs()).fold(0.0, f64::max)]
            });
            [slope]
        })
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
        let history = &summary.histories[0];
        let slopes = history.column("largest_slope").into_iter().flatten();
        let slopes = history.times().iter().copied().zip(slopes);
        let velocities = super::values(simulation, parts, 0).map(|(x, u)| (x[0], u));
        self.scene.judge(report, summary.time, velocities, slopes);
    }

    fn picture(&self, simulation: &Simulation<Grid>, parts: &Parts<T>) -> Picture {
        let time = simulation.clock().time();
        let quantity = Axis::new("velocity").unit("m/s");
        super::picture(simulation, parts, "Burgers' equation".to_owned(), quantity, |x| {
            match time > 0.0 {
                true => self.scene.velocity(x[0], time),
                false => self.scene.start(x[0]),
            }
        })
    }
}
