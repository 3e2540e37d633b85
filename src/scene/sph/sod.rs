//! Sod's shock tube in SPH, of particles of one mass.

use finegrain_framework::run::{Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Simulation, State};
use finegrain_sph::{Fields, Start};

use super::{Flow, SphScene, gas};
use crate::figure::Axis;
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::riemann::Gas;
use crate::scene::sod::{self, DIAPHRAGM, Sod, TUBE};
use crate::scene::{Precision, Report, SceneError, at_time};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    [&sod::PARAMETERS[..], &gas::PARAMETERS].concat()
}

prepare_with!(build);

/// Rows of the dense gas across a tube in 2-D: three times those of the thin gas.
const ROWS: usize = 24;

/// Sides of the space of one particle in dense and thin gas, m. In 2-D the dense gas is a square
/// lattice `d` apart; the thin gas has columns 8/3 d and rows 3 d apart: eight times the area.
fn sides(scene: &Sod) -> [[f64; 2]; 2] {
    if scene.dims == 1 {
        let thin = (scene.resolution / 9.0).round().max(1.0);
        return [[0.5 / (8.0 * thin), 0.0], [0.5 / thin, 0.0]];
    }
    let d = 0.5 / (8.0 * (scene.resolution / 11.0).round().max(1.0));
    [[d, d], [8.0 / 3.0 * d, 3.0 * d]]
}

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let scene = Sod::new(parameters);
    let sides = sides(&scene);
    let [[spacing, _], [thinnest, _]] = sides;
    let mut positions = Vec::new();
    for ([dx, dy], lower) in sides.into_iter().zip([DIAPHRAGM - 1.0, DIAPHRAGM]) {
        let height = if scene.dims == 1 { dy } else { ROWS as f64 * spacing };
        let rows = if scene.dims == 1 { 1 } else { (height / dy).round() as usize };
        for i in 0..(1.0 / dx).round() as usize {
            for j in 0..rows {
                positions.push([lower + (i as f64 + 0.5) * dx, (j as f64 + 0.5) * dy, 0.0]);
            }
        }
    }
    let gases: Vec<_> =
        positions.iter().map(|x| if x[0] < DIAPHRAGM { TUBE.left } else { TUBE.right }).collect();
    let upper = [DIAPHRAGM + 1.0, ROWS as f64 * spacing];
    let start = Start {
        region: Region {
            lower: [DIAPHRAGM - 1.0, 0.0][..scene.dims].to_vec(),
            upper: upper[..scene.dims].to_vec(),
            periodic: vec![true; scene.dims],
        },
        spacing,
        particle_volume: spacing.powi(scene.dims as i32),
        velocities: Vec::new(),
        positions,
    };
    let densities: Vec<_> = gases.iter().map(|gas| gas.density).collect();
    let energy = |gas: &Gas| gas.pressure / ((TUBE.heat_ratio - 1.0) * gas.density);
    let energies: Vec<_> = gases.iter().map(energy).collect();
    // A little longer than the thinnest gas needs: summation is uneven where gases meet.
    let longest = 1.15 * thinnest.max(8f64.sqrt() * spacing);
    let sph = gas::build(parameters, &start, TUBE.heat_ratio, longest, &densities, &energies)?;
    let description = super::description("sod", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(Tube { scene, spacing }), description })
}

struct Tube {
    scene: Sod,
    spacing: f64,
}

impl Tube {
    /// Position along the tube, density and energy of the particles from 0 to 1.
    fn particles<T: Real, P: Real>(
        &self,
        simulation: &Simulation<Cells<P>>,
        fields: &Fields<T, P>,
    ) -> Vec<[f64; 4]> {
        let columns = simulation.columns();
        let value = |handle: State<T>, i: usize| columns.values(handle)[i].as_f64();
        (0..columns.points())
            .map(|i| {
                let energy = fields.energy.map_or(0.0, |energy| value(energy, i));
                let x = columns.values(fields.position[0])[i].as_f64();
                [x, value(fields.density, i), value(fields.velocity[0], i), energy]
            })
            .filter(|[x, ..]| (0.0..=1.0).contains(x))
            .collect()
    }
}

impl<T: Real, P: Real> Flow<T, P> for Tube {
    fn end_time(&self) -> f64 {
        0.2
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        gas::observe(run, fields, mass, 0.01)
    }

    /// `density_l1`, `velocity_l1` and `pressure_l1`: the integral of the error from 0 to 1 over
    /// that of the exact profile; `energy_drift`.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        mass: f64,
    ) {
        gas::judge_energy(report, summary, simulation, fields, mass);
        if summary.time == 0.0 {
            return;
        }
        let gas =
            self.particles(simulation, fields).into_iter().map(|[x, density, velocity, energy]| {
                let pressure = (TUBE.heat_ratio - 1.0) * density * energy;
                (x, 1.0 / density, Gas { density, velocity, pressure })
            });
        self.scene.judge(report, summary.time, gas);
    }

    fn title(&self) -> String {
        format!("Sod's shock tube, {}-D", self.scene.dims)
    }

    fn spacing(&self) -> f64 {
        self.spacing
    }

    fn picture(&self, simulation: &Simulation<Cells<P>>, fields: &Fields<T, P>) -> Picture {
        let time = simulation.clock().time();
        let particles = self.particles(simulation, fields);
        let points = particles.into_iter().map(|[x, density, ..]| [x, density]).collect();
        let title = at_time(<Self as Flow<T, P>>::title(self), time);
        let exact = |x| self.scene.exact(x, time).density;
        gas::chart(title, Axis::new("x").unit("m"), points, exact).into()
    }
}
