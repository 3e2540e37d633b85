//! The cylinder on a lattice.

use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Stopped, Summary};
use finegrain_framework::space::Grid;
use finegrain_lbm::mesh::time_step_of_relaxation_time;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{Compiled, Fluid, Mesh, Physics, Start, measure};

use super::{Final, Flow, LbmScene};
use crate::scene::cylinder::{self, Cylinder, DENSITY, SIDE};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [super::LATTICE, super::WALL, super::RELAXATION_TIME];
    [&cylinder::PARAMETERS[..], &super::slow_collision(), &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T>, SceneError> {
    let scene = Cylinder::new(parameters);
    let spacing = SIDE / scene.resolution;
    let n = scene.resolution as usize;
    let relaxation_time = parameters.number("relaxation_time");
    let mesh = Mesh {
        // In 3-D a slab of six layers, within which the flow does not vary.
        shape: [n, n, if scene.dims == 3 { 6 } else { 1 }],
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_relaxation_time(spacing, scene.viscosity, relaxation_time),
        periodic: [true; 3],
    };
    let fluid = Fluid {
        density: DENSITY,
        kinematic_viscosity: scene.viscosity,
        // In the gap between cylinders.
        largest_speed: 3.0 * scene.creeping_velocity(),
    };
    let physics = Physics {
        body_acceleration: [scene.body_acceleration, 0.0, 0.0],
        bodies: vec![scene.body([SIDE; 3]).into()],
        ..Physics::default()
    };
    // Steps in which the mean flow is compared: what rounding leaves must not count.
    let tolerance = 1e-7f64.max(100.0 * T::epsilon().as_f64());
    super::scene(
        CylinderFlow {
            scene,
            tolerance,
            volume: mesh.cell_volume(scene.dims) * mesh.sites() as f64,
        },
        &mesh,
        fluid,
        &physics,
        &super::scheme(parameters, super::lattice(parameters, scene.dims), true),
        &Start::default(),
        super::description("cylinder", parameters, precision),
    )
}

struct CylinderFlow {
    scene: Cylinder,
    /// Relative change of the mean velocity below which the flow is steady.
    tolerance: f64,
    /// Volume of the whole cell, m^3 (m^2 in 2-D).
    volume: f64,
}

impl<T: Compiled> Flow<T> for CylinderFlow {
    fn end_time(&self) -> f64 {
        60.0 * self.scene.relaxation_time()
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let every = Every::Time(self.scene.relaxation_time() / 3.0);
        let columns = [
            "velocity_x",
            "velocity_y",
            "velocity_z",
            "kinetic_energy",
            "largest_speed",
            "force_x",
            "excess_mass",
        ];
        let (parts, volume, tolerance) = (parts.clone(), self.volume, self.tolerance);
        run.monitor("flow", every, columns, move |whole| {
            let totals = measure::totals(whole, &parts);
            let [x, y, z] = totals.flow.map(|flow| flow / volume);
            let [force, ..] = measure::force_on_body(whole, &parts, 0);
            let speed = measure::largest_speed(whole, &parts);
            [x, y, z, totals.kinetic_energy, speed, force, totals.excess_mass]
        })
        .stop_when(every, move |_, histories| cylinder::is_steady(histories, tolerance))
    }

    /// `drag_k` from the mean velocity, and `momentum_balance`: the force on the cylinder over the
    /// body force on the fluid around it, less one.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        lbm: &Final<T>,
    ) {
        let totals = measure::totals(&mut simulation.whole(), &lbm.parts);
        let [x, y, z] = totals.flow.map(|flow| flow / self.volume);
        if x == 0.0 {
            return;
        }
        let is_steady = summary.stopped == Stopped::Criterion;
        self.scene.judge(report, [x, y, z], [SIDE; 2], is_steady);
        let [force, ..] = measure::force_on_body(&mut simulation.whole(), &lbm.parts, 0);
        let driving = self.scene.body_acceleration * totals.mass;
        cylinder::judge_momentum(report, force, driving, is_steady);
        if is_steady {
            let middle = 0.5 * SIDE;
            let stations = self.scene.reference_profiles().iter();
            let points = stations.map(|station| [middle + station.x, middle + station.y]);
            let found = points.map(|point| lbm.interpolated_velocity(simulation, point));
            self.scene.judge_profiles(report, found);
        }
        report.result("relative_excess_mass", totals.excess_mass / totals.mass, None);
    }

    fn title(&self) -> String {
        self.scene.title()
    }
}
