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
    Collision, Compiled, Condition, Fluid, LatticeKind, Mesh, Opening, Physics, Start, measure,
};

use super::{Final, Flow, LbmScene};
use crate::scene::channel_cylinder::{
    self, CENTRE, ChannelCylinder, DENSITY, DIAMETER, HEIGHT, LENGTH, Loads, VISCOSITY,
};
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::{Precision, Report, SceneError, cubic};

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
    [&channel_cylinder::PARAMETERS[..], &collision(), &own].concat()
}

/// Two relaxation times keep the cylinder where it is as long as the flow is steady; where it sheds vortices they do not
/// survive.
fn collision() -> [Parameter; 3] {
    const SUITED: Parameter = Parameter::choice(
        "collision",
        &["suited", "central-moments", "cumulant", "regularised", "trt", "mrt", "bgk"],
        "how populations relax; suited: trt while the flow is steady, else central-moments",
    );
    super::COLLISION.map(|parameter| match parameter.name {
        "collision" => SUITED,
        "magic" => parameter.only_with("collision", &["suited", "trt", "mrt"]),
        _ => parameter,
    })
}

prepare_with!(build);

fn build<T: Compiled>(
    parameters: &Parameters,
    precision: Precision,
) -> Result<LbmScene<T>, SceneError> {
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
    let mut scheme = super::scheme(parameters, LatticeKind::D2Q9, true);
    if parameters.choice("collision") == "suited" && !scene.is_unsteady() {
        scheme.collision = Collision::Trt { magic: parameters.number("magic") };
    }
    super::scene(
        CylinderFlow { scene, spacing },
        &mesh,
        fluid,
        &physics,
        &scheme,
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

/// Sites by which the pressure is found where the centre line meets the cylinder: columns of four
/// rows around the line, the nearest to the cylinder first. Towards the stagnation point the pressure rises
/// steeply, in a layer less than two spacings thick with 82 points across (Hiemenz 1911): the columns begin as
/// near to the cylinder as they can without sites so close to it that their links make the pressure jump.
struct Probe {
    columns: [usize; 4],
    rows: [usize; 4],
    /// Where the point is, counted in columns from the first and in rows from the first.
    place: [f64; 2],
}

impl Probe {
    /// Sites of a probe.
    const SITES: usize = 16;

    /// In front of the cylinder if `direction` is -1, behind it if 1.
    fn new(spacing: f64, direction: f64) -> Self {
        let x = (CENTRE[0] + direction * 0.5 * DIAMETER) / spacing + 0.5;
        let y = CENTRE[1] / spacing - 0.5;
        // Whole numbers of columns count from the cylinder on.
        let nearest = (direction * x + 0.25).ceil();
        let lowest = y.floor() - 1.0;
        Self {
            columns: [0.0, 1.0, 2.0, 3.0].map(|n| (direction * (nearest + n)) as usize),
            rows: [0.0, 1.0, 2.0, 3.0].map(|n| (lowest + n) as usize),
            place: [direction * x - nearest, y - lowest],
        }
    }

    fn sites(&self) -> [[usize; 3]; Self::SITES] {
        std::array::from_fn(|n| [self.columns[n / 4], self.rows[n % 4], 0])
    }

    /// By cubics across the line, and along it.
    fn pressure(&self, of_sites: &[f64]) -> f64 {
        let on_line: Vec<_> =
            of_sites.chunks(4).map(|column| cubic::value(column, self.place[1])).collect();
        cubic::value(&on_line, self.place[0])
    }
}

impl<T: Compiled> Flow<T> for CylinderFlow {
    fn end_time(&self) -> f64 {
        self.scene.end_time()
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let (scene, parts) = (self.scene, parts.clone());
        let probes = [-1.0, 1.0].map(|direction| Probe::new(self.spacing, direction));
        let mut sites = [[0; 3]; 2 * Probe::SITES];
        for (sites, probe) in sites.chunks_mut(Probe::SITES).zip(&probes) {
            sites.copy_from_slice(&probe.sites());
        }
        let [drag, lift, difference] = Loads::COLUMNS;
        let columns = [drag, lift, difference, "largest_speed", "excess_mass"];
        let every = Every::Time(scene.sampling());
        let run = run.monitor("flow", every, columns, move |whole| {
            let force = measure::force_on_body(whole, &parts, 0);
            let pressures = measure::pressures(whole, &parts, &sites);
            let (before, behind) = pressures.split_at(Probe::SITES);
            let difference = probes[0].pressure(before) - probes[1].pressure(behind);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Pressures that are a cubic in either direction, whatever the mesh, and no site in the cylinder.
    #[test]
    fn the_pressure_is_extrapolated_to_the_surface() {
        let pressure = |x: f64, y: f64| 1.0 + 3.0 * x - 40.0 * x.powi(3) + (y - 0.2).powi(2);
        for resolution in [20.0, 41.0, 57.0, 82.0, 123.0] {
            let spacing = HEIGHT / resolution;
            for (direction, x) in [(-1.0, 0.15), (1.0, 0.25)] {
                let probe = Probe::new(spacing, direction);
                let at = probe.sites().map(|[i, j, _]| {
                    // As the mesh has it: the first sites half a spacing outside.
                    [(i as f64 - 0.5) * spacing, (j as f64 + 0.5) * spacing]
                });
                let distance = |[x, y]: [f64; 2]| (x - CENTRE[0]).hypot(y - CENTRE[1]);
                assert!(at.iter().all(|&at| distance(at) > 0.5 * DIAMETER + 0.2 * spacing));
                let found = probe.pressure(&at.map(|[x, y]| pressure(x, y)));
                assert!((found - pressure(x, 0.2)).abs() < 1e-12, "{resolution}: {found}");
            }
        }
    }
}
