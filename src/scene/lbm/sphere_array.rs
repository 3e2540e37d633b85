//! The array of spheres on a lattice, with an interpolated surface.

use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Stopped, Summary};
use finegrain_framework::space::Grid;
use finegrain_lbm::mesh::time_step_of_relaxation_time;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{Compiled, Fluid, Mesh, Physics, Start, measure};

use super::{Final, Flow, LbmScene};
use crate::scene::cylinder;
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::sphere_array::{self, BODY_ACCELERATION, DENSITY, SIDE, SphereArray, VISCOSITY};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [super::LATTICE, super::WALL, super::RELAXATION_TIME];
    [&sphere_array::PARAMETERS[..], &super::slow_collision(), &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T>, SceneError> {
    let scene = SphereArray::new(parameters);
    let spacing = SIDE / scene.resolution;
    let relaxation_time = parameters.number("relaxation_time");
    let mesh = Mesh {
        shape: [scene.resolution as usize; 3],
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_relaxation_time(spacing, VISCOSITY, relaxation_time),
        periodic: [true; 3],
    };
    let fluid = Fluid {
        density: DENSITY,
        kinematic_viscosity: VISCOSITY,
        // Between spheres.
        largest_speed: 4.0 * scene.creeping_velocity(),
    };
    let physics = Physics {
        body_acceleration: [BODY_ACCELERATION, 0.0, 0.0],
        bodies: vec![scene.body().into()],
        ..Physics::default()
    };
    let tolerance = 1e-6f64.max(100.0 * T::epsilon().as_f64());
    super::scene(
        SphereFlow { scene, tolerance },
        &mesh,
        fluid,
        &physics,
        &super::scheme(parameters, super::lattice(parameters, 3), true),
        &Start::default(),
        super::description("sphere-array", parameters, precision),
    )
}

struct SphereFlow {
    scene: SphereArray,
    /// Relative change of the mean velocity below which the flow is steady.
    tolerance: f64,
}

impl<T: Compiled> Flow<T> for SphereFlow {
    fn end_time(&self) -> f64 {
        40.0 * self.scene.relaxation_time()
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let every = Every::Time(self.scene.relaxation_time() / 3.0);
        let columns = ["velocity_x", "velocity_y", "velocity_z", "force_x", "excess_mass"];
        let (parts, tolerance) = (parts.clone(), self.tolerance);
        run.monitor("flow", every, columns, move |whole| {
            let totals = measure::totals(whole, &parts);
            let [x, y, z] = totals.flow.map(|flow| flow / SIDE.powi(3));
            let [force, ..] = measure::force_on_body(whole, &parts, 0);
            [x, y, z, force, totals.excess_mass]
        })
        .stop_when(every, move |_, histories| cylinder::is_steady(histories, tolerance))
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        lbm: &Final<T>,
    ) {
        let totals = measure::totals(&mut simulation.whole(), &lbm.parts);
        let velocity = totals.flow.map(|flow| flow / SIDE.powi(3));
        if velocity[0] == 0.0 {
            return;
        }
        let is_steady = summary.stopped == Stopped::Criterion;
        self.scene.judge(report, velocity, is_steady);
        let [force, ..] = measure::force_on_body(&mut simulation.whole(), &lbm.parts, 0);
        cylinder::judge_momentum(report, force, BODY_ACCELERATION * totals.mass, is_steady);
    }

    fn title(&self) -> String {
        self.scene.title()
    }
}
