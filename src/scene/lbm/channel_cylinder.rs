//! The cylinder in a channel on a lattice: walls half-way between sites, the cylinder's surface interpolated.
//!
//! The sites at inlet and outlet are half a spacing outside the channel, so that with a multiple of 41
//! points across the cylinder's centre is in the middle between sites in both directions: on other meshes
//! the cuts of its surface are not the same above and below, and that alone makes more lift than there
//! is. The density follows the pressure by the square of the Mach number, so that before the cylinder
//! it is above that at the outlet, and the drag with it.

use finegrain_framework::run::{Every, Run, Summary};
use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::Grid;
use finegrain_framework::{Simulation, VectorField};
use finegrain_lbm::mesh::time_step_of_mach;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{
    Compiled, Condition, Fluid, LatticeKind, Mesh, Opening, Physics, Start, measure,
};

use super::{Final, Flow, LbmScene};
use crate::scene::channel_cylinder::{
    self, CENTRE, ChannelCylinder, DENSITY, DIAMETER, HEIGHT, LENGTH, Loads, VISCOSITY,
};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError};

/// All parameters.
pub fn parameters() -> Vec<Parameter> {
    let own = [
        super::WALL,
        super::MACH.with_default(0.05),
        Parameter::choice(
            "outlet",
            &["non-reflecting", "pressure"],
            "sound goes out (Poinsot & Lele 1992), or the pressure is fixed (Zou & He 1997)",
        ),
    ];
    [&channel_cylinder::PARAMETERS[..], &super::collision_at_walls(), &own].concat()
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T, CylinderFlow>, SceneError> {
    let scene = ChannelCylinder::new(parameters);
    let spacing = HEIGHT / scene.resolution;
    let length = (LENGTH / spacing).round() as usize + 2;
    let mesh = Mesh {
        shape: [length, scene.resolution as usize, 1],
        corner: [-spacing, 0.0, 0.0],
        spacing,
        time_step: time_step_of_mach(spacing, scene.largest_speed(), parameters.number("mach")),
        periodic: [false, false, true],
    };
    let fluid = Fluid {
        density: DENSITY,
        kinematic_viscosity: VISCOSITY,
        largest_speed: scene.largest_speed(),
    };
    let wall =
        |y: f64, up: f64| Shape::HalfSpace { point: [0.0, y, 0.0], outward: [0.0, up, 0.0] }.into();
    let outlet = match parameters.choice("outlet") {
        "pressure" => Condition::Pressure(0.0),
        // As fast as the mean flow goes through the channel.
        _ => Condition::NonReflecting { pressure: 0.0, relaxation: scene.mean_velocity() / LENGTH },
    };
    let inlet = Condition::Velocity(VectorField::new(move |x, _| scene.inflow(x)));
    let opening = |is_upper, condition| Opening { axis: Axis::X, is_upper, condition };
    let physics = Physics {
        bodies: vec![scene.body().into(), wall(0.0, 1.0), wall(HEIGHT, -1.0)],
        openings: vec![opening(false, inlet), opening(true, outlet)],
        ..Physics::default()
    };
    super::scene(
        CylinderFlow { scene, spacing },
        &mesh,
        fluid,
        &physics,
        &super::scheme(parameters, LatticeKind::D2Q9, true),
        &Start::with_velocity(move |x| scene.inflow(x)),
        super::description("channel-cylinder", parameters, precision),
    )
}

/// Steady loads change by less than this part.
const STEADY: f64 = 3e-5;

struct CylinderFlow {
    scene: ChannelCylinder,
    spacing: f64,
}

/// Places before the surface, in spacings, from which the pressure there is extrapolated, and their
/// weights in a cubic: nearer, sites in the cylinder would count.
const BEFORE: [f64; 4] = [1.0, 2.0, 3.0, 4.0];
const WEIGHTS: [f64; 4] = [4.0, -6.0, 4.0, -1.0];

impl<T: Compiled> Flow<T> for CylinderFlow {
    fn end_time(&self) -> f64 {
        self.scene.end_time()
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let (scene, parts) = (self.scene, parts.clone());
        let mut points = [[CENTRE[0], CENTRE[1], 0.0]; 2 * BEFORE.len()];
        for (n, before) in BEFORE.iter().enumerate() {
            points[n][0] -= 0.5 * DIAMETER + before * self.spacing;
            points[BEFORE.len() + n][0] += 0.5 * DIAMETER + before * self.spacing;
        }
        let [drag, lift, difference] = Loads::COLUMNS;
        let columns = [drag, lift, difference, "largest_speed", "excess_mass"];
        let every = Every::Time(scene.sampling());
        let run = run.monitor("flow", every, columns, move |whole| {
            let force = measure::force_on_body(whole, &parts, 0);
            let pressures = measure::pressures(whole, &parts, &points);
            let at = |of: &[f64]| of.iter().zip(WEIGHTS).map(|(p, weight)| p * weight).sum::<f64>();
            let (before, behind) = pressures.split_at(BEFORE.len());
            let difference = at(before) - at(behind);
            let [drag, lift] = [force[0], force[1]].map(|force| scene.coefficient(force));
            let speed = measure::largest_speed(whole, &parts);
            [drag, lift, difference, speed, measure::totals(whole, &parts).excess_mass]
        });
        run.stop_when(every, |_, histories| Loads::new(&histories[0]).are_steady(STEADY))
    }

    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        _: &mut Simulation<Grid>,
        _: &Final<T>,
    ) {
        self.scene.judge(report, &Loads::new(&summary.histories[0]), STEADY);
    }

    fn title(&self) -> String {
        self.scene.title()
    }
}
