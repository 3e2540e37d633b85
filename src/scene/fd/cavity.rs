//! The lid-driven cavity by finite differences.

use finegrain_fd::{Compiled, FlowEnd, Mesh, Parts, Side};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Stopped, Summary};
use finegrain_framework::space::Grid;

use super::FdScene;
use super::incompressible::{self, Incompressible};
use crate::scene::cavity::{self, Cavity, Extrema};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError, cubic, peak};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let order = Parameter::choice(
        "order",
        &["2", "4"],
        "of advection and diffusion three points or more from the walls; all else is of order 2",
    );
    [&cavity::PARAMETERS[..], &[order, super::INTEGRATOR, super::COURANT]].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = Cavity::new(parameters);
    let mesh = Mesh::new([Side::cells(scene.resolution as usize, 0.0, 1.0); 2]);
    let order = incompressible::order(parameters);
    let mut equation = incompressible::equation(parameters, scene.viscosity(), order);
    equation.ends[1][1] = FlowEnd::Wall([1.0, 0.0, 0.0]);
    let fd = equation.model(&mesh, &|_| [0.0; 3])?;
    let description = super::description("cavity", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Incompressible(scene)), description })
}

impl incompressible::Scene for Cavity {
    /// Long after it should be steady.
    fn end_time(&self) -> f64 {
        50.0 + self.reynolds
    }

    fn sampling(&self) -> f64 {
        1.0
    }

    fn observe<T: Compiled>(&self, run: Run<Grid>, _: &Parts<T>) -> Run<Grid> {
        let scene = *self;
        run.stop_when(Every::Time(1.0), move |_, histories| scene.is_steady(histories, 2e-5))
    }

    fn judge<T: Compiled>(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        let n = self.resolution as usize;
        // Faces half-way or, if there are none, the two next to it.
        let middle = [n / 2, n.div_ceil(2)];
        let profile = |a: usize| -> Vec<f64> {
            let values = simulation.columns().values(parts.unknowns[a]);
            let at = |m: usize, k: usize| if a == 0 { k * n + m } else { m * n + k };
            let mean = |k: usize| middle.iter().map(|&m| 0.5 * values[at(m, k)].as_f64()).sum();
            (0..n).map(mean).collect()
        };
        let [u, v] = [profile(0), profile(1)];
        let is_steady = summary.stopped == Stopped::Criterion;
        if is_steady {
            let place = |x: f64| x * self.resolution - 0.5;
            let (u, v) = (|y| cubic::value(&u, place(y)), |x| cubic::value(&v, place(x)));
            self.judge_profiles(report, u, v);
        } else {
            report.notes.push("not steady: no errors are given".to_owned());
        }
        let [(_, u_min), (_, v_max), (_, v_min)] =
            [peak::least(&u), peak::largest(&v), peak::least(&v)];
        self.judge(report, &Extrema { u_min, v_max, v_min }, is_steady);
    }

    fn title(&self) -> String {
        self.title()
    }
}
