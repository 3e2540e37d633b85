//! Couette and Poiseuille flow on a lattice: a periodic strip between two walls that lie half-way
//! between sites.

use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::shape::Shape;
use finegrain_framework::space::Grid;
use finegrain_lbm::mesh::time_step_of_relaxation_time;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{Body, Compiled, Fluid, LatticeKind, Mesh, Physics, Start, measure};

use super::{Final, Flow, LbmScene};
use crate::scene::channel::{self, Channel, DENSITY, Drive, GAP, SPEED, TIME, VISCOSITY};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// Length of the periodic strip, in spacings: the flow does not vary along it.
const LENGTH: usize = 20;

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [super::WALL, super::RELAXATION_TIME];
    [&channel::PARAMETERS[..], &super::slow_collision(), &own].concat()
}

prepare_with!(prepare_couette: build, Drive::Couette);
prepare_with!(prepare_poiseuille: build, Drive::Poiseuille);

fn build<T: Compiled>(
    drive: Drive,
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T>, SceneError> {
    let scene = Channel::new(drive, parameters);
    let spacing = GAP / scene.resolution;
    let relaxation_time = parameters.number("relaxation_time");
    let mesh = Mesh {
        shape: [LENGTH, scene.resolution as usize, 1],
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_relaxation_time(spacing, VISCOSITY, relaxation_time),
        periodic: [true, false, true],
    };
    let fluid = Fluid { density: DENSITY, kinematic_viscosity: VISCOSITY, largest_speed: SPEED };
    let plate = |y: f64, up: f64, velocity: f64| Body {
        shape: Shape::HalfSpace { point: [0.0, y, 0.0], outward: [0.0, up, 0.0] },
        surface_velocity: [velocity, 0.0, 0.0],
    };
    let physics = Physics {
        body_acceleration: [scene.body_acceleration(), 0.0, 0.0],
        bodies: vec![plate(0.0, 1.0, 0.0), plate(GAP, -1.0, scene.plate_velocity())],
        ..Physics::default()
    };
    super::scene(
        ChannelFlow { scene },
        &mesh,
        fluid,
        &physics,
        &super::scheme(parameters, LatticeKind::D2Q9, true),
        &Start::default(),
        super::description(drive.scene(), parameters, precision),
    )
}

struct ChannelFlow {
    scene: Channel,
}

impl<T: Compiled> Flow<T> for ChannelFlow {
    fn end_time(&self) -> f64 {
        TIME
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let parts = parts.clone();
        let columns = ["velocity_x", "velocity_y", "largest_speed", "excess_mass"];
        run.monitor("flow", Every::Time(0.02 * TIME), columns, move |whole| {
            let totals = measure::totals(whole, &parts);
            let [x, y, _] = totals.flow.map(|flow| flow / totals.volume);
            [x, y, measure::largest_speed(whole, &parts), totals.excess_mass]
        })
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        lbm: &Final<T>,
    ) {
        if summary.time <= 0.0 {
            return;
        }
        let profile = lbm.sites().map(|site| {
            let [u, v, _] = lbm.velocity(simulation, site);
            (lbm.position(site)[1], [u, v])
        });
        self.scene.judge(report, summary.time, profile);
    }

    fn title(&self) -> String {
        self.scene.title()
    }
}
