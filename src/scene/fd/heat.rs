//! Heat in a box by central differences.

use finegrain_fd::{Boundary, Compiled, Condition, Data, Heat, Parts, Side, TimeStepping, measure};
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Grid;
use finegrain_framework::{Integrator, Simulation};

use super::{FdScene, Flow};
use crate::figure::Axis;
use crate::scene::heat::{self, DIFFUSIVITY, HeatBox, Heating, TIME};
use crate::scene::parameter::{Parameter, ParameterError, Parameters};
use crate::scene::report::Picture;
use crate::scene::{Precision, Report, SceneError};

/// How time is stepped.
const INTEGRATOR: Parameter = Parameter::choice(
    "integrator",
    &["rk4", "ssp-rk3", "rk2", "euler", "backward-euler", "crank-nicolson", "bdf2"],
    "how time is stepped; the last three are implicit and need the cargo feature `implicit`",
);

const COURANT: Parameter = Parameter::number(
    "courant",
    0.8,
    [1e-4, 1e6],
    "",
    "time step over the longest that is stable, at most 1; of implicit steps, over that of euler",
);

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    [&heat::PARAMETERS[..], &[super::ORDER, INTEGRATOR, COURANT]].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = HeatBox::new(parameters)?;
    let (mesh, boundary) = match scene.heating {
        Heating::Wave(ends) | Heating::Step(ends) => {
            super::unit_box(scene.dims, scene.resolution, ends)
        }
        Heating::Driven => {
            let side = Side::ends(scene.resolution, 0.0, 1.0);
            let driven = Data::varying(move |x, time| scene.temperature(x, time));
            (super::in_directions(side, scene.dims), Boundary::all(Condition::Dirichlet(driven)))
        }
    };
    let integrator = parameters.choice("integrator").parse();
    let integrator = integrator.unwrap_or(TimeStepping::Explicit(Integrator::Rk4));
    let equation =
        Heat { diffusivity: DIFFUSIVITY, order: super::order(parameters), integrator, boundary };
    let courant = parameters.number("courant");
    let limited = match integrator {
        TimeStepping::Explicit(_) if courant > 1.0 => {
            return Err(past_stability(courant, parameters.choice("integrator")).into());
        }
        TimeStepping::Explicit(_) => equation.clone(),
        TimeStepping::Implicit(_) => {
            Heat { integrator: Integrator::Euler.into(), ..equation.clone() }
        }
    };
    let longest = courant * limited.time_step_limit(&mesh)?;
    let start = move |x| scene.temperature(x, 0.0);
    let fd = equation.model(&mesh, super::dividing(TIME, longest), &start)?;
    let description = super::description("heat", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Spreading { scene }), description })
}

fn past_stability(courant: f64, integrator: &str) -> ParameterError {
    ParameterError::Invalid {
        name: "courant",
        value: courant.to_string(),
        range: format!("at most 1 with integrator = {integrator}; more takes an implicit one"),
    }
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
        let quantity = Axis::new("temperature").unit("K");
        super::picture(simulation, parts, self.scene.title(), quantity, |x| {
            self.scene.temperature(x, time)
        })
    }
}
