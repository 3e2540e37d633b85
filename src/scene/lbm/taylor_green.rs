//! Taylor-Green vortices on a lattice.

use finegrain_framework::Simulation;
use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Grid;
use finegrain_lbm::mesh::time_step_of_mach;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{Compiled, Fluid, Mesh, Physics, Start, measure};

use super::{Final, Flow, LbmScene};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::taylor_green::{self, TaylorGreen};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [super::LATTICE, super::MACH.with_default(0.05)];
    [&taylor_green::PARAMETERS[..], &super::without_eddies(), &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T>, SceneError> {
    let scene = TaylorGreen::new(parameters);
    let spacing = 1.0 / scene.resolution;
    let n = scene.resolution as usize;
    let mesh = Mesh {
        shape: [n, n, if scene.dims == 3 { n } else { 1 }],
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_mach(spacing, 1.0, parameters.number("mach")),
        periodic: [true; 3],
    };
    let fluid =
        Fluid { density: 1.0, kinematic_viscosity: 1.0 / scene.reynolds, largest_speed: 1.0 };
    let start = Start {
        velocity: Box::new(move |x| scene.velocity(x, 0.0)),
        pressure: Box::new(move |x| scene.pressure(x)),
    };
    super::scene(
        Vortices { scene },
        &mesh,
        fluid,
        &Physics::default(),
        &super::scheme(parameters, super::lattice(parameters, scene.dims), false),
        &start,
        super::description("taylor-green", parameters, precision),
    )
}

struct Vortices {
    scene: TaylorGreen,
}

impl<T: Compiled> Flow<T> for Vortices {
    fn end_time(&self) -> f64 {
        1.0
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let parts = parts.clone();
        let columns =
            ["kinetic_energy", "largest_speed", "momentum_x", "momentum_y", "excess_mass"];
        run.monitor("flow", Every::Time(0.02), columns, move |whole| {
            let totals = measure::totals(whole, &parts);
            let [x, y, _] = totals.momentum;
            let speed = measure::largest_speed(whole, &parts);
            [totals.kinetic_energy, speed, x, y, totals.excess_mass]
        })
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        lbm: &Final<T>,
    ) {
        let time = summary.time;
        let history = summary.histories[0].column("kinetic_energy");
        let (Some(first), true) = (history.and_then(|mut energy| energy.next()), time > 0.0) else {
            return;
        };
        let last = measure::totals(&mut simulation.whole(), &lbm.parts).kinetic_energy;
        let velocities = lbm.sites().map(|site| {
            let [u, v, _] = lbm.velocity(simulation, site);
            (lbm.position(site), [u, v])
        });
        self.scene.judge(report, time, [first, last], velocities);
        if self.scene.dims == 3 {
            let history = &summary.histories[0];
            let energy: Vec<f64> =
                history.column("kinetic_energy").map(Iterator::collect).unwrap_or_default();
            self.scene.judge_dissipation(report, history.times(), &energy);
        }
    }

    fn title(&self) -> String {
        self.scene.title()
    }
}
