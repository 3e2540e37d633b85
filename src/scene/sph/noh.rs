//! Noh's implosion in SPH: particles of one mass, with nothing outside of them.

use finegrain_framework::run::{Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Simulation};
use finegrain_sph::{Fields, Packing, Start};

use super::{Flow, SphScene, gas};
use crate::figure::Axis;
use crate::scene::noh::{self, HEAT_RATIO, Noh, PRESSURE, TIME};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::{Precision, Report, SceneError, at_time};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    [&noh::PARAMETERS[..], &gas::PARAMETERS].concat()
}

prepare_with!(build);

/// How far gas extends at the start, m. Its edge is at 0.5 m at the end, far from the shock at
/// 0.2 m: what is wrong at the edge does not get there, since gas comes in faster than sound.
const EXTENT: f64 = TIME + 0.5;

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let scene = Noh::new(parameters);
    let spacing = 1.0 / scene.resolution;
    let (positions, particle_volume) = if scene.dims == 1 {
        let half = (EXTENT / spacing).round() as i32;
        let at = |i: i32| [(f64::from(i) + 0.5) * spacing, 0.0, 0.0];
        ((-half..half).map(at).collect(), spacing)
    } else {
        let lattice = Packing::Hexagonal.fit([2.0 * EXTENT; 3], spacing)?;
        let centre = lattice.lengths().map(|length| 0.5 * length);
        let moved = |x: [f64; 3]| [x[0] - centre[0], x[1] - centre[1], 0.0];
        let disc = lattice.positions().map(moved).filter(|x| x[0].hypot(x[1]) < EXTENT);
        (disc.collect::<Vec<_>>(), lattice.volume_per_particle())
    };
    let inwards = |x: &[f64; 3]| {
        let r = x[0].hypot(x[1]);
        if r > 0.0 { x.map(|x| -x / r) } else { [0.0; 3] }
    };
    let start = Start {
        region: Region {
            lower: vec![-EXTENT; scene.dims],
            upper: vec![EXTENT; scene.dims],
            periodic: vec![false; scene.dims],
        },
        spacing,
        particle_volume,
        velocities: positions.iter().map(inwards).collect(),
        positions,
    };
    let densities = vec![1.0; start.positions.len()];
    let energies = vec![PRESSURE / (HEAT_RATIO - 1.0); densities.len()];
    // At the edge a particle has neighbours on one side only.
    let longest = 2.2 * spacing;
    let sph = gas::build(parameters, &start, HEAT_RATIO, longest, &densities, &energies)?;
    let description = super::description("noh", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(Implosion { scene, spacing }), description })
}

struct Implosion {
    scene: Noh,
    spacing: f64,
}

impl Implosion {
    /// Distance from the origin and density of the particles up to `most`.
    fn particles<T: Real, P: Real>(
        simulation: &Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        most: f64,
    ) -> Vec<[f64; 2]> {
        let columns = simulation.columns();
        (0..columns.points())
            .map(|i| {
                let squares =
                    fields.position.iter().map(|&x| columns.values(x)[i].as_f64().powi(2));
                [squares.sum::<f64>().sqrt(), columns.values(fields.density)[i].as_f64()]
            })
            .filter(|&[r, _]| r < most)
            .collect()
    }
}

impl<T: Real, P: Real> Flow<T, P> for Implosion {
    fn end_time(&self) -> f64 {
        TIME
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        gas::observe(run, fields, mass, 0.02)
    }

    /// `shocked_density`: mass over volume of the particles between a quarter and three quarters of
    /// the way to the shock; `centre_density`, the same within a tenth of the way, where gas was
    /// overheated when it stopped; `density_l1` to twice as far as the shock; `energy_drift`.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        mass: f64,
    ) {
        gas::judge_energy(report, summary, simulation, fields, mass);
        let (time, scene) = (summary.time, self.scene);
        let shock = scene.shock(time);
        let particles = Self::particles(simulation, fields, 2.0 * shock);
        let mean = |low: f64, high: f64| {
            let inside = particles.iter().filter(|[r, _]| (low * shock..high * shock).contains(r));
            let (count, volume) =
                inside.fold((0.0, 0.0), |(n, v), [_, rho]| (n + 1.0, v + 1.0 / rho));
            count / volume
        };
        let wanted = scene.shocked_density();
        for (name, density) in
            [("shocked_density", mean(0.25, 0.75)), ("centre_density", mean(0.0, 0.1))]
        {
            if density.is_finite() {
                report.result(name, density, Some(wanted));
            }
        }
        let (mut error, mut norm) = (0.0, 0.0);
        for &[r, density] in &particles {
            let exact = scene.density(r, time);
            error += (density - exact).abs() / density;
            norm += exact / density;
        }
        if norm > 0.0 {
            report.error("density_l1", error / norm);
        }
    }

    fn title(&self) -> String {
        format!("Noh's implosion, {}-D", self.scene.dims)
    }

    fn spacing(&self) -> f64 {
        self.spacing
    }

    fn picture(&self, simulation: &Simulation<Cells<P>>, fields: &Fields<T, P>) -> Picture {
        let time = simulation.clock().time();
        let points = Self::particles(simulation, fields, 2.0 * self.scene.shock(time));
        let title = at_time(<Self as Flow<T, P>>::title(self), time);
        let x = Axis::new("distance from the origin").unit("m");
        gas::chart(title, x, points, |r| self.scene.density(r, time)).into()
    }
}
