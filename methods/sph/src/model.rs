//! Builds an SPH model from particles, a fluid and a choice of physics.

use std::any::{Any, TypeId};

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::CellsOptions;
use finegrain_framework::{Columns, Evolution, Handle, Model, Pacing, Real, Stage};

use crate::body::{Body, Slip, WallPressure, WallVelocity};
use crate::correction::Correction;
use crate::dimension::Dimension;
use crate::error::SphError;
use crate::evaluation::{Piece, slots};
use crate::fields::Fields;
use crate::gas;
use crate::gas_pacing::GasPacing;
use crate::initial_state::InitialState;
use crate::kernel::Kernel;
use crate::kernel::adaptive::{AdaptiveKernel, Kernels};
use crate::pacing::{Sort, TimeStepControl};
use crate::physics::{Fluid, Physics, Viscosity};
use crate::quantity::Quantity;
use crate::scheme::{Density, Gradient, PressureForm, Scheme};
use crate::smoothing::Smoothing;
use crate::start::Start;
use crate::start_check;
use crate::state_equation::{StateEquation, Thermodynamics};
use crate::sweep::Sweep;
use crate::term::continuity::Continuity;
use crate::term::edac::PressureEvolution;
use crate::term::energy::Energy;
use crate::term::momentum::{PressureGradient, StressDivergence};
use crate::term::monaghan_viscosity::MonaghanViscosity;
use crate::term::number_density::NumberDensity;
use crate::term::pressure_difference::PressureDifference;
use crate::term::strain_rate::StrainRate;
use crate::term::transport::{Drift, DriftStress};
use crate::term::viscosity::MorrisViscosity;
use crate::term::wall_pressure;
use crate::term::wall_velocity::MirroredVelocity;
use crate::term::weighted::{WeightedPressureGradient, WeightedViscosity};
use crate::term::{AnyTerm, Term};
use crate::wall::{Friction, NoSlip, VelocityInBodies, Walls};
use crate::wall_state::WallState;

/// A model and the handles of its fields.
///
/// Positions may be more precise than the rest: `Sph<f32, f64>`, mixed precision, keeps positions and
/// their motion in `f64`, and computes what particles do to each other in `f32` from positions
/// relative to the cell that they are in.
pub struct Sph<T: Real, P: Real = T> {
    /// To be run by the framework.
    pub model: Model<Cells<P>>,
    /// Its fields.
    pub fields: Fields<T, P>,
    /// Mass of every particle, kg (per m in 2-D).
    pub particle_mass: f64,
}

impl<T: Real, P: Real> Sph<T, P> {
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
        start.check()?;
        fluid.check()?;
        physics.check()?;
        scheme.check()?;
        gas::check(fluid, physics, scheme)?;
        if scheme.edac.is_some() && physics.energy {
            let (choice, others) = ("scheme.edac", "physics.energy = false");
            return Err(SphError::Choice { choice, others });
        }
        check_gradient(physics, scheme)?;
        const { assert!(size_of::<P>() >= size_of::<T>(), "positions are less precise than the rest") };
        // Built by functions that are not generic, so that the loops of all terms are compiled once,
        // with this crate, and not again in every program that uses it.
        let sph: Box<dyn Any> = if TypeId::of::<T>() == TypeId::of::<f64>() {
            Box::new(build_f64(start, fluid, physics, scheme)?)
        } else if TypeId::of::<P>() == TypeId::of::<f64>() {
            Box::new(build_mixed(start, fluid, physics, scheme)?)
        } else {
            Box::new(build_f32(start, fluid, physics, scheme)?)
        };
        Ok(*sph.downcast().expect("a real number is f32 or f64"))
    }
}

/// Refuses a correction of gradients that there are none of.
fn check_gradient(physics: &Physics, scheme: &Scheme) -> Result<(), SphError> {
    let has_gradients = scheme.density == Density::Continuity
        || scheme.edac.is_some()
        || scheme.pressure_form == PressureForm::Antisymmetric
        || physics.viscosity == Some(Viscosity::StrainRate);
    if scheme.gradient == Gradient::Corrected && !has_gradients {
        let choice = "gradient = corrected";
        let others = "density = continuity, edac, pressure_form = antisymmetric or a viscosity of \
                      strain rates";
        return Err(SphError::Choice { choice, others });
    }
    Ok(())
}

#[inline(never)]
fn build_f32(
    start: &Start,
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
) -> Result<Sph<f32>, SphError> {
    build_in_its_dimension(start, fluid, physics, scheme)
}

#[inline(never)]
fn build_f64(
    start: &Start,
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
) -> Result<Sph<f64>, SphError> {
    build_in_its_dimension(start, fluid, physics, scheme)
}

#[inline(never)]
fn build_mixed(
    start: &Start,
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
) -> Result<Sph<f32, f64>, SphError> {
    build_in_its_dimension(start, fluid, physics, scheme)
}

fn build_in_its_dimension<T: Real, P: Real>(
    start: &Start,
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
) -> Result<Sph<T, P>, SphError> {
    match start.region.lower.len() {
        1 => build::<T, P, 1>(start, fluid, physics, scheme, Dimension::One),
        2 => build::<T, P, 2>(start, fluid, physics, scheme, Dimension::Two),
        _ => build::<T, P, 3>(start, fluid, physics, scheme, Dimension::Three),
    }
}

/// What friction sees in bodies, beside their velocity.
fn velocity_in_bodies(physics: &Physics, scheme: &Scheme) -> Option<VelocityInBodies> {
    let has_friction = physics.viscosity.is_some() && physics.slip == Slip::No;
    if physics.bodies.is_empty() || !has_friction {
        return None;
    }
    match scheme.wall_velocity {
        WallVelocity::Mirrored => Some(VelocityInBodies::Mirrored),
        WallVelocity::Linear => {
            physics.bodies.iter().any(Body::slides).then_some(VelocityInBodies::Surface)
        }
    }
}

/// The pieces that bodies need.
fn pieces_of_bodies<T: Real, P: Real>(
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
    kernel: &Kernel<T>,
    mass: T,
    pressures: &[Quantity],
) -> Vec<Piece<T, P>> {
    let mut pieces = Vec::new();
    // Less than a particle of the fluid at the edge of the support.
    let least_kernel = T::of(1e-6) * kernel.w(T::zero());
    if velocity_in_bodies(physics, scheme) == Some(VelocityInBodies::Mirrored) {
        let slides = physics.bodies.iter().any(Body::slides);
        pieces.push(Piece::Term(MirroredVelocity { slides, least_kernel }.into()));
    }
    if !physics.bodies.is_empty() && scheme.wall_pressure == WallPressure::Extrapolated {
        let body_acceleration = physics.body_acceleration.map(T::of);
        let term = wall_pressure::WallPressure {
            mass,
            is_given_by_term: !pressures.contains(&Quantity::Pressure),
            body_acceleration,
            least_kernel,
        };
        pieces.extend([Piece::Term(term.into()), WallState::piece(fluid, mass, pressures)]);
    }
    pieces
}

/// The pieces that `physics` names; terms in the order in which they are added.
fn pieces<T: Real, P: Real>(
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
    kernel: &Kernel<T>,
    spacing: f64,
    mass: f64,
    dims: usize,
) -> Vec<Piece<T, P>> {
    let viscosity = physics.viscosity.map_or(0.0, |_| fluid.density * fluid.kinematic_viscosity);
    let (mass, dynamic_viscosity) = (T::of(mass), T::of(viscosity));
    let in_bodies = velocity_in_bodies(physics, scheme);
    let h = kernel.smoothing_length();
    let eta_squared = T::of(0.01) * h * h;
    let is_corrected = scheme.gradient == Gradient::Corrected;
    let mut terms: Vec<AnyTerm<T>> = vec![match scheme.density {
        Density::Continuity => Continuity { mass, is_corrected }.into(),
        Density::Summation => NumberDensity.into(),
    }];
    if scheme.transport > 0.0 {
        // With p_b = rho c^2 and tau = 0.25 h / c.
        let strength =
            T::of(0.25 * scheme.transport * fluid.sound_speed / fluid.density) * h * mass;
        terms.push(Drift { strength }.into());
        terms.push(DriftStress.into());
    }
    if let Some(edac) = scheme.edac {
        terms.push(
            PressureEvolution {
                mass,
                sound_speed_squared: T::of(fluid.sound_speed * fluid.sound_speed),
                diffusivity: T::of(edac.diffusion * fluid.sound_speed / 8.0) * h,
                drifts: scheme.transport > 0.0,
                is_corrected,
            }
            .into(),
        );
    }
    if physics.viscosity == Some(Viscosity::StrainRate)
        || (physics.energy && physics.viscosity.is_some())
    {
        terms.push(StrainRate { mass, dynamic_viscosity, in_bodies, is_corrected }.into());
    }
    terms.push(match scheme.pressure_form {
        PressureForm::Symmetric => PressureGradient { mass }.into(),
        PressureForm::DensityWeighted => WeightedPressureGradient { mass }.into(),
        PressureForm::Antisymmetric => PressureDifference { mass, is_corrected }.into(),
    });
    match physics.viscosity {
        Some(Viscosity::StrainRate) => terms.push(StressDivergence { mass }.into()),
        Some(Viscosity::Morris) => {
            let term = MorrisViscosity { mass, dynamic_viscosity, eta_squared, in_bodies };
            terms.push(term.into());
        }
        Some(Viscosity::Monaghan) => {
            let term = MonaghanViscosity { mass, dynamic_viscosity, eta_squared, in_bodies };
            terms.push(term.into());
        }
        Some(Viscosity::Adami) => {
            terms.push(WeightedViscosity { mass, dynamic_viscosity, in_bodies }.into());
        }
        None => {}
    }
    if physics.energy {
        terms.push(Energy { mass, dynamic_viscosity }.into());
    }
    terms.extend(scheme.stabilisation.terms(fluid, physics, kernel, spacing, mass));
    let mut pressures: Vec<_> = terms.iter().flat_map(|term| term.reads(0)).collect();
    pressures.retain(|p| matches!(p, Quantity::Pressure | Quantity::PressureTerm));
    let state_equation = Thermodynamics::piece(fluid, scheme, mass, &pressures);
    let of_bodies = pieces_of_bodies(fluid, physics, scheme, kernel, mass, &pressures);
    let correction = Correction::pieces(dims, &terms);
    let pieces = terms.into_iter().map(Piece::Term).chain(correction);
    pieces.chain([state_equation]).chain(of_bodies).collect()
}

fn build<T: Real, P: Real, const D: usize>(
    start: &Start,
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
    dimension: Dimension,
) -> Result<Sph<T, P>, SphError> {
    let smoothing_length = scheme.smoothing_ratio * start.spacing;
    let particle_mass = fluid.density * start.particle_volume;
    let (kernels, pieces) = match (scheme.smoothing, fluid.state_equation) {
        (Smoothing::Adaptive { longest }, StateEquation::IdealGas { heat_ratio }) => {
            let kernel = AdaptiveKernel::<T, D>::new(scheme.kernel, T::of(longest));
            let (mass, ratio) = (T::of(particle_mass), T::of(scheme.smoothing_ratio));
            let heat_ratio = T::of(heat_ratio);
            let pieces = gas::pieces(kernel, mass, ratio, heat_ratio, physics.shock_capturing);
            (Kernels::Adaptive(kernel), pieces)
        }
        _ => {
            let kernel = Kernel::new(scheme.kernel, dimension, T::of(smoothing_length));
            let pieces = pieces(fluid, physics, scheme, &kernel, start.spacing, particle_mass, D);
            (Kernels::Uniform(kernel), pieces)
        }
    };
    let range = kernels.range().as_f64();
    let walls = Walls::new(&physics.bodies, &start.region, range);

    let mut columns = Columns::new(start.positions.len());
    let has_bodies = !physics.bodies.is_empty();
    let uses: Vec<_> = pieces.iter().flat_map(|p| [p.reads(D), p.writes(D)].concat()).collect();
    let fields = Fields::<T, P>::declare(&mut columns, D, has_bodies, &uses);
    start.fill(&mut columns, &fields, fluid, &walls);
    let options = CellsOptions {
        region: start.region.clone(),
        range,
        skin: scheme.skin * start.spacing,
        block_points: 64,
    };
    let domain = Cells::new(&mut columns, &fields.position, options)?;
    start_check::check_periods(start, range)?;
    start_check::check_overlap(start)?;
    start_check::check_bodies(start, &walls, range)?;

    let friction = match (physics.slip, scheme.wall_velocity) {
        (Slip::Free, _) => Friction::None,
        (Slip::No, WallVelocity::Linear) if has_bodies => Friction::Linear(NoSlip {
            walls,
            most: T::of(scheme.beta_max - 1.0),
            least_distance: T::of(1e-3 * start.spacing),
        }),
        _ => Friction::AsGiven,
    };
    let body_acceleration = std::array::from_fn(|a| T::of(physics.body_acceleration[a]));
    let mut evaluation = Vec::new();
    for slot in slots(pieces, D) {
        let mut terms = Vec::new();
        for piece in slot {
            match piece {
                Piece::Term(term) => terms.push(term),
                Piece::Update(update) => evaluation.push((update.stage)(&fields)),
                Piece::Alone(alone) => evaluation.push((alone.stage)(&fields)),
            }
        }
        if !terms.is_empty() {
            evaluation.push(Stage::rate(Sweep::<T, P, D>::new(
                kernels,
                terms,
                &fields,
                body_acceleration,
                physics.acceleration_field.as_ref(),
                scheme.wall_pressure == WallPressure::Evolved,
                &friction,
            )));
        }
    }

    // The time step follows from the last accelerations and signals: they must survive a restart.
    for &rate in fields.acceleration.iter().chain(&fields.signal_speed) {
        columns.keep(rate.id());
    }
    let mut evolution = Evolution::new();
    if let Some(rate) = fields.density_rate {
        evolution = evolution.with(fields.density, rate);
    }
    if let (Some(pressure), Some(rate)) = (fields.pressure, fields.pressure_rate) {
        evolution = evolution.with(pressure, rate);
    }
    for a in 0..D {
        evolution = evolution
            .with_motion(fields.position[a], fields.velocity[a])
            .with(fields.velocity[a], fields.acceleration[a]);
        if let Some(&drift) = fields.drift.get(a) {
            columns.keep(drift.id());
            evolution = evolution.with_drift(fields.position[a], drift);
        }
    }
    if let (Some(energy), Some(rate)) = (fields.energy, fields.energy_rate) {
        evolution = evolution.with(energy, rate);
    }
    let plan = scheme.integrator.plan(&mut columns, &evolution, &evaluation);
    let magnitude = physics.body_acceleration.iter().map(|a| a * a).sum::<f64>().sqrt();
    let pacing: Box<dyn Pacing<Cells<P>>> = if scheme.smoothing.is_adaptive() {
        let approach = physics.shock_capturing.map_or(0.0, |shocks| shocks.approach);
        Box::new(GasPacing::new(&fields, fluid, scheme, particle_mass, approach, magnitude))
    } else {
        Box::new(TimeStepControl {
            fields: fields.clone(),
            smoothing_length,
            sound_speed: fluid.sound_speed,
            diffusivity: diffusivity(fluid, physics, scheme, smoothing_length, D),
            body_acceleration: magnitude,
            courant_number: scheme.courant_number,
            transport: scheme.transport,
            most_steps: 20,
        })
    };
    let model = Model {
        method: "sph".to_owned(),
        domain,
        columns,
        plan,
        whole: vec![Box::new(InitialState { fields: fields.clone() }), Box::new(Sort)],
        pacing,
    };
    Ok(Sph { model, fields, particle_mass })
}

/// The largest diffusivity, of momentum or pressure, m^2/s.
fn diffusivity(
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
    smoothing_length: f64,
    dims: usize,
) -> f64 {
    let of_momentum = physics.viscosity.map_or(0.0, |form| {
        let nu = fluid.kinematic_viscosity;
        match form {
            // What neighbours in all directions take off a particle's velocity is (d + 2) / d times
            // that of the form of Morris, for which the limit of the time step was made.
            Viscosity::Monaghan => nu * (dims as f64 + 2.0) / dims as f64,
            _ => nu,
        }
    });
    let of_pressure =
        scheme.edac.map_or(0.0, |edac| edac.diffusion * fluid.sound_speed * smoothing_length / 8.0);
    of_momentum.max(of_pressure)
}
