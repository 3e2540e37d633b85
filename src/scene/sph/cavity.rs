//! The lid-driven cavity in SPH: a square of fluid in four walls of particles.
//!
//! Pressure evolves by itself (EDAC) and particles are kept even by a transport velocity, as in the
//! vortices of Taylor and Green: without, voids open in the middle of the large eddy. Velocities
//! in walls are mirrored, because a linear profile has no meaning in the corners, where two
//! surfaces with different velocities meet.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::shape::Shape;
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Simulation};
use finegrain_sph::{Body, Fields, Fluid, Packing, Physics, Sph, Start, measure};

use super::{Flow, SphScene, profile};
use crate::scene::cavity::{self, Cavity, Extrema};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// Layers of particles in a wall: as many as the widest kernel reaches.
const LAYERS: f64 = 8.0;

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    super::with_defaults(
        &[
            &cavity::PARAMETERS,
            &super::LIQUID_PARAMETERS,
            &super::PARAMETERS,
            &super::WALL_PARAMETERS,
        ],
        &[("transport", 4.0), ("smoothing_ratio", 1.3)],
        &[&super::EVEN_AND_STEADY[..], &[("wall_velocity", "mirrored")]].concat(),
    )
}

prepare_with!(build);

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let scene = Cavity::new(parameters);
    let spacing = 1.0 / scene.resolution;
    let thickness = LAYERS * spacing;
    let side = 1.0 + 2.0 * thickness;
    let lattice = Packing::Square.fit([side, side, 0.0], spacing)?;
    let start = Start {
        region: Region {
            lower: vec![-thickness; 2],
            upper: vec![1.0 + thickness; 2],
            periodic: vec![false; 2],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        positions: lattice.positions().map(|[x, y, z]| [x - thickness, y - thickness, z]).collect(),
        velocities: Vec::new(),
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 1.0 / parameters.number("mach"),
        kinematic_viscosity: scene.viscosity(),
        state_equation: super::state_equation(parameters),
    };
    let wall = |point: [f64; 3], outward: [f64; 3]| Shape::HalfSpace { point, outward };
    let lid = wall([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]);
    let physics = Physics {
        viscosity: Some(super::viscosity(parameters)),
        bodies: vec![
            wall([0.0; 3], [1.0, 0.0, 0.0]).into(),
            wall([0.0; 3], [0.0, 1.0, 0.0]).into(),
            wall([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]).into(),
            Body { shape: lid, surface_velocity: [1.0, 0.0, 0.0] },
        ],
        ..Physics::default()
    };
    let sph = Sph::new(&start, &fluid, &physics, &super::scheme_with_walls(parameters))?;
    let description = super::description("cavity", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(CavityFlow { scene }), description })
}

struct CavityFlow {
    scene: Cavity,
}

impl<T: Real, P: Real> Flow<T, P> for CavityFlow {
    /// By then the eddies have turned often enough that the extrema change by less than a percent.
    fn end_time(&self) -> f64 {
        8.0 + 0.04 * self.scene.reynolds
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let fields = fields.clone();
        run.monitor("flow", Every::Time(0.1), ["kinetic_energy", "largest_speed"], move |whole| {
            let energy = measure::totals(whole, &fields, mass).kinetic_energy;
            [energy, measure::largest_speed(whole, &fields)]
        })
    }

    /// Extrema of the velocity on the lines through the middle.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        _: f64,
    ) {
        let count = (4.0 * self.scene.resolution) as usize;
        let along = |k: usize| (k as f64 + 0.5) / count as f64;
        let spacing = 1.0 / self.scene.resolution;
        let upright: Vec<_> = (0..count).map(|k| [0.5, along(k)]).collect();
        let across: Vec<_> = (0..count).map(|k| [along(k), 0.5]).collect();
        let columns = simulation.columns();
        let u = profile::velocities(columns, fields, &upright, spacing, None);
        let v = profile::velocities(columns, fields, &across, spacing, None);
        let is_steady = summary.time >= Flow::<T, P>::end_time(self);
        let least = |v: &[[f64; 2]], a: usize| v.iter().map(|v| v[a]).fold(f64::INFINITY, f64::min);
        let most = v.iter().map(|v| v[1]).fold(f64::NEG_INFINITY, f64::max);
        let found = Extrema { u_min: least(&u, 0), v_max: most, v_min: least(&v, 1) };
        self.scene.judge(report, &found, is_steady);
    }

    fn title(&self) -> String {
        self.scene.title()
    }

    fn spacing(&self) -> f64 {
        1.0 / self.scene.resolution
    }
}
