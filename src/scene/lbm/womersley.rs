//! Flow to and fro on a lattice: a periodic strip between two walls that lie half-way between sites, or a
//! periodic piece of a pipe, whose wall is interpolated.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::Grid;
use finegrain_framework::{Simulation, VectorField};
use finegrain_lbm::mesh::time_step_of_relaxation_time;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{Compiled, Fluid, LatticeKind, Mesh, Physics, Start, measure};

use super::{Final, Flow, LbmScene};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::womersley::{self, DENSITY, GAP, SPEED, VISCOSITY, Womersley};
use crate::scene::{Precision, Report, SceneError};

/// Length of the periodic strip or pipe, in spacings: the flow does not vary along it.
const LENGTH: usize = 20;

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [super::WALL, super::RELAXATION_TIME];
    [&womersley::PARAMETERS[..], &super::slow_collision(), &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T>, SceneError> {
    let scene = Womersley::new(parameters);
    let spacing = GAP / scene.resolution;
    let relaxation_time = parameters.number("relaxation_time");
    let (across, is_pipe) = (scene.resolution as usize, scene.is_pipe);
    let mesh = Mesh {
        shape: [LENGTH, across, if is_pipe { across } else { 1 }],
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_relaxation_time(spacing, VISCOSITY, relaxation_time),
        periodic: [true, false, !is_pipe],
    };
    let fluid = Fluid { density: DENSITY, kinematic_viscosity: VISCOSITY, largest_speed: SPEED };
    let plate =
        |y: f64, up: f64| Shape::HalfSpace { point: [0.0, y, 0.0], outward: [0.0, up, 0.0] }.into();
    let lattice = if is_pipe { LatticeKind::D3Q19 } else { LatticeKind::D2Q9 };
    let pipe = Shape::Bore { axis: Axis::X, centre: [0.5 * GAP; 3], radius: 0.5 * GAP };
    let physics = Physics {
        acceleration_field: Some(VectorField::new(move |_, t| [scene.acceleration(t), 0.0, 0.0])),
        bodies: if is_pipe { vec![pipe.into()] } else { vec![plate(0.0, 1.0), plate(GAP, -1.0)] },
        ..Physics::default()
    };
    super::scene(
        ToAndFro { scene },
        &mesh,
        fluid,
        &physics,
        &super::scheme(parameters, lattice, true),
        &Start::with_velocity(move |x| [scene.velocity(distance(&scene, x), 0.0), 0.0, 0.0]),
        super::description("womersley", parameters, precision),
    )
}

/// From the middle between the plates, or of the pipe, m.
fn distance(scene: &Womersley, [_, y, z]: [f64; 3]) -> f64 {
    let [y, z] = [y, z].map(|x| x - 0.5 * GAP);
    if scene.is_pipe { y.hypot(z) } else { y }
}

struct ToAndFro {
    scene: Womersley,
}

impl<T: Compiled> Flow<T> for ToAndFro {
    fn end_time(&self) -> f64 {
        self.scene.end_time()
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let parts = parts.clone();
        let every = Every::Time(0.01 * self.scene.end_time());
        run.monitor("flow", every, ["velocity_x", "largest_speed"], move |whole| {
            let totals = measure::totals(whole, &parts);
            [totals.flow[0] / totals.volume, measure::largest_speed(whole, &parts)]
        })
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        lbm: &Final<T>,
    ) {
        let profile = lbm.sites().map(|site| {
            let distance = distance(&self.scene, lbm.position(site));
            (distance, lbm.velocity(simulation, site)[0])
        });
        let in_fluid = profile.filter(|(distance, _)| distance.abs() < 0.5 * GAP);
        self.scene.judge(report, summary.time, in_fluid);
    }

    fn title(&self) -> String {
        self.scene.title()
    }
}
