//! The cylinder by finite differences.

use finegrain_fd::{Compiled, Mesh, Parts, Side, StaggeredOrder, measure};
use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Stopped, Summary};
use finegrain_framework::shape::Shape;
use finegrain_framework::space::Grid;

use super::FdScene;
use super::incompressible::{self, Incompressible};
use crate::scene::cylinder::{self, Cylinder, DENSITY, SIDE};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [
        Parameter::integer("dim", 2, [2, 2], "dimensions: bodies take two"),
        Parameter::choice(
            "integrator",
            &["euler", "rk4", "ssp-rk3", "rk2"],
            "how time is stepped: to a steady state by the cheapest",
        ),
        super::COURANT,
    ];
    [&cylinder::PARAMETERS[1..], &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<FdScene<T>, SceneError> {
    let scene = Cylinder::new(parameters);
    let mesh = Mesh::new([Side::periodic(scene.resolution as usize, 0.0, SIDE); 2]);
    let mut equation =
        incompressible::equation(parameters, scene.viscosity, StaggeredOrder::Second);
    equation.acceleration[0] = scene.body_acceleration;
    equation.bodies = vec![scene.body([SIDE; 3]).into()];
    let fd = equation.model(&mesh, &|_| [0.0; 3])?;
    let description = super::description("cylinder", parameters, precision);
    // Steps in which the mean flow is compared: what rounding leaves must not count.
    let tolerance = 1e-7f64.max(100.0 * T::epsilon().as_f64());
    Ok(FdScene {
        fd,
        flow: Box::new(Incompressible(CylinderFlow { scene, tolerance })),
        description,
    })
}

struct CylinderFlow {
    scene: Cylinder,
    /// Relative change of the mean velocity below which the flow is steady.
    tolerance: f64,
}

/// Without divergence, the mean over the cell, in the cylinder, too, is what goes through each line across it.
fn mean_velocity<T: Compiled>(
    whole: &mut finegrain_framework::Whole<'_, Grid>,
    parts: &Parts<T>,
) -> [f64; 3] {
    incompressible::momentum(whole, parts).map(|flow| flow / (SIDE * SIDE))
}

impl incompressible::Scene for CylinderFlow {
    fn end_time(&self) -> f64 {
        60.0 * self.scene.relaxation_time()
    }

    fn sampling(&self) -> f64 {
        self.scene.relaxation_time() / 3.0
    }

    fn bodies(&self) -> Vec<Shape> {
        vec![self.scene.body([SIDE; 3])]
    }

    fn observe<T: Compiled>(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let (parts, tolerance) = (parts.clone(), self.tolerance);
        let every = Every::Time(incompressible::Scene::sampling(self));
        let columns = ["velocity_x", "velocity_y", "force_x", "force_y"];
        run.monitor("cylinder", every, columns, move |whole| {
            let [u, v, _] = mean_velocity(whole, &parts);
            let [x, y, _] = measure::force_on_body(whole, &parts, 0).map(|force| DENSITY * force);
            [u, v, x, y]
        })
        .stop_when(every, move |_, histories| cylinder::is_steady(&histories[1..], tolerance))
    }

    /// `drag_k` from the mean velocity, and `momentum_balance`: the force on the cylinder over the body force on
    /// the fluid around it, less one.
    fn judge<T: Compiled>(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        let velocity = mean_velocity(&mut simulation.whole(), parts);
        if velocity[0] == 0.0 {
            return;
        }
        let is_steady = summary.stopped == Stopped::Criterion;
        self.scene.judge(report, velocity, [SIDE; 2], is_steady);
        let [force, ..] = measure::force_on_body(&simulation.whole(), parts, 0);
        let fluid = SIDE * SIDE * (1.0 - self.scene.solid_fraction);
        cylinder::judge_momentum(report, force, self.scene.body_acceleration * fluid, is_steady);
        if is_steady {
            let stations = self.scene.reference_profiles().iter();
            let found = stations.map(|station| {
                interpolated(simulation, parts, [0.5 * SIDE + station.x, 0.5 * SIDE + station.y])
            });
            self.scene.judge_profiles(report, found);
        }
    }

    fn title(&self) -> String {
        self.scene.title()
    }
}

/// Velocity at a point, m/s.
fn interpolated<T: Compiled>(
    simulation: &Simulation<Grid>,
    parts: &Parts<T>,
    point: [f64; 2],
) -> [f64; 2] {
    [0, 1].map(|axis| {
        let values = simulation.columns().values(parts.unknowns[axis]);
        incompressible::interpolated(&parts.mesh, Some(axis), values, point)
    })
}
