//! The dam break in SPH.
//!
//! The defaults: the diffusion of density that knows the gradient of the density against the noise
//! of impacts; the artificial viscosity and the repulsion by walls, without which the flow blows up after the impact on
//! the far wall. Shifting and tensile control keep pairs from forming in the spray and where water falls back;
//! shifting alone moves particles of the surface and makes energy. The quintic spline, since with Wendland C2 and 1.5
//! spacings impacts make up to eight times as much energy (docs/scenes.md).

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::{Real, Simulation};
use finegrain_sph::{Fields, Fluid, Sph};

use super::{Flow, SphScene, free_surface, tank};
use crate::scene::dam_break::{self, DamBreak, HEIGHT, WIDTH};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::tank::{DENSITY, GRAVITY, Tank};
use crate::scene::{Precision, Report, SceneError};

/// From here on the front of the experiment is that of water without a gate, in its unit of time:
/// only the first row of the table is before.
const GATE_GONE: f64 = 0.5;

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    free_surface::parameters(
        &[&dam_break::PARAMETERS, &tank::PARAMETERS],
        &[("smoothing_ratio", 1.0), ("artificial_viscosity", 0.1), ("repulsion", 2.0)],
        &[("kernel", "quintic-spline"), ("tension", "control"), ("shifting", "on")],
    )
}

prepare_with!(build);

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let mut scene = DamBreak::new(parameters);
    let spacing = WIDTH / scene.resolution;
    scene.tank = tank::fit(scene.tank, spacing);
    let fluid = tank::water(parameters, scene.speed() / parameters.number("mach"));
    let scheme = tank::scheme(parameters, scene.speed());
    let is_filled = |[x, y, _]: [f64; 3]| x < WIDTH && y < HEIGHT;
    let start = tank::start(&scene.tank, spacing, &scheme, is_filled);
    let mut sph = Sph::<T, P>::new(&start, &fluid, &tank::physics(&scene.tank), &scheme)?;
    // Walls take theirs from the water.
    free_surface::set_pressure(&mut sph, &fluid, &start.positions, |[x, y, z]| {
        let is_water = x > 0.0 && y > 0.0 && is_filled([x, y, z]);
        if is_water { DENSITY * scene.pressure([x, y, z]) } else { 0.0 }
    });
    let description = super::description("dam-break", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(DamFlow { scene, fluid }), description })
}

struct DamFlow {
    scene: DamBreak,
    fluid: Fluid,
}

impl<T: Real, P: Real> Flow<T, P> for DamFlow {
    /// After the water has hit the far wall.
    fn end_time(&self) -> f64 {
        6.0 * self.scene.time()
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let every = Every::Time(0.02 * self.scene.time());
        tank::monitor(run, every, fields, self.fluid, mass, self.scene.tank)
    }

    /// `front`, the largest relative difference from the experiment after the shift `gate_shift`
    /// in time (in units of `sqrt(a / 2 g)`) and once the gate is gone; `front_with_gate` from
    /// its beginning, too; `through_walls`; `energy_growth` and `energy_change` over the potential energy at the beginning.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        _: &mut Simulation<Cells<P>>,
        _: &Fields<T, P>,
        _: f64,
    ) {
        let water = &summary.histories[1];
        if let Some(front) = water.column("front") {
            let half = 0.5 * Flow::<T, P>::spacing(self);
            let times = water.times().iter().map(|t| t / self.scene.time());
            let front: Vec<_> = times.zip(front.map(|x| (x + half) / WIDTH)).collect();
            if let Some(found) = DamBreak::front_error(&front, GATE_GONE) {
                report.error("front", found.error);
                report.results.insert("gate_shift", found.shift);
            }
            if let Some(found) = DamBreak::front_error(&front, 0.0) {
                report.results.insert("front_with_gate", found.error);
            }
        }
        tank::judge_walls(report, &summary.histories);
        let scale = 0.5 * DENSITY * GRAVITY * HEIGHT * HEIGHT * WIDTH;
        free_surface::judge_energy(report, &summary.histories, scale);
    }

    fn title(&self) -> String {
        "Dam break".to_owned()
    }

    /// Without the upper half of the tank, where there is little but spray.
    fn picture(&self, simulation: &Simulation<Cells<P>>, fields: &Fields<T, P>) -> Picture {
        let Tank { width, height } = self.scene.tank;
        let title = Flow::<T, P>::title(self);
        let spacing = Flow::<T, P>::spacing(self);
        let margin = 2.0 * spacing;
        super::picture(simulation, fields, title, spacing)
            .window([-margin; 2], [width + margin, 0.5 * height])
            .into()
    }

    fn spacing(&self) -> f64 {
        WIDTH / self.scene.resolution
    }
}
