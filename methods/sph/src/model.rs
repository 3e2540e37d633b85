//! Builds an SPH model from particles, a fluid and a choice of physics.

use std::any::{Any, TypeId};
use std::sync::Arc;

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::CellsOptions;
use finegrain_framework::{Columns, Evolution, Handle, Model, Pacing, Real, Stage};

use crate::body::{Slip, WallPressure, WallVelocity};
use crate::dimension::Dimension;
use crate::error::SphError;
use crate::evaluation::{Piece, slots};
use crate::fields::Fields;
use crate::gas;
use crate::gas_pacing::GasPacing;
use crate::imposed::Imposed;
use crate::initial_state::InitialState;
use crate::kernel::Kernel;
use crate::kernel::adaptive::{AdaptiveKernel, Kernels};
use crate::liquid;
use crate::pacing::{Sort, TimeStepControl};
use crate::pairs::{Keeping, Pairs};
use crate::physics::{Fluid, Physics, Viscosity};
use crate::quantity::Quantity;
use crate::scheme::{Density, Gradient, PressureForm, Scheme};
use crate::smoothing::Smoothing;
use crate::start::Start;
use crate::start_check;
use crate::state_equation::StateEquation;
use crate::sweep::Sweep;
use crate::wall::{Friction, NoSlip, Walls};

/// Particles of a sub-domain: what it sees around is gathered once, which is worth more the more of them
/// share it, and must stay in a core's second cache.
const BLOCK_POINTS: usize = 256;

/// A model and the handles of its fields.
///
/// Positions may be more precise than the rest: `Sph<f32, f64>`, mixed precision, keeps positions and
/// their motion in `f64`, and computes what particles do to each other in `f32` from positions
/// relative to the sub-domain that they are in.
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
        if physics.forces_on_bodies {
            check_forces_on_bodies(physics, scheme)?;
        }
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

/// Refuses schemes in which bodies do not feel what they do to the fluid.
fn check_forces_on_bodies(physics: &Physics, scheme: &Scheme) -> Result<(), SphError> {
    let choice = "physics.forces_on_bodies";
    let has_friction = physics.viscosity.is_some() && physics.slip == Slip::No;
    if has_friction && scheme.wall_velocity == WallVelocity::Linear {
        let others = "scheme.wall_velocity = Fitted or Mirrored";
        return Err(SphError::Choice { choice, others });
    }
    if scheme.stabilisation.repulsion.is_some() {
        return Err(SphError::Choice { choice, others: "no repulsion" });
    }
    if scheme.pressure_form == PressureForm::Antisymmetric {
        let others = "scheme.pressure_form = Symmetric or DensityWeighted";
        return Err(SphError::Choice { choice, others });
    }
    Ok(())
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
    let longest = match scheme.smoothing {
        Smoothing::Uniform => smoothing_length,
        Smoothing::Adaptive { longest } => longest,
    };
    let sight = scheme.kernel.support() * longest;
    let walls = Arc::new(Walls::new(&physics.bodies, &start.region, sight));
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
            let pieces = liquid::pieces(start, fluid, physics, scheme, &kernel, &walls);
            (Kernels::Uniform(kernel), pieces)
        }
    };

    let range = kernels.range().as_f64();
    let mut columns = Columns::new(start.positions.len());
    let has_bodies = !physics.bodies.is_empty();
    let mut uses: Vec<_> = pieces.iter().flat_map(|p| [p.reads(D), p.writes(D)].concat()).collect();
    if physics.forces_on_bodies {
        uses.extend(Quantity::vector(Quantity::Reaction, D));
    }
    let fields = Fields::<T, P>::declare(&mut columns, D, has_bodies, &uses);
    start.fill(&mut columns, &fields, fluid, &walls);
    let options = CellsOptions {
        region: start.region.clone(),
        range,
        skin: scheme.skin * start.spacing,
        block_points: BLOCK_POINTS,
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
    let imposed = Imposed::new(physics);
    let mut evaluation = Vec::new();
    let slots = slots(pieces, D);
    let sums_over_fluid = |slot: &[Piece<T, P>]| slot.iter().any(Piece::acts_on_fluid);
    let sweeps_of_fluid = slots.iter().filter(|slot| sums_over_fluid(slot)).count();
    let has_one_range = matches!(kernels, Kernels::Uniform(_));
    let mut keeping = Keeping::Nothing;
    if scheme.pairs == Pairs::Kept && has_one_range && sweeps_of_fluid > 1 {
        keeping = Keeping::Writes(columns.notes());
    }
    for slot in slots {
        let own_keeping = if sums_over_fluid(&slot) { keeping } else { Keeping::Nothing };
        let mut terms = Vec::new();
        for piece in slot {
            match piece {
                Piece::Term(term) => terms.push(term),
                Piece::Update(update) => evaluation.push((update.stage)(&fields)),
                Piece::Alone(alone) => evaluation.push((alone.stage)(&fields)),
            }
        }
        if !terms.is_empty() {
            let bodies_evolve = scheme.wall_pressure == WallPressure::Evolved;
            let sweep =
                Sweep::<T, P, D>::new(kernels, terms, &fields, &imposed, bodies_evolve, &friction);
            evaluation.push(Stage::rate(sweep.keeping(own_keeping)));
        }
        if !matches!(own_keeping, Keeping::Nothing) {
            keeping = keeping.next();
        }
    }

    // The time step follows from the last accelerations and signals: they must survive a restart.
    for &rate in fields.acceleration.iter().chain(&fields.reaction).chain(&fields.signal_speed) {
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
            damping_rate: physics.fringe.as_ref().map_or(0.0, |fringe| fringe.rate),
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
