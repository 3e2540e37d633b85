//! How lattice Boltzmann methods take part in the scenes.
//!
//! Creeping flows choose their time step by the relaxation time, and the Mach number is what comes
//! out; faster ones choose it by the Mach number. Either is among the results.

/// Defines `prepare`, which makes a scene ready by a function `build::<T>(parameters, precision)`, in
/// the scalar type asked for; `prepare_with!(NAME: build, FIRST)` a function of that name, by
/// `build::<T>(FIRST, parameters, precision)`.
macro_rules! prepare_with {
    ($build:ident) => {
        prepare_with!(prepare: $build);
    };
    ($prepare:ident: $build:ident $(, $first:expr)?) => {
        /// Prepares the scene.
        pub fn $prepare(
            parameters: &$crate::scene::Parameters,
            precision: $crate::scene::Precision,
        ) -> Result<Box<dyn $crate::scene::Prepared>, $crate::scene::SceneError> {
            use $crate::scene::Precision;
            Ok(match precision {
                Precision::F32 => Box::new($build::<f32>($($first,)? parameters, precision)?),
                Precision::F64 => Box::new($build::<f64>($($first,)? parameters, precision)?),
                Precision::Mixed => return Err($crate::scene::lbm::refused(precision)),
            })
        }
    };
}

pub mod cavity;
pub mod channel;
pub mod channel_cylinder;
pub mod cylinder;
pub mod double_shear_layer;
pub mod shear_wave;
pub mod sphere_array;
pub mod taylor_green;
pub mod womersley;

use finegrain_framework::Simulation;
use finegrain_framework::run::{Dump, Run, Summary};
use finegrain_framework::space::Grid;
use finegrain_lbm::model::Parts;
use finegrain_lbm::{
    Collision, Compiled, Fluid, LatticeKind, Lbm, Mesh, Physics, Scheme, Start, Wall, measure,
};

use super::parameter::{Parameter, Parameters};
use super::report::Picture;
use super::{Orders, Precision, Prepared, Report, SceneError, at_time, cubic};
use crate::figure::{Axis, Field};

/// The error for numbers that the method does not compute with.
fn refused(precision: Precision) -> SceneError {
    SceneError::Precision { precision, known: "f32 and f64" }
}

/// Parameters of the collision, which all scenes share. Eddies keep fast flow in order on meshes too coarse for it, and leave
/// it as it is on others (`docs/scenes.md`).
const COLLISION: [Parameter; 3] = [
    Parameter::choice(
        "collision",
        &["central-moments", "cumulant", "regularised", "trt", "mrt", "bgk"],
        "how populations relax",
    ),
    Parameter::number(
        "magic",
        3.0 / 16.0,
        [1e-3, 10.0],
        "",
        "magic parameter (Ginzburg et al. 2008)",
    )
    .only_with("collision", &["trt", "mrt"]),
    Parameter::number(
        "smagorinsky",
        0.12,
        [0.0, 1.0],
        "",
        "constant of eddies that the mesh does not hold (Smagorinsky 1963); 0: none",
    ),
];

/// The same for flow that needs none to stay in order.
fn without_eddies() -> [Parameter; 3] {
    COLLISION.map(|parameter| match parameter.name {
        "smagorinsky" => parameter.with_default(0.0),
        _ => parameter,
    })
}

/// The same for slow flow along walls, which two relaxation times keep where they are.
fn slow_collision() -> [Parameter; 3] {
    without_eddies().map(|parameter| match parameter.name {
        "collision" => parameter.with_default_choice("trt"),
        _ => parameter,
    })
}

/// For scenes with bodies.
const WALL: Parameter = Parameter::choice(
    "wall",
    &["interpolated", "half-way"],
    "where populations are turned back (Bouzidi et al. 2001; Ladd 1994)",
);

/// For scenes in space.
const LATTICE: Parameter =
    Parameter::choice("lattice", &["d3q19", "d3q27"], "velocities, in 3-D; d2q9 in the plane")
        .only_with("dim", &["3"]);

/// For creeping flows.
const RELAXATION_TIME: Parameter = Parameter::number(
    "relaxation_time",
    0.8,
    [0.5001, 100.0],
    "",
    "of the viscosity, in time steps: the time step follows from it",
);

/// For faster flows.
const MACH: Parameter = Parameter::number(
    "mach",
    0.1,
    [1e-4, 0.3],
    "",
    "largest speed over sound speed, about: the time step follows from it",
);

/// What the parameters say about the discretisation.
fn scheme(parameters: &Parameters, lattice: LatticeKind, has_walls: bool) -> Scheme {
    Scheme {
        lattice,
        collision: match parameters.choice("collision") {
            "bgk" => Collision::Bgk,
            "cumulant" => Collision::Cumulant,
            "regularised" => Collision::Regularised,
            "trt" => Collision::Trt { magic: parameters.number("magic") },
            "mrt" => Collision::Mrt { magic: parameters.number("magic") },
            _ => Collision::CentralMoments,
        },
        wall: match has_walls && parameters.choice("wall") == "half-way" {
            true => Wall::HalfWay,
            false => Wall::Interpolated,
        },
        streaming: None,
        smagorinsky: Some(parameters.number("smagorinsky")).filter(|constant| *constant > 0.0),
    }
}

/// The lattice of a scene in 2-D or 3-D.
fn lattice(parameters: &Parameters, dims: usize) -> LatticeKind {
    match (dims, parameters.choice("lattice")) {
        (2, _) => LatticeKind::D2Q9,
        (_, "d3q27") => LatticeKind::D3Q27,
        _ => LatticeKind::D3Q19,
    }
}

/// What a scene adds to a run.
trait Flow<T: Compiled> {
    /// When it ends if nobody says otherwise, s.
    fn end_time(&self) -> f64;

    /// Adds monitors and stop criteria.
    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid>;

    /// Draws results from the histories and the final state.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        lbm: &Final<T>,
    );

    /// Title of the picture of the final field.
    fn title(&self) -> String;
}

/// What is known of a model at the end of its run.
struct Final<T> {
    parts: Parts<T>,
    mesh: Mesh,
    fields: finegrain_lbm::Fields<T>,
}

impl<T: Compiled> Final<T> {
    /// Velocity of a site, m/s.
    fn velocity(&self, simulation: &Simulation<Grid>, [x, y, z]: [usize; 3]) -> [f64; 3] {
        let [nx, ny, _] = self.mesh.shape;
        let mut velocity = [0.0; 3];
        for (v, &column) in velocity.iter_mut().zip(&self.fields.velocity) {
            *v = simulation.columns().values(column)[(z * ny + y) * nx + x].as_f64();
        }
        velocity
    }

    /// Velocity along x and y at a point of the lowest plane, m/s, by cubics through four sites in each
    /// direction, around periodic ends; sites in bodies count as at rest.
    fn interpolated_velocity(&self, simulation: &Simulation<Grid>, point: [f64; 2]) -> [f64; 2] {
        let first = self.position([0; 3]);
        let place = [0, 1].map(|a| (point[a] - first[a]) / self.mesh.spacing);
        let lowest = place.map(|p| p.floor() as isize - 1);
        let [along_x, along_y] = place.map(|p| cubic::weights(p - p.floor()));
        let mut velocity = [0.0; 2];
        for (dy, wy) in (0..).zip(along_y) {
            for (dx, wx) in (0..).zip(along_x) {
                let [nx, ny, _] = self.mesh.shape.map(|n| n as isize);
                let x = (lowest[0] + dx).rem_euclid(nx) as usize;
                let y = (lowest[1] + dy).rem_euclid(ny) as usize;
                let found = self.velocity(simulation, [x, y, 0]);
                for a in 0..2 {
                    velocity[a] += wx * wy * found[a];
                }
            }
        }
        velocity
    }

    /// Position of a site, m.
    fn position(&self, site: [usize; 3]) -> [f64; 3] {
        self.mesh.position(site.map(|i| i as isize))
    }

    /// All sites, in bodies, too, x running fastest.
    fn sites(&self) -> impl Iterator<Item = [usize; 3]> + use<T> {
        let [nx, ny, nz] = self.mesh.shape;
        (0..nx * ny * nz).map(move |i| [i % nx, i / nx % ny, i / (nx * ny)])
    }
}

/// A scene with its model.
struct LbmScene<T: Compiled> {
    lbm: Lbm<T>,
    fluid: Fluid,
    flow: Box<dyn Flow<T>>,
    /// What is modelled, for checkpoints.
    description: String,
}

/// Builds a scene's model.
fn scene<T: Compiled>(
    flow: impl Flow<T> + 'static,
    mesh: &Mesh,
    fluid: Fluid,
    physics: &Physics,
    scheme: &Scheme,
    start: &Start,
    description: String,
) -> Result<LbmScene<T>, SceneError> {
    let lbm = Lbm::new(mesh, &fluid, physics, scheme, start)?;
    Ok(LbmScene { lbm, fluid, flow: Box::new(flow), description })
}

impl<T: Compiled> Prepared for LbmScene<T> {
    fn points(&self) -> usize {
        self.lbm.mesh.sites()
    }

    /// Measured: two workers are faster than one from some 8,000 sites on.
    fn points_per_worker(&self) -> usize {
        4000
    }

    fn run(self: Box<Self>, orders: Orders) -> Result<Report, SceneError> {
        let workers = self.workers(&orders);
        let Self { lbm, fluid, flow, description } = *self;
        let Lbm { model, fields, mesh, parts } = lbm;
        let (simulation, trace) = (orders.simulation(model, workers)?, orders.trace.clone());
        let run = flow.observe(Run::new(simulation).scene(description), &parts);
        let mut run = orders.plan(run, flow.end_time(), |every| {
            let velocity = &["velocity_x", "velocity_y", "velocity_z"][..fields.velocity.len()];
            Dump::new("fields", every)
                .scalar("pressure")
                .scalar("solid")
                .vector("velocity", velocity.iter().copied())
        });
        let summary = run.run()?;
        let mut report = Report::new(&summary, mesh.sites());
        let simulation = run.simulation_mut();
        report.trace(simulation, trace)?;
        let relaxation_time = mesh.relaxation_time(fluid.kinematic_viscosity);
        report.results.insert("relaxation_time", relaxation_time);
        let speed = measure::largest_speed(&mut simulation.whole(), &parts);
        report.results.insert("mach_reached", mesh.mach(speed));
        let before = summary.histories.iter().filter_map(|history| history.column("largest_speed"));
        let largest = before.flatten().fold(speed, f64::max);
        report.results.insert("largest_mach", mesh.mach(largest));
        let lbm = Final { parts, mesh, fields };
        report.notes.extend(unresolved(&lbm.mesh, &fluid));
        flow.judge(&mut report, &summary, simulation, &lbm);
        report.picture = Some(picture(simulation, &lbm, flow.title()));
        Ok(report)
    }
}

/// What to know of a flow whose smallest eddies, in the plane `sqrt(nu L / U)` (Henshaw, Kreiss & Reyna 1989, Theoret.
/// Comput. Fluid Dynamics 1, 65-95), and layers at walls, as thin, are smaller than the spacing even if L is the whole mesh:
/// the grid Reynolds number is then above the number of sites.
fn unresolved(mesh: &Mesh, fluid: &Fluid) -> Option<String> {
    let grid_reynolds = fluid.largest_speed * mesh.spacing / fluid.kinematic_viscosity;
    let sites = mesh.shape.into_iter().max().unwrap_or(1);
    (grid_reynolds > sites as f64).then(|| {
        format!(
            "not resolved: the grid Reynolds number U dx / nu is {grid_reynolds:.3e}, above the {sites} sites along the \
             mesh, so that the smallest eddies (Henshaw, Kreiss & Reyna 1989) are smaller than the spacing"
        )
    })
}

/// Speed in the plane, or in 3-D in a slice through the middle; undefined in bodies.
fn picture<T: Compiled>(simulation: &Simulation<Grid>, lbm: &Final<T>, title: String) -> Picture {
    let Mesh { shape: [nx, ny, nz], spacing, .. } = lbm.mesh;
    let solid = simulation.columns().values(lbm.fields.solid);
    let speed = lbm.sites().filter(|site| site[2] == nz / 2).map(|site| {
        let [u, v, w] = lbm.velocity(simulation, site);
        let is_fluid = solid[(site[2] * ny + site[1]) * nx + site[0]] == 0;
        if is_fluid { u.hypot(v).hypot(w) } else { f64::NAN }
    });
    let [x, y, _] = lbm.position([0; 3]);
    Field::of_grid([nx, ny], [x, y], [spacing; 2], speed)
        .title(at_time(title, simulation.clock().time()))
        .quantity(Axis::new("speed").unit("m/s"))
        .into()
}

/// Everything that is modelled, for checkpoints.
fn description(scene: &str, parameters: &Parameters, precision: Precision) -> String {
    super::description(scene, "lbm", parameters, precision)
}
