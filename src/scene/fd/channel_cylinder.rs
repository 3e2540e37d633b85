//! The cylinder in a channel by finite differences: the parabola is the velocity on the first faces, the outflow is half-way
//! between the last layer of cells and the one before.
//!
//! With a multiple of 41 points across cells are squares and lie the same above and below the cylinder's centre: the
//! lift at Re = 20 is a part in 500 of the drag.

use finegrain_fd::{Compiled, FlowEnd, Mesh, Parts, Side, StaggeredOrder, measure};
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::shape::Shape;
use finegrain_framework::space::Grid;
use finegrain_framework::{Columns, Simulation};

use super::FdScene;
use super::incompressible::{self, Incompressible};
use crate::scene::channel_cylinder::{
    self, CENTRE, ChannelCylinder, DENSITY, DIAMETER, HEIGHT, LENGTH, Loads, VISCOSITY,
};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError, cubic};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [
        Parameter::choice(
            "integrator",
            &["euler", "rk4", "ssp-rk3", "rk2"],
            "how time is stepped: to a steady state by the cheapest, vortices by rk4",
        ),
        super::COURANT,
    ];
    [&channel_cylinder::PARAMETERS[..], &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = ChannelCylinder::new(parameters);
    let cells = (LENGTH * scene.resolution / HEIGHT).round();
    let along = Side::cells(cells as usize + 1, 0.0, LENGTH * (cells + 1.0) / cells);
    let mesh = Mesh::new([along, Side::cells(scene.resolution as usize, 0.0, HEIGHT)]);
    let mut equation = incompressible::equation(parameters, VISCOSITY, StaggeredOrder::Second);
    equation.ends[0] = [FlowEnd::Inflow, FlowEnd::Outflow];
    equation.bodies = vec![scene.body().into()];
    let fd = equation.model(&mesh, &|x| scene.inflow(x))?;
    let description = super::description("channel-cylinder", parameters, precision);
    Ok(FdScene { fd, flow: Box::new(Incompressible(CylinderFlow(scene))), description })
}

/// Steady loads change by less than this part.
const STEADY: f64 = 3e-5;

struct CylinderFlow(ChannelCylinder);

impl incompressible::Scene for CylinderFlow {
    fn end_time(&self) -> f64 {
        self.0.end_time()
    }

    fn sampling(&self) -> f64 {
        self.0.sampling()
    }

    fn bodies(&self) -> Vec<Shape> {
        vec![self.0.body()]
    }

    fn observe<T: Compiled>(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let (scene, parts) = (self.0, parts.clone());
        let every = Every::Time(scene.sampling());
        let [drag, lift, difference] = Loads::COLUMNS;
        let run =
            run.monitor("cylinder", every, [drag, lift, difference, "excess_out"], move |whole| {
                let force = measure::force_on_body(whole, &parts, 0);
                let [drag, lift] = [0, 1].map(|a| scene.coefficient(DENSITY * force[a]));
                [
                    drag,
                    lift,
                    pressure_difference(whole.columns, &parts),
                    excess(whole.columns, &parts),
                ]
            });
        run.stop_when(every, |_, histories| Loads::new(&histories[1]).are_steady(STEADY))
    }

    /// Beside the loads `excess_out`: what leaves over what comes in, less one.
    fn judge<T: Compiled>(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        self.0.judge(report, &Loads::new(&summary.histories[1]), STEADY);
        report.result("excess_out", excess(simulation.columns(), parts), None);
    }

    fn title(&self) -> String {
        self.0.title()
    }
}

/// Pressure at the foremost point of the cylinder less that at its rearmost, Pa: on cubics along the middle through four
/// columns of cells, which begin one to two spacings from the surface.
fn pressure_difference<T: Compiled>(columns: &Columns, parts: &Parts<T>) -> f64 {
    let (mesh, pressure) = (&parts.mesh, columns.values(parts.derived[0]));
    let (first, spacing) = (mesh.position([0; 3])[0], mesh.spacing()[0]);
    let at = |side: f64| {
        let surface = (CENTRE[0] + side * 0.5 * DIAMETER - first) / spacing;
        let nearest = side * (side * surface + 1.0).ceil();
        let weights = cubic::weights(-1.0 - side * (nearest - surface));
        let columns = [0.0, 1.0, 2.0, 3.0].map(|further| nearest + side * further);
        let terms = columns.into_iter().zip(weights).map(|(column, weight)| {
            let point = [first + column * spacing, CENTRE[1]];
            weight * incompressible::interpolated(mesh, None, pressure, point)
        });
        terms.sum::<f64>()
    };
    DENSITY * (at(-1.0) - at(1.0))
}

/// What leaves over what comes in, less one.
fn excess<T: Compiled>(columns: &Columns, parts: &Parts<T>) -> f64 {
    let (velocity, nx) = (columns.values(parts.unknowns[0]), parts.mesh.shape()[0]);
    let through =
        |face: usize| velocity.iter().skip(face).step_by(nx).map(|u| u.as_f64()).sum::<f64>();
    through(nx - 1) / through(0) - 1.0
}
