//! The cylinder in SPH: particles on a lattice, those inside the cylinder at rest.
//!
//! By default pressure evolves with diffusion (Ramachandran & Puri 2019) and particles drift towards
//! an even distribution (Adami, Hu & Adams 2013, four times as strong): without that the flow at
//! Re = 1 does not become steady, for the particles lose their order where streamlines converge.
//! Pressure in the cylinder is taken from the fluid, and the velocity there is a linear profile,
//! fitted to the fluid, through zero on the exact surface, not on the steps of the lattice. The
//! profile of Morris et al. (1997), `wall_velocity=linear`, needs a largest extrapolation, on which
//! the drag depends; with it, and density by continuity, the drag did not converge.

use finegrain_framework::run::{Every, History, Run, Stopped, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Columns, Real, Simulation};
use finegrain_sph::packing::Lattice;
use finegrain_sph::{Fields, Fluid, Packing, Physics, Sph, SphError, Start, WallVelocity, measure};

use super::{Flow, SphScene, profile};
use crate::figure::Outline;
use crate::scene::cylinder::{self, Cylinder, DENSITY, SIDE};
use crate::scene::parameter::{Parameter, ParameterError, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [Parameter::choice(
        "packing",
        &["lattice", "hexagonal"],
        "square (3-D: cubic) lattice, or close packing",
    )];
    super::with_defaults(
        &[
            &cylinder::PARAMETERS,
            &super::LIQUID_PARAMETERS,
            &super::PARAMETERS,
            &super::WALL_PARAMETERS,
            &own,
        ],
        &[("beta_max", 6.0), ("transport", 4.0)],
        &[&super::EVEN_AND_STEADY[..], &[("wall_velocity", "fitted")]].concat(),
    )
}

prepare_with!(build);

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let scene = Cylinder::new(parameters);
    let spacing = SIDE / scene.resolution;
    let packing = match (parameters.choice("packing"), scene.dims) {
        ("hexagonal", 2) => Packing::Hexagonal,
        ("hexagonal", _) => Packing::HexagonalClosePacked,
        (_, 2) => Packing::Square,
        _ => Packing::Cubic,
    };
    // In 3-D a slab of six layers, within which the flow does not vary.
    let lattice = packing.fit([SIDE, SIDE, 6.0 * spacing], spacing)?;
    let lengths = lattice.lengths();
    let start = start(scene.dims, &lattice, spacing);
    // Largest speed, in the gap between cylinders, and what Morris et al. (1997, eq. 10) ask for:
    // density varies little under pressure differences, viscous stress and the body force.
    let speed = 3.0 * scene.creeping_velocity();
    let variation = parameters.number("mach").powi(2);
    let sound_speed =
        [speed * speed, scene.viscosity * speed / SIDE, scene.body_acceleration * SIDE]
            .into_iter()
            .fold(0.0, f64::max)
            .sqrt()
            / variation.sqrt();
    let fluid = Fluid {
        density: DENSITY,
        sound_speed,
        kinematic_viscosity: scene.viscosity,
        state_equation: super::state_equation(parameters),
    };
    let scheme = super::scheme_with_walls(parameters);
    let physics = Physics {
        viscosity: Some(super::viscosity(parameters)),
        body_acceleration: [scene.body_acceleration, 0.0, 0.0],
        bodies: vec![scene.body(lengths).into()],
        forces_on_bodies: scheme.wall_velocity != WallVelocity::Linear,
        ..Physics::default()
    };
    let sph = Sph::new(&start, &fluid, &physics, &scheme).map_err(|error| match error {
        SphError::EmptyBody { .. } | SphError::Gap { is_thin: true, .. } => {
            too_thin(&scene, scene.radius(lengths) / spacing).into()
        }
        error => SceneError::from(error),
    })?;
    let volume = lengths[..scene.dims].iter().product();
    let flow = CylinderFlow { scene, volume, sides: [lengths[0], lengths[1]] };
    let description = super::description("cylinder", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(flow), description })
}

/// Says in the scene's own words that a cylinder of this `radius`, in spacings, has fewer particles in it than
/// the fluid would see.
fn too_thin(scene: &Cylinder, radius: f64) -> ParameterError {
    ParameterError::Invalid {
        name: "solid_fraction",
        value: scene.solid_fraction.to_string(),
        range: format!(
            "larger, or resolution must be: at resolution {} the radius is {radius:.2} spacings, and \
             particles see through the cylinder",
            scene.resolution
        ),
    }
}

/// Particles at rest on a whole lattice.
pub(crate) fn start(dims: usize, lattice: &Lattice, spacing: f64) -> Start {
    Start {
        region: Region {
            lower: vec![0.0; dims],
            upper: lattice.lengths()[..dims].to_vec(),
            periodic: vec![true; dims],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        positions: lattice.positions().collect(),
        velocities: Vec::new(),
    }
}

/// Samples of the mean velocity, three a relaxation time, over which a flow is averaged whose
/// particles never quite come to rest.
const LATE_SAMPLES: usize = 15;
/// Such a flow is steady if the mean differs by less than this part from the one before.
const STEADY_MEAN: f64 = 5e-3;

/// Mean of the last samples of the velocity along x, and by which part it differs from the mean of
/// as many before; `None` without twice as many samples.
fn late_mean(history: &History) -> Option<(f64, f64)> {
    let velocity: Vec<f64> = history.column("velocity_x")?.collect();
    let mut windows = velocity.rchunks_exact(LATE_SAMPLES);
    let mean = |window: &[f64]| window.iter().sum::<f64>() / LATE_SAMPLES as f64;
    let (last, before) = (mean(windows.next()?), mean(windows.next()?));
    Some((last, (before / last - 1.0).abs()))
}

struct CylinderFlow {
    scene: Cylinder,
    /// Volume of the whole cell, m^3 (m^2 in 2-D).
    volume: f64,
    /// Sides of the cell across the cylinder, m, as the packing fits them.
    sides: [f64; 2],
}

impl CylinderFlow {
    /// Judges velocities at the stations of the reference.
    fn judge_profiles<T: Real, P: Real>(
        &self,
        report: &mut Report,
        columns: &Columns,
        fields: &Fields<T, P>,
    ) {
        let [width, height] = self.sides;
        let stations = self.scene.reference_profiles();
        let points: Vec<_> =
            stations.iter().map(|s| [0.5 * width + s.x, 0.5 * height + s.y]).collect();
        let spacing = SIDE / self.scene.resolution;
        let found = profile::velocities(columns, fields, &points, spacing, Some(self.sides));
        self.scene.judge_profiles(report, found.into_iter());
    }
}

impl<T: Real, P: Real> Flow<T, P> for CylinderFlow {
    fn end_time(&self) -> f64 {
        30.0 * self.scene.relaxation_time()
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let every = Every::Time(self.scene.relaxation_time() / 3.0);
        let columns = ["velocity_x", "velocity_y", "velocity_z", "kinetic_energy", "largest_speed"];
        let (fields, volume) = (fields.clone(), self.volume);
        run.monitor("flow", every, columns, move |whole| {
            let totals = measure::totals(whole, &fields, mass);
            let [x, y, z] = totals.flow.map(|flow| flow / volume);
            [x, y, z, totals.kinetic_energy, measure::largest_speed(whole, &fields)]
        })
        .stop_when(every, |_, histories| cylinder::is_steady(histories, 1e-4))
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        mass: f64,
    ) {
        let [mut x, y, z] =
            measure::totals(&mut simulation.whole(), fields, mass).flow.map(|f| f / self.volume);
        if x == 0.0 {
            return;
        }
        let mut is_steady = summary.stopped == Stopped::Criterion;
        if !is_steady && let Some((mean, change)) = late_mean(&summary.histories[0]) {
            let percent = 100.0 * change;
            is_steady = change < STEADY_MEAN;
            if is_steady {
                x = mean;
                report.notes.push(format!(
                    "steady but for {percent:.2} %: the mean velocity is that of the last \
                     {LATE_SAMPLES} samples"
                ));
            }
        }
        self.scene.judge(report, [x, y, z], self.sides, is_steady);
        if !fields.reaction.is_empty() {
            // There is only one body.
            let [force, ..] =
                measure::force_on_body(&mut simulation.whole(), fields, mass, |_| true);
            let fluid = DENSITY * self.volume * (1.0 - self.scene.solid_fraction);
            let driving = fluid * self.scene.body_acceleration;
            cylinder::judge_momentum(report, force, driving, is_steady);
        }
        if is_steady {
            self.judge_profiles(report, simulation.columns(), fields);
        }
    }

    fn title(&self) -> String {
        self.scene.title()
    }

    fn spacing(&self) -> f64 {
        SIDE / self.scene.resolution
    }

    fn outlines(&self) -> Vec<Outline> {
        let [x, y] = self.sides;
        let radius = self.scene.radius([x, y, 0.0]);
        vec![Outline::Circle { centre: [0.5 * x, 0.5 * y], radius }]
    }
}
