//! The lid-driven cavity on a lattice, with walls half-way between sites.

use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Stopped, Summary};
use finegrain_framework::shape::Shape;
use finegrain_framework::space::Grid;
use finegrain_lbm::mesh::time_step_of_mach;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{Body, Compiled, Fluid, LatticeKind, Mesh, Physics, Start, measure};

use super::{Final, Flow, LbmScene};
use crate::scene::cavity::{self, Cavity, Extrema};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::peak;
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [super::WALL, super::MACH];
    [&cavity::PARAMETERS[..], &super::COLLISION, &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T>, SceneError> {
    let scene = Cavity::new(parameters);
    let spacing = 1.0 / scene.resolution;
    let n = scene.resolution as usize;
    let mesh = Mesh {
        shape: [n, n, 1],
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_mach(spacing, 1.0, parameters.number("mach")),
        periodic: [false, false, true],
    };
    let fluid = Fluid { density: 1.0, kinematic_viscosity: scene.viscosity(), largest_speed: 1.0 };
    let wall = |point: [f64; 3], outward: [f64; 3]| Shape::HalfSpace { point, outward };
    let lid = wall([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
    let physics = Physics {
        bodies: vec![
            wall([0.0; 3], [1.0, 0.0, 0.0]).into(),
            wall([0.0; 3], [0.0, 1.0, 0.0]).into(),
            wall([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]).into(),
            Body { shape: lid, surface_velocity: [1.0, 0.0, 0.0] },
        ],
        ..Physics::default()
    };
    super::scene(
        CavityFlow { scene },
        &mesh,
        fluid,
        &physics,
        &super::scheme(parameters, LatticeKind::D2Q9, true),
        &Start::default(),
        super::description("cavity", parameters, precision),
    )
}

struct CavityFlow {
    scene: Cavity,
}

impl<T: Compiled> Flow<T> for CavityFlow {
    /// Long after it should be steady.
    fn end_time(&self) -> f64 {
        50.0 + self.scene.reynolds
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let parts = parts.clone();
        let columns = ["kinetic_energy", "largest_speed", "excess_mass"];
        let scene = self.scene;
        run.monitor("flow", Every::Time(1.0), columns, move |whole| {
            let totals = measure::totals(whole, &parts);
            let speed = measure::largest_speed(whole, &parts);
            [totals.kinetic_energy, speed, totals.excess_mass]
        })
        .stop_when(Every::Time(1.0), move |_, histories| scene.is_steady(histories, 5e-5))
    }

    /// Extrema of the velocity on the lines through the middle.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        lbm: &Final<T>,
    ) {
        let n = self.scene.resolution as usize;
        // Between two sites, unless there is one in the middle.
        let middle = [(n - 1) / 2, n / 2];
        let mean = |site: &dyn Fn(usize) -> [usize; 3], a: usize| -> f64 {
            0.5 * middle.iter().map(|&m| lbm.velocity(simulation, site(m))[a]).sum::<f64>()
        };
        let u: Vec<f64> = (0..n).map(|y| mean(&|x| [x, y, 0], 0)).collect();
        let v: Vec<f64> = (0..n).map(|x| mean(&|y| [x, y, 0], 1)).collect();
        let is_steady = summary.stopped == Stopped::Criterion;
        if !is_steady {
            report.notes.push("not steady: no errors are given".to_owned());
        }
        let [(_, u_min), (_, v_max), (_, v_min)] =
            [peak::least(&u), peak::largest(&v), peak::least(&v)];
        let found = Extrema { u_min, v_max, v_min };
        self.scene.judge(report, &found, is_steady);
    }

    fn title(&self) -> String {
        self.scene.title()
    }
}
