//! Couette and Poiseuille flow in SPH: a periodic strip between two plates of particles.
//!
//! By default the velocity in the plates is a linear profile through that of the surface: the flow
//! is along the plates and nearly linear there, which makes this more accurate than a mean of the
//! fluid around. Pressure is taken from the fluid, so that the plates do not push.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::shape::Shape;
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Simulation, State};
use finegrain_sph::{Body, Fields, Fluid, Packing, Physics, Sph, Start, measure};

use super::{Flow, SphScene};
use crate::scene::channel::{self, Channel, DENSITY, Drive, GAP, SPEED, TIME, VISCOSITY};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Prepared, Report, SceneError};

/// Layers of particles in a plate: as many as the widest kernel reaches.
const LAYERS: f64 = 8.0;
/// Length of the periodic strip, in spacings.
const LENGTH: f64 = 20.0;

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    super::with_defaults(
        &[
            &channel::PARAMETERS,
            &super::LIQUID_PARAMETERS,
            &super::PARAMETERS,
            &super::WALL_PARAMETERS,
        ],
        &[("beta_max", 100.0)],
        &[
            ("kernel", "quintic-spline"),
            ("viscous_form", "adami"),
            ("wall_pressure", "extrapolated"),
        ],
    )
}

/// Prepares Couette flow.
pub fn prepare_couette(
    parameters: &Parameters,
    precision: Precision,
) -> Result<Box<dyn Prepared>, SceneError> {
    prepare(Drive::Couette, parameters, precision)
}

/// Prepares Poiseuille flow.
pub fn prepare_poiseuille(
    parameters: &Parameters,
    precision: Precision,
) -> Result<Box<dyn Prepared>, SceneError> {
    prepare(Drive::Poiseuille, parameters, precision)
}

fn prepare(
    drive: Drive,
    parameters: &Parameters,
    precision: Precision,
) -> Result<Box<dyn Prepared>, SceneError> {
    Ok(match precision {
        Precision::F32 => Box::new(build::<f32, f32>(drive, parameters, precision)?),
        Precision::F64 => Box::new(build::<f64, f64>(drive, parameters, precision)?),
        Precision::Mixed => Box::new(build::<f32, f64>(drive, parameters, precision)?),
    })
}

fn build<T: Real, P: Real>(
    drive: Drive,
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let scene = Channel::new(drive, parameters);
    let spacing = GAP / scene.resolution;
    let thickness = LAYERS * spacing;
    let sides = [LENGTH * spacing, GAP + 2.0 * thickness, 0.0];
    let lattice = Packing::Square.fit(sides, spacing)?;
    let lengths = lattice.lengths();
    // The lower plate ends at y = 0.
    let positions = lattice.positions().map(|[x, y, z]| [x, y - thickness, z]).collect();
    let start = Start {
        region: Region {
            lower: vec![0.0, -thickness],
            upper: vec![lengths[0], GAP + thickness],
            periodic: vec![true, false],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        positions,
        velocities: Vec::new(),
    };
    let fluid = Fluid {
        density: DENSITY,
        sound_speed: SPEED / parameters.number("mach"),
        kinematic_viscosity: VISCOSITY,
        state_equation: super::state_equation(parameters),
    };
    let plate = |y: f64, up: f64, velocity: f64| Body {
        shape: Shape::HalfSpace { point: [0.0, y, 0.0], outward: [0.0, up, 0.0] },
        surface_velocity: [velocity, 0.0, 0.0],
    };
    let physics = Physics {
        viscosity: Some(super::viscosity(parameters)),
        body_acceleration: [scene.body_acceleration(), 0.0, 0.0],
        bodies: vec![plate(0.0, 1.0, 0.0), plate(GAP, -1.0, scene.plate_velocity())],
        ..Physics::default()
    };
    let sph = Sph::new(&start, &fluid, &physics, &super::scheme_with_walls(parameters))?;
    let description = super::description(drive.scene(), parameters, precision);
    Ok(SphScene { sph, flow: Box::new(ChannelFlow { scene }), description })
}

struct ChannelFlow {
    scene: Channel,
}

impl<T: Real, P: Real> Flow<T, P> for ChannelFlow {
    fn end_time(&self) -> f64 {
        TIME
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let fields = fields.clone();
        let columns = ["velocity_x", "velocity_y", "largest_speed"];
        run.monitor("flow", Every::Time(0.02 * TIME), columns, move |whole| {
            let totals = measure::totals(whole, &fields, mass);
            let [x, y, _] = totals.flow.map(|flow| flow / totals.volume);
            [x, y, measure::largest_speed(whole, &fields)]
        })
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        _: f64,
    ) {
        if summary.time <= 0.0 {
            return;
        }
        let columns = simulation.columns();
        let Some(depth) = fields.wall_depth else { return };
        let value = |column: State<T>, i: usize| columns.values(column)[i].as_f64();
        let in_fluid = (0..columns.points()).filter(|&i| columns.values(depth)[i] <= T::zero());
        let profile = in_fluid.map(|i| {
            let y = columns.values(fields.position[1])[i].as_f64();
            (y, [0, 1].map(|a| value(fields.velocity[a], i)))
        });
        self.scene.judge(report, summary.time, profile);
    }

    fn title(&self) -> String {
        self.scene.title()
    }

    fn spacing(&self) -> f64 {
        GAP / self.scene.resolution
    }
}
