//! How smoothed particle hydrodynamics takes part in the scenes.

/// Defines `prepare`, which makes a scene ready by a function `build::<T, P>(parameters, precision)`,
/// in the scalar types asked for: `P` for positions and `T` for all else.
macro_rules! prepare_with {
    ($build:ident) => {
        /// Prepares the scene.
        pub fn prepare(
            parameters: &$crate::scene::Parameters,
            precision: $crate::scene::Precision,
        ) -> Result<Box<dyn $crate::scene::Prepared>, $crate::scene::SceneError> {
            use $crate::scene::Precision;
            Ok(match precision {
                Precision::F32 => Box::new($build::<f32, f32>(parameters, precision)?),
                Precision::F64 => Box::new($build::<f64, f64>(parameters, precision)?),
                Precision::Mixed => Box::new($build::<f32, f64>(parameters, precision)?),
            })
        }
    };
}

pub mod cavity;
pub mod channel;
pub mod channel_cylinder;
pub mod cylinder;
pub mod dam_break;
pub mod drop;
pub mod free_surface;
mod gas;
pub mod hydrostatic_tank;
pub mod noh;
pub mod rotating_patch;
pub mod sod;
pub mod standing_wave;
pub mod tank;
pub mod taylor_green;

mod profile;

use finegrain_framework::run::{Dump, Run, Summary};
use finegrain_framework::space::Cells;
use finegrain_framework::{Integrator, Real, Simulation, State};
use finegrain_sph::{
    Density, Edac, Fields, Gradient, Pairs, PressureForm, Scheme, SmoothingFunction, Sph,
    StateEquation, Viscosity, WallPressure, WallVelocity, measure,
};

use super::parameter::{Parameter, Parameters};
use super::report::Picture;
use super::{Orders, Prepared, Report, SceneError, at_time};
use crate::figure::{Axis, Field, Outline};

/// Parameters of the discretisation that scenes of all liquids share.
const LIQUID_PARAMETERS: [Parameter; 8] = [
    Parameter::choice(
        "kernel",
        &[
            "gaussian",
            "cubic-spline",
            "quartic-spline",
            "quintic-spline",
            "wendland-c2",
            "wendland-c4",
            "wendland-c6",
        ],
        "smoothing kernel",
    ),
    Parameter::number("smoothing_ratio", 1.0, [0.8, 3.0], "", "smoothing length over spacing"),
    Parameter::choice(
        "integrator",
        &["leapfrog", "symplectic-euler", "rk2", "ssp-rk3", "rk4", "euler"],
        "how time is stepped",
    ),
    Parameter::number(
        "courant",
        1.0,
        [1e-3, 10.0],
        "",
        "time step over the limits of Morris et al. (1997); with more than 1 a flow may blow up",
    ),
    Parameter::number("mach", 0.1, [1e-4, 0.5], "", "largest speed over sound speed, about"),
    Parameter::choice(
        "pressure_form",
        &["symmetric", "density-weighted", "antisymmetric"],
        "eq. I.2 of Holmes et al. (2011), Adami et al. (2012), or differences, which do not conserve \
         momentum",
    ),
    Parameter::choice(
        "gradient",
        &["kernel", "corrected"],
        "in velocity gradients and the antisymmetric pressure gradient: of the kernel, or exact for \
         linear fields (Bonet & Lok 1999)",
    ),
    Parameter::choice(
        "pairs",
        &["searched", "kept"],
        "every sweep searches for neighbours, or those after the first look up what it has found, at two \
         bytes a pair; the same bits",
    ),
];

/// What the parameters of all liquids say about the discretisation.
fn liquid_scheme(parameters: &Parameters) -> Scheme {
    Scheme {
        kernel: kernel(parameters),
        smoothing_ratio: parameters.number("smoothing_ratio"),
        integrator: parameters.choice("integrator").parse().unwrap_or(Integrator::Leapfrog),
        courant_number: parameters.number("courant"),
        pressure_form: match parameters.choice("pressure_form") {
            "density-weighted" => PressureForm::DensityWeighted,
            "antisymmetric" => PressureForm::Antisymmetric,
            _ => PressureForm::Symmetric,
        },
        gradient: match parameters.choice("gradient") {
            "corrected" => Gradient::Corrected,
            _ => Gradient::Kernel,
        },
        pairs: match parameters.choice("pairs") {
            "kept" => Pairs::Kept,
            _ => Pairs::Searched,
        },
        ..Scheme::default()
    }
}

/// Further parameters of the discretisation that scenes without a free surface share.
const PARAMETERS: [Parameter; 6] = [
    Parameter::choice(
        "viscous_form",
        &["morris", "strain-rate", "adami", "monaghan"],
        "Morris et al. (1997), eq. I.2 of Holmes et al. (2011), Adami et al. (2012), or Monaghan \
         (2005), which conserves angular momentum",
    ),
    Parameter::choice(
        "density",
        &["continuity", "summation"],
        "density evolves by the equation of continuity, or is a sum over particles",
    ),
    Parameter::choice(
        "pressure",
        &["state-equation", "edac"],
        "pressure follows from density, or evolves with diffusion (Ramachandran & Puri 2019)",
    ),
    Parameter::number(
        "edac_diffusion",
        0.5,
        [0.0, 10.0],
        "",
        "diffusivity of the pressure in units of h c / 8",
    )
    .only_with("pressure", &["edac"]),
    Parameter::number(
        "transport",
        0.0,
        [0.0, 20.0],
        "",
        "strength of the transport velocity (Adami et al. 2013), with density=summation; 0 is none, 1 \
         is theirs",
    ),
    Parameter::number(
        "background_pressure",
        0.0,
        [0.0, 1.0],
        "",
        "added to the equation of state, in units of density times sound speed squared",
    ),
];

/// What the parameters say about the discretisation.
fn scheme(parameters: &Parameters) -> Scheme {
    Scheme {
        density: match parameters.choice("density") {
            "summation" => Density::Summation,
            _ => Density::Continuity,
        },
        edac: (parameters.choice("pressure") == "edac")
            .then(|| Edac { diffusion: parameters.number("edac_diffusion") }),
        transport: parameters.number("transport"),
        ..liquid_scheme(parameters)
    }
}

fn kernel(parameters: &Parameters) -> SmoothingFunction {
    match parameters.choice("kernel") {
        "cubic-spline" => SmoothingFunction::CubicSpline,
        "quartic-spline" => SmoothingFunction::QuarticSpline,
        "quintic-spline" => SmoothingFunction::QuinticSpline,
        "wendland-c2" => SmoothingFunction::WendlandC2,
        "wendland-c4" => SmoothingFunction::WendlandC4,
        "wendland-c6" => SmoothingFunction::WendlandC6,
        _ => SmoothingFunction::Gaussian,
    }
}

/// Parameters of the particles that fill bodies, for scenes that have bodies.
const WALL_PARAMETERS: [Parameter; 3] = [
    Parameter::choice(
        "wall_pressure",
        &["evolved", "extrapolated"],
        "pressure in bodies: from a density of their own, or from the fluid (Adami et al. 2012)",
    ),
    Parameter::choice(
        "wall_velocity",
        &["linear", "mirrored", "fitted"],
        "velocity in bodies: linear profile (Morris et al. 1997), of Adami et al. (2012), or fitted",
    ),
    Parameter::number(
        "beta_max",
        3.0,
        [1.0, 100.0],
        "",
        "largest extrapolation of the velocity into bodies",
    )
    .only_with("wall_velocity", &["linear"]),
];

/// Choices of flows around and between bodies: particles kept even by a transport velocity, pressure by
/// EDAC, walls that take theirs from the fluid.
const EVEN_AND_STEADY: [(&str, &str); 6] = [
    ("kernel", "quintic-spline"),
    ("viscous_form", "adami"),
    ("density", "summation"),
    ("pressure", "edac"),
    ("pressure_form", "density-weighted"),
    ("wall_pressure", "extrapolated"),
];

/// What the parameters say about the discretisation, with bodies.
fn scheme_with_walls(parameters: &Parameters) -> Scheme {
    Scheme {
        wall_pressure: match parameters.choice("wall_pressure") {
            "extrapolated" => WallPressure::Extrapolated,
            _ => WallPressure::Evolved,
        },
        wall_velocity: match parameters.choice("wall_velocity") {
            "mirrored" => WallVelocity::Mirrored,
            "fitted" => WallVelocity::Fitted,
            _ => WallVelocity::Linear,
        },
        beta_max: parameters.number("beta_max"),
        ..scheme(parameters)
    }
}

/// All parameters of a scene, with its own defaults put over those that are shared.
fn with_defaults(
    parameters: &[&[Parameter]],
    numbers: &[(&str, f64)],
    choices: &[(&str, &'static str)],
) -> Vec<Parameter> {
    let own = |parameter: &Parameter| {
        let number = numbers.iter().find(|(name, _)| *name == parameter.name);
        let choice = choices.iter().find(|(name, _)| *name == parameter.name);
        match (number, choice) {
            (Some(&(_, value)), _) => parameter.with_default(value),
            (_, Some(&(_, name))) => parameter.with_default_choice(name),
            _ => *parameter,
        }
    };
    parameters.concat().iter().map(own).collect()
}

fn viscosity(parameters: &Parameters) -> Viscosity {
    match parameters.choice("viscous_form") {
        "strain-rate" => Viscosity::StrainRate,
        "adami" => Viscosity::Adami,
        "monaghan" => Viscosity::Monaghan,
        _ => Viscosity::Morris,
    }
}

fn state_equation(parameters: &Parameters) -> StateEquation {
    StateEquation::Linear { background: parameters.number("background_pressure") }
}

/// What a scene adds to a run of SPH.
trait Flow<T: Real, P: Real> {
    /// When it ends if nobody says otherwise, s.
    fn end_time(&self) -> f64;

    /// Adds monitors and stop criteria.
    fn observe(&self, run: Run<Cells<P>>, fields: &Fields<T, P>, mass: f64) -> Run<Cells<P>>;

    /// Draws results from the histories and the final state.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Cells<P>>,
        fields: &Fields<T, P>,
        mass: f64,
    );

    /// Title of the picture of the final field, and the unit of speed.
    fn title(&self) -> String;

    /// Spacing of the particles, m.
    fn spacing(&self) -> f64;

    /// Outlines of bodies in the plane of the picture.
    fn outlines(&self) -> Vec<Outline> {
        Vec::new()
    }

    /// The picture of the end: by default of the speed.
    fn picture(&self, simulation: &Simulation<Cells<P>>, fields: &Fields<T, P>) -> Picture {
        let field = picture(simulation, fields, self.title(), self.spacing());
        self.outlines().into_iter().fold(field, Field::outline).into()
    }
}

/// A scene with its SPH model.
struct SphScene<T: Real, P: Real> {
    sph: Sph<T, P>,
    flow: Box<dyn Flow<T, P>>,
    /// What is modelled, for checkpoints.
    description: String,
}

impl<T: Real, P: Real> Prepared for SphScene<T, P> {
    fn points(&self) -> usize {
        self.sph.model.columns.points()
    }

    /// Two sub-domains: a particle takes some thirty times as long as a site of a lattice.
    fn points_per_worker(&self) -> usize {
        500
    }

    fn run(self: Box<Self>, orders: Orders) -> Result<Report, SceneError> {
        let workers = self.workers(&orders);
        let Self { sph, flow, description } = *self;
        let Sph { model, fields, particle_mass } = sph;
        let points = model.columns.points();
        let (simulation, trace) = (orders.simulation(model, workers)?, orders.trace.clone());
        let run = flow.observe(Run::new(simulation).scene(description), &fields, particle_mass);
        let mut run = orders.plan(run, flow.end_time(), |every| {
            let dims = fields.velocity.len();
            let velocity = &["velocity_x", "velocity_y", "velocity_z"][..dims];
            let mut dump = Dump::new("fields", every)
                .scalar("identity")
                .scalar("density")
                .vector("velocity", velocity.iter().copied());
            if fields.wall_depth.is_some() {
                dump = dump.scalar("wall_depth");
            }
            if fields.energy.is_some() {
                dump = dump.scalar("energy");
            }
            dump
        });
        let summary = run.run()?;
        let mut report = Report::new(&summary, points);
        let simulation = run.simulation_mut();
        report.trace(simulation, trace)?;
        flow.judge(&mut report, &summary, simulation, &fields, particle_mass);
        // Over the spacing: a sign of clumping.
        let closest = measure::closest_pair(&mut simulation.whole()) / flow.spacing();
        report.results.insert("closest_pair", closest);
        report.picture = Some(flow.picture(simulation, &fields));
        Ok(report)
    }
}

/// Speed in the plane, or in 3-D in a slice through the middle.
pub(crate) fn picture<T: Real, P: Real>(
    simulation: &Simulation<Cells<P>>,
    fields: &Fields<T, P>,
    title: String,
    spacing: f64,
) -> Field {
    let columns = simulation.columns();
    let region = simulation.domain().region();
    let value = |handle: State<T>, i: usize| columns.values(handle)[i].as_f64();
    let place = |handle: State<P>, i: usize| columns.values(handle)[i].as_f64();
    let mut points = Vec::new();
    for i in 0..columns.points() {
        if let Some(&z) = fields.position.get(2) {
            let middle = 0.5 * (region.lower[2] + region.upper[2]);
            if (place(z, i) - middle).abs() > 0.5 * spacing {
                continue;
            }
        }
        if fields.wall_depth.is_some_and(|depth| value(depth, i) > 0.0) {
            continue;
        }
        let at = [place(fields.position[0], i), place(fields.position[1], i)];
        let squared: f64 = fields.velocity.iter().map(|&v| value(v, i).powi(2)).sum();
        points.push((at, squared.sqrt()));
    }
    Field::of_points(points, spacing)
        .title(at_time(title, simulation.clock().time()))
        .quantity(Axis::new("speed").unit("m/s"))
        .window([region.lower[0], region.lower[1]], [region.upper[0], region.upper[1]])
        .periodic([region.periodic[0], region.periodic[1]])
}

/// Everything that is modelled, for checkpoints.
fn description(scene: &str, parameters: &Parameters, precision: super::Precision) -> String {
    super::description(scene, "sph", parameters, precision)
}
