//! The cylinder in a channel in SPH: a box that is periodic along the channel, with a fringe behind the
//! outlet in which the fluid is brought back to the inflow.
//!
//! Pressure, regularity of particles and walls as for the array of cylinders.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::shape::Shape;
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Simulation, VectorField};
use finegrain_sph::{Fields, Fluid, Fringe, Packing, Physics, Sph, Start, measure};

use super::{Flow, SphScene, profile};
use crate::figure::Outline;
use crate::scene::channel_cylinder::{
    self, CENTRE, ChannelCylinder, DENSITY, DIAMETER, HEIGHT, LENGTH, Loads, VISCOSITY,
};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// Layers of particles in a wall: as many as the widest kernel reaches.
const LAYERS: f64 = 8.0;
/// Length of the fringe, m.
const FRINGE: f64 = 5.0 * DIAMETER;
/// How often the fluid is brought to the inflow on its way through the fringe.
/// The force that keeps the flow going is proportional to what it lacks: with this many, less than one percent.
const TURNS: f64 = 1000.0;

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    super::with_defaults(
        &[
            &channel_cylinder::PARAMETERS,
            &super::LIQUID_PARAMETERS,
            &super::PARAMETERS,
            &super::WALL_PARAMETERS,
        ],
        &[("resolution", 41.0), ("beta_max", 6.0), ("transport", 4.0)],
        &[&super::EVEN_AND_STEADY[..], &[("wall_velocity", "fitted")]].concat(),
    )
}

prepare_with!(build);

fn build<T: Real, P: Real>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<SphScene<T, P>, SceneError> {
    let scene = ChannelCylinder::new(parameters);
    let spacing = HEIGHT / scene.resolution;
    let thickness = LAYERS * spacing;
    let sides = [LENGTH + FRINGE, HEIGHT + 2.0 * thickness, 0.0];
    let lattice = Packing::Square.fit(sides, spacing)?;
    let length = lattice.lengths()[0];
    // The lower wall ends at y = 0.
    let positions: Vec<_> = lattice.positions().map(|[x, y, z]| [x, y - thickness, z]).collect();
    let start = Start {
        region: Region {
            lower: vec![0.0, -thickness],
            upper: vec![length, HEIGHT + thickness],
            periodic: vec![true, false],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        velocities: positions.iter().map(|&x| scene.inflow(x)).collect(),
        positions,
    };
    let fluid = Fluid {
        density: DENSITY,
        sound_speed: scene.largest_speed() / parameters.number("mach"),
        kinematic_viscosity: VISCOSITY,
        state_equation: super::state_equation(parameters),
    };
    let wall =
        |y: f64, up: f64| Shape::HalfSpace { point: [0.0, y, 0.0], outward: [0.0, up, 0.0] }.into();
    let physics = Physics {
        viscosity: Some(super::viscosity(parameters)),
        bodies: vec![scene.body().into(), wall(0.0, 1.0), wall(HEIGHT, -1.0)],
        forces_on_bodies: true,
        fringe: Some(Fringe {
            from: LENGTH,
            to: length,
            rate: TURNS * scene.mean_velocity() / FRINGE,
            velocity: VectorField::new(move |x, _| scene.inflow(x)),
        }),
        ..Physics::default()
    };
    let sph = Sph::new(&start, &fluid, &physics, &super::scheme_with_walls(parameters))?;
    let description = super::description("channel-cylinder", parameters, precision);
    Ok(SphScene { sph, flow: Box::new(CylinderFlow { scene, spacing }), description })
}

struct CylinderFlow {
    scene: ChannelCylinder,
    spacing: f64,
}

impl<T: Real, P: Real> Flow<T, P> for CylinderFlow {
    fn end_time(&self) -> f64 {
        self.scene.end_time()
    }

    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>> {
        let Self { scene, spacing } = *self;
        let fields = fields.clone();
        let radius = 0.5 * DIAMETER;
        let ends = [-radius, radius].map(|dx| [CENTRE[0] + dx, CENTRE[1]]);
        let [drag, lift, difference] = Loads::COLUMNS;
        let columns = [drag, lift, difference, "largest_speed"];
        let every = Every::Time(scene.sampling());
        run.monitor("flow", every, columns, move |whole| {
            let is_cylinder =
                |[x, y, _]: [f64; 3]| (x - CENTRE[0]).hypot(y - CENTRE[1]) < radius + spacing;
            let force = measure::force_on_body(whole, &fields, mass, is_cylinder);
            let [drag, lift] = [force[0], force[1]].map(|force| scene.coefficient(force));
            let difference = fields.pressure.map_or(f64::NAN, |pressure| {
                let at = profile::values(whole.columns, &fields, [pressure], &ends, spacing, None);
                at[0][0] - at[1][0]
            });
            [drag, lift, difference, measure::largest_speed(whole, &fields)]
        })
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        _: &mut Simulation<Cells<P>>,
        _: &Fields<T, P>,
        _: f64,
    ) {
        // Particles never quite come to rest: means over ten diameters, or where vortices are shed over
        // a fraction of their distance.
        let diameters = if self.scene.is_unsteady() { 0.25 } else { 10.0 };
        let loads = Loads::new(&summary.histories[0]).averaged(diameters);
        self.scene.judge(report, &loads, 0.02);
    }

    fn title(&self) -> String {
        self.scene.title()
    }

    fn spacing(&self) -> f64 {
        self.spacing
    }

    fn outlines(&self) -> Vec<Outline> {
        vec![Outline::Circle { centre: CENTRE, radius: 0.5 * DIAMETER }]
    }
}
