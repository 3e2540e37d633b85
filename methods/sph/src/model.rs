//! Builds an SPH model from particles, a fluid and a choice of physics.

use finegrain_framework::shape::{Shape, ShapeError};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::{CellsOptions, Region};
use finegrain_framework::{
    Columns, Evolution, Fault, Handle, Integrator, Model, PartitionError, Real, Stage,
};

use crate::dimension::Dimension;
use crate::fields::Fields;
use crate::kernel::{Kernel, SmoothingFunction};
use crate::neighbourhood::Gathered;
use crate::pacing::{Sort, TimeStepControl};
use crate::state_equation::{StateEquation, Thermodynamics};
use crate::sweep::Sweep;
use crate::term::{Term, Viscosity, energy, strain_rate, viscosity};
use crate::wall::{NoSlip, Walls};

/// A weakly compressible fluid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluid {
    /// Reference density, kg/m^3.
    pub density: f64,
    /// Numerical sound speed, m/s: some ten times the largest speed.
    pub sound_speed: f64,
    /// Kinematic viscosity, m^2/s.
    pub kinematic_viscosity: f64,
    /// Pressure from density.
    pub state_equation: StateEquation,
}

/// What is modelled besides mass and pressure; what is not named here costs nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Physics {
    /// Viscous term, if any.
    pub viscosity: Option<Viscosity>,
    /// Energy equation.
    pub energy: bool,
    /// Constant acceleration of the fluid, m/s^2; zero if none.
    pub body_acceleration: [f64; 3],
    /// Bodies, filled with particles at rest and without slip.
    pub bodies: Vec<Shape>,
}

/// How it is discretised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Smoothing kernel.
    pub kernel: SmoothingFunction,
    /// Smoothing length in units of the particle spacing.
    pub smoothing_ratio: f64,
    /// How time is stepped.
    pub integrator: Integrator,
    /// Fraction of the stability limits that is used as time step.
    pub courant_number: f64,
    /// How much further than the support cells see, in particle spacings.
    pub skin: f64,
    /// Largest extrapolation of the velocity into bodies, `beta_max` of Morris et al. (1997).
    pub beta_max: f64,
}

impl Default for Scheme {
    /// The paper's: Gaussian with h equal to the spacing, leapfrog.
    fn default() -> Self {
        Self {
            kernel: SmoothingFunction::Gaussian,
            smoothing_ratio: 1.0,
            integrator: Integrator::Leapfrog,
            courant_number: 1.0,
            skin: 0.2,
            beta_max: 1.5,
        }
    }
}

/// Particles at the beginning.
#[derive(Clone, Debug)]
pub struct Start {
    /// Where they live.
    pub region: Region,
    /// Distance of neighbouring particles, m.
    pub spacing: f64,
    /// Volume of one particle, m^3 (m^2 in 2-D, m in 1-D).
    pub particle_volume: f64,
    /// Positions, m.
    pub positions: Vec<[f64; 3]>,
    /// Velocities, m/s; at rest if empty.
    pub velocities: Vec<[f64; 3]>,
}

/// Why a model could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SphError {
    /// A number is outside its valid range.
    #[error("{name} is {value}; it must be {range}")]
    OutOfRange {
        /// What it is.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// There are no particles, or not as many velocities.
    #[error("{positions} particles with {velocities} velocities: there must be some, and as many")]
    Particles {
        /// Number of positions.
        positions: usize,
        /// Number of velocities.
        velocities: usize,
    },
    /// A body makes no sense.
    #[error("body {number}: {cause}")]
    Body {
        /// Which.
        number: usize,
        /// Why.
        cause: ShapeError,
    },
    /// Space could not be divided.
    #[error(transparent)]
    Space(#[from] Fault),
    /// Space could not be divided.
    #[error(transparent)]
    Partition(#[from] PartitionError),
}

/// A model and the handles of its fields.
pub struct Sph<T: Real> {
    /// To be run by the framework.
    pub model: Model<Cells<T>>,
    /// Its fields.
    pub fields: Fields<T>,
    /// Mass of every particle, kg (per m in 2-D).
    pub particle_mass: f64,
}

fn positive(name: &'static str, value: f64) -> Result<(), SphError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(SphError::OutOfRange { name, value, range: "finite and above zero" })
    }
}

fn not_negative(name: &'static str, value: f64) -> Result<(), SphError> {
    if value >= 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(SphError::OutOfRange { name, value, range: "finite and not negative" })
    }
}

impl<T: Real> Sph<T> {
    /// Builds a model in as many dimensions as the region has.
    ///
    /// # Errors
    /// If a number is outside its valid range; the message names it.
    pub fn new(
        start: &Start,
        fluid: &Fluid,
        physics: &Physics,
        scheme: &Scheme,
    ) -> Result<Self, SphError> {
        match start.region.lower.len() {
            1 => build::<T, 1>(start, fluid, physics, scheme, Dimension::One),
            2 => build::<T, 2>(start, fluid, physics, scheme, Dimension::Two),
            _ => build::<T, 3>(start, fluid, physics, scheme, Dimension::Three),
        }
    }
}

fn check(start: &Start, fluid: &Fluid, physics: &Physics, scheme: &Scheme) -> Result<(), SphError> {
    positive("spacing", start.spacing)?;
    positive("particle_volume", start.particle_volume)?;
    positive("density", fluid.density)?;
    positive("sound_speed", fluid.sound_speed)?;
    not_negative("kinematic_viscosity", fluid.kinematic_viscosity)?;
    positive("smoothing_ratio", scheme.smoothing_ratio)?;
    positive("courant_number", scheme.courant_number)?;
    positive("skin", scheme.skin)?;
    positive("beta_max", scheme.beta_max)?;
    for acceleration in physics.body_acceleration {
        if !acceleration.is_finite() {
            return Err(SphError::OutOfRange {
                name: "body_acceleration",
                value: acceleration,
                range: "finite",
            });
        }
    }
    for (number, shape) in physics.bodies.iter().enumerate() {
        shape.check().map_err(|cause| SphError::Body { number, cause })?;
    }
    let (positions, velocities) = (start.positions.len(), start.velocities.len());
    if positions == 0 || (velocities != 0 && velocities != positions) {
        return Err(SphError::Particles { positions, velocities });
    }
    Ok(())
}

/// The terms that `physics` names, in the order in which they are added.
fn terms<T: Real>(fluid: &Fluid, physics: &Physics, smoothing_length: f64) -> Vec<Term<T>> {
    let dynamic_viscosity = T::of(fluid.density * fluid.kinematic_viscosity);
    let strain_rate = Term::StrainRate(strain_rate::StrainRate { dynamic_viscosity });
    let is_viscous = physics.viscosity.is_some();
    let mut terms = vec![Term::Continuity];
    if physics.viscosity == Some(Viscosity::StrainRate) || (physics.energy && is_viscous) {
        terms.push(strain_rate);
    }
    terms.push(Term::PressureGradient);
    match physics.viscosity {
        Some(Viscosity::StrainRate) => terms.push(Term::StressDivergence),
        Some(Viscosity::Morris) => terms.push(Term::MorrisViscosity(viscosity::Morris {
            dynamic_viscosity,
            eta_squared: T::of(0.01 * smoothing_length * smoothing_length),
        })),
        None => {}
    }
    if physics.energy {
        let dynamic_viscosity = if is_viscous { dynamic_viscosity } else { T::zero() };
        terms.push(Term::Energy(energy::Energy { dynamic_viscosity }));
    }
    terms
}

fn build<T: Real, const D: usize>(
    start: &Start,
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
    dimension: Dimension,
) -> Result<Sph<T>, SphError> {
    check(start, fluid, physics, scheme)?;
    let smoothing_length = scheme.smoothing_ratio * start.spacing;
    let kernel = Kernel::new(scheme.kernel, dimension, T::of(smoothing_length));
    let particle_mass = fluid.density * start.particle_volume;
    let terms = terms::<T>(fluid, physics, smoothing_length);
    let range = kernel.support_radius().as_f64();
    let walls = Walls::new(&physics.bodies, &start.region, range);

    let mut columns = Columns::new(start.positions.len());
    let has_bodies = !physics.bodies.is_empty();
    let fields = Fields::<T>::declare(&mut columns, D, has_bodies, &terms);
    fill(&mut columns, &fields, start, fluid, &walls);
    let options = CellsOptions {
        region: start.region.clone(),
        range,
        skin: scheme.skin * start.spacing,
        block_points: 64,
    };
    let domain = Cells::new(&mut columns, &fields.position, options)?;

    let no_slip = has_bodies.then(|| NoSlip {
        walls,
        most: T::of(scheme.beta_max - 1.0),
        least_distance: T::of(1e-3 * start.spacing),
    });
    // Terms that need other particles' strain rates run in a second sweep, and the acceleration
    // is summed in the last one.
    let needs_second = terms.iter().any(Term::is_second);
    let (second, first): (Vec<_>, Vec<_>) = terms.iter().copied().partition(|term| {
        needs_second
            && (term.is_second()
                || matches!(term, Term::PressureGradient | Term::MorrisViscosity(_)))
    });
    let sweeps = [("rates", first), ("accelerations", second)];
    let last = usize::from(needs_second);
    let mut evaluation = vec![Stage::update(Thermodynamics {
        fields: fields.clone(),
        equation: fluid.state_equation,
        particle_mass: T::of(particle_mass),
        reference_density: T::of(fluid.density),
        sound_speed: T::of(fluid.sound_speed),
    })];
    for (number, (name, terms)) in sweeps.into_iter().enumerate().take(last + 1) {
        let quantities = terms
            .iter()
            .flat_map(|term| term.reads(D))
            .chain(has_bodies.then_some(crate::neighbourhood::Quantity::WallDepth))
            .collect();
        evaluation.push(Stage::rate(Sweep::<T, D> {
            name: format!("sph {name}"),
            gathered: Gathered::new(&fields, quantities),
            fields: fields.clone(),
            kernel,
            terms,
            particle_mass: T::of(particle_mass),
            body_acceleration: (number == last)
                .then(|| std::array::from_fn(|a| T::of(physics.body_acceleration[a]))),
            no_slip: no_slip.clone(),
        }));
    }

    // The time step follows from the last accelerations: they must survive a restart.
    for &acceleration in &fields.acceleration {
        columns.keep(acceleration.id());
    }
    let mut evolution = Evolution::new().with(fields.density, fields.density_rate);
    for a in 0..D {
        evolution = evolution
            .with_motion(fields.position[a], fields.velocity[a])
            .with(fields.velocity[a], fields.acceleration[a]);
    }
    if let (Some(energy), Some(rate)) = (fields.energy, fields.energy_rate) {
        evolution = evolution.with(energy, rate);
    }
    let plan = scheme.integrator.plan(&mut columns, &evolution, &evaluation);
    let magnitude = physics.body_acceleration.iter().map(|a| a * a).sum::<f64>().sqrt();
    let pacing = TimeStepControl {
        fields: fields.clone(),
        smoothing_length,
        sound_speed: fluid.sound_speed,
        kinematic_viscosity: physics.viscosity.map_or(0.0, |_| fluid.kinematic_viscosity),
        body_acceleration: magnitude,
        courant_number: scheme.courant_number,
        most_steps: 20,
    };
    let model = Model {
        method: "sph".to_owned(),
        domain,
        columns,
        plan,
        whole: vec![Box::new(Sort)],
        pacing: Box::new(pacing),
    };
    Ok(Sph { model, fields, particle_mass })
}

/// Sets the initial state.
fn fill<T: Real>(
    columns: &mut Columns,
    fields: &Fields<T>,
    start: &Start,
    fluid: &Fluid,
    walls: &Walls,
) {
    for (a, (&position, &velocity)) in fields.position.iter().zip(&fields.velocity).enumerate() {
        for (x, at) in columns.values_mut(position).iter_mut().zip(&start.positions) {
            *x = T::of(at[a]);
        }
        for (v, given) in columns.values_mut(velocity).iter_mut().zip(&start.velocities) {
            *v = T::of(given[a]);
        }
    }
    columns.values_mut(fields.density).fill(T::of(fluid.density));
    for (i, identity) in columns.values_mut(fields.identity).iter_mut().enumerate() {
        *identity = i as u32;
    }
    if let Some(wall_depth) = fields.wall_depth {
        for (depth, &at) in columns.values_mut(wall_depth).iter_mut().zip(&start.positions) {
            *depth = T::of((-walls.signed_distance(at)).max(0.0));
        }
        for &velocity in &fields.velocity {
            for i in 0..start.positions.len() {
                if columns.values(wall_depth)[i] > T::zero() {
                    columns.values_mut(velocity)[i] = T::zero();
                }
            }
        }
    }
}
