//! The standing wave in SPH.
//!
//! The defaults: as little artificial viscosity as keeps particles in order, for it is what damps
//! the wave, and the diffusion of density that knows the gradient of the density.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::{Real, Simulation};
use finegrain_sph::{Fields, Fluid, Sph};

use super::{Flow, SphScene, free_surface, tank};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::standing_wave::{self, DEPTH, StandingWave};
use crate::scene::tank::GRAVITY;
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    free_surface::parameters(
        &[&standing_wave::PARAMETERS, &tank::PARAMETERS],
        &[("smoothing_ratio", 2.0), ("artificial_viscosity", 0.01)],
        &[],
    )
}

prepare_with!(build);

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let mut scene = StandingWave::new(parameters);
    let spacing = DEPTH / scene.resolution;
    scene.tank = tank::fit(scene.tank, spacing);
    scene.wave_number = std::f64::consts::PI / scene.tank.width;
    let speed = (GRAVITY * DEPTH).sqrt();
    let fluid = tank::water(parameters, speed / parameters.number("mach"));
    let scheme = tank::scheme(parameters, speed);
    let mut start = tank::start(&scene.tank, spacing, &scheme, |x| x[1] < DEPTH);
    start.velocities = start.positions.iter().map(|&x| scene.velocity(x)).collect();
    let positions = start.positions.clone();
    tank::settle(&mut start, &scene.tank, DEPTH, fluid.sound_speed);
    let mut sph = Sph::<T, P>::new(&start, &fluid, &tank::physics(&scene.tank), &scheme)?;
    free_surface::set_pressure(&mut sph, &fluid, &positions, |[x, y, z]| {
        scene.pressure([x, y.min(DEPTH), z])
    });
    let description = super::description("standing-wave", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(WaveFlow { scene, fluid }), description })
}

struct WaveFlow {
    scene: StandingWave,
    fluid: Fluid,
}

impl<T: Real, P: Real> Flow<T, P> for WaveFlow {
    fn end_time(&self) -> f64 {
        4.1 * self.scene.period()
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let every = Every::Time(0.01 * self.scene.period());
        let run = tank::monitor(run, every, fields, self.fluid, mass, self.scene.tank);
        let (fields, scene) = (fields.clone(), self.scene);
        // How much of the velocity at the beginning there is: the cosine of the phase.
        run.monitor("wave", every, ["phase"], move |whole| {
            let [along, whole] = whole.sum(|near| {
                let of = |handle| near.state(handle).own().whole();
                let [x, y] = [0, 1].map(|a| near.state(fields.position[a]).own().whole());
                let [u, v] = [0, 1].map(|a| of(fields.velocity[a]));
                let mut sums = [0.0; 2];
                for i in 0..x.len() {
                    if fields.wall_depth.is_some_and(|depth| of(depth)[i] > T::zero()) {
                        continue;
                    }
                    let mode = scene.velocity([x[i].as_f64(), y[i].as_f64(), 0.0]);
                    sums[0] += u[i].as_f64() * mode[0] + v[i].as_f64() * mode[1];
                    sums[1] += mode[0] * mode[0] + mode[1] * mode[1];
                }
                sums
            });
            [along / whole]
        })
    }

    /// `period`, from the moments when the water turns;
    /// `energy_growth` over all energy, that in gravity counted from the bottom;
    /// `wave_energy_growth` over that of the wave alone; `through_walls`; `amplitude_decay`, the rate,
    /// 1/s, at which the velocity falls from one of its extremes to the next.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        _: &mut Simulation<Cells<P>>,
        _: &Fields<T, P>,
        _: f64,
    ) {
        if let Some([growth, _]) =
            free_surface::energy_changes(&summary.histories, self.scene.energy())
        {
            report.result("wave_energy_growth", growth, None);
            let all = summary.histories[0].column("total_energy").and_then(|mut e| e.next());
            if let Some(all) = all {
                report.result("energy_growth", growth * self.scene.energy() / all, None);
            }
        }
        tank::judge_walls(report, &summary.histories);
        let wave = &summary.histories[2];
        let Some(phase) = wave.column("phase").map(Iterator::collect::<Vec<f64>>) else {
            return;
        };
        let turns: Vec<f64> = (1..phase.len())
            .filter(|&k| phase[k - 1] * phase[k] < 0.0)
            .map(|k| {
                let (t0, t1) = (wave.times()[k - 1], wave.times()[k]);
                t0 + (t1 - t0) * phase[k - 1] / (phase[k - 1] - phase[k])
            })
            .collect();
        if let ([first, .., last], 3..) = (&turns[..], turns.len()) {
            let period = 2.0 * (last - first) / (turns.len() - 1) as f64;
            report.result("period", period, Some(self.scene.period()));
        }
        let is_extreme = |&k: &usize| {
            phase[k].abs() > phase[k - 1].abs() && phase[k].abs() >= phase[k + 1].abs()
        };
        let extremes: Vec<_> = (1..phase.len().saturating_sub(1)).filter(is_extreme).collect();
        if let [first, .., last] = extremes[..] {
            let time = wave.times()[last] - wave.times()[first];
            report.result("amplitude_decay", (phase[first] / phase[last]).abs().ln() / time, None);
        }
    }

    fn title(&self) -> String {
        "Standing wave".to_owned()
    }

    fn spacing(&self) -> f64 {
        DEPTH / self.scene.resolution
    }
}
