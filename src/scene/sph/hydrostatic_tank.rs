//! The hydrostatic tank in SPH.
//!
//! The defaults: the diffusion of density that knows the gradient of the density keeps it where the
//! surface cuts off the sums, and artificial viscosity brings to rest what particles do while
//! they settle from the lattice.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::{Real, Simulation};
use finegrain_sph::{Fields, Fluid, Sph};

use super::{Flow, SphScene, free_surface, tank};
use crate::scene::hydrostatic_tank::{self, DEPTH, HydrostaticTank};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    free_surface::parameters(
        &[&hydrostatic_tank::PARAMETERS, &tank::PARAMETERS],
        &[("smoothing_ratio", 2.0), ("artificial_viscosity", 0.1)],
        &[],
    )
}

prepare_with!(build);

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let mut scene = HydrostaticTank::new(parameters);
    let spacing = DEPTH / scene.resolution;
    scene.tank = tank::fit(scene.tank, spacing);
    let fluid = tank::water(parameters, scene.speed() / parameters.number("mach"));
    let scheme = tank::scheme(parameters, scene.speed());
    let mut start = tank::start(&scene.tank, spacing, &scheme, |x| x[1] < DEPTH);
    let positions = start.positions.clone();
    tank::settle(&mut start, &scene.tank, DEPTH, fluid.sound_speed);
    let mut sph = Sph::<T, P>::new(&start, &fluid, &tank::physics(&scene.tank), &scheme)?;
    free_surface::set_pressure(&mut sph, &fluid, &positions, |x| scene.pressure(x[1].min(DEPTH)));
    let description = super::description("hydrostatic-tank", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(TankFlow { scene, fluid }), description })
}

struct TankFlow {
    scene: HydrostaticTank,
    fluid: Fluid,
}

impl<T: Real, P: Real> Flow<T, P> for TankFlow {
    fn end_time(&self) -> f64 {
        50.0 * self.scene.time()
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let every = Every::Time(0.1 * self.scene.time());
        tank::monitor(run, every, fields, self.fluid, mass, self.scene.tank)
    }

    /// `largest_speed` over `sqrt(g H)`: the largest in the last tenth of the time; `speed_trend`,
    /// that over the largest in the first half of the run, below 1 where it falls;
    /// `pressure_l2`, the error over that at the bottom; `through_walls`.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        _: f64,
    ) {
        let water = &summary.histories[1];
        let column = |name| water.column(name).map(Iterator::collect::<Vec<f64>>);
        let most = |values: &[f64]| values.iter().fold(0.0, |most: f64, &x| most.max(x));
        if let Some(speeds) = column("largest_speed") {
            let tenth = (speeds.len() / 10).max(1);
            let last = most(&speeds[speeds.len() - tenth..]);
            let early = most(&speeds[..speeds.len() / 2]);
            report.result("largest_speed", last / self.scene.speed(), None);
            report.result("speed_trend", last / early, None);
        }
        tank::judge_walls(report, &summary.histories);
        let columns = simulation.columns();
        let (mut squared, mut count) = (0.0, 0.0);
        for i in 0..columns.points() {
            if fields.wall_depth.is_some_and(|depth| columns.values(depth)[i] > T::zero()) {
                continue;
            }
            let rho = columns.values(fields.density)[i].as_f64();
            let fluid = &self.fluid;
            let pressure = fluid.state_equation.pressure(rho, fluid.density, fluid.sound_speed);
            let y = columns.values(fields.position[1])[i].as_f64();
            squared += (pressure - self.scene.pressure(y)).powi(2);
            count += 1.0;
        }
        let error = (squared / count).sqrt() / self.scene.pressure(0.0);
        report.error("pressure_l2", error);
    }

    fn title(&self) -> String {
        "Water at rest in a tank".to_owned()
    }

    fn spacing(&self) -> f64 {
        DEPTH / self.scene.resolution
    }
}
