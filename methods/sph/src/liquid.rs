//! What a liquid is composed of: the terms and updates that physics and scheme name.

use std::sync::Arc;

use finegrain_framework::Real;

use crate::body::{Body, Slip, WallPressure, WallVelocity};
use crate::correction::Correction;
use crate::evaluation::Piece;
use crate::kernel::Kernel;
use crate::physics::{Fluid, Physics, Viscosity};
use crate::quantity::Quantity;
use crate::scheme::{Density, Gradient, PressureForm, Scheme};
use crate::start::Start;
use crate::state_equation::Thermodynamics;
use crate::surface_distance::SurfaceDistance;
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
use crate::term::wall_velocity::{FittedVelocity, MirroredVelocity};
use crate::term::weighted::{WeightedPressureGradient, WeightedViscosity};
use crate::term::{AnyTerm, Term};
use crate::wall::{VelocityInBodies, Walls};
use crate::wall_state::WallState;

/// What friction sees in bodies, beside their velocity.
fn velocity_in_bodies(physics: &Physics, scheme: &Scheme) -> Option<VelocityInBodies> {
    let has_friction = physics.viscosity.is_some() && physics.slip == Slip::No;
    if physics.bodies.is_empty() || !has_friction {
        return None;
    }
    match scheme.wall_velocity {
        WallVelocity::Mirrored | WallVelocity::Fitted => Some(VelocityInBodies::Mirrored),
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
    walls: &Arc<Walls>,
    mass: T,
    pressures: &[Quantity],
) -> Vec<Piece<T, P>> {
    let mut pieces = Vec::new();
    // Less than a particle of the fluid at the edge of the support.
    let least_kernel = T::of(1e-6) * kernel.w(T::zero());
    if velocity_in_bodies(physics, scheme) == Some(VelocityInBodies::Mirrored) {
        let slides = physics.bodies.iter().any(Body::slides);
        if scheme.wall_velocity == WallVelocity::Fitted {
            let h = kernel.smoothing_length();
            let least_squares = least_kernel * h * h;
            pieces.push(SurfaceDistance::piece(walls));
            pieces.push(Piece::Term(FittedVelocity { slides, least_squares }.into()));
        } else {
            pieces.push(Piece::Term(MirroredVelocity { slides, least_kernel }.into()));
        }
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

/// The pieces that `physics` and `scheme` name for a liquid; terms in the order in which they are added.
pub(crate) fn pieces<T: Real, P: Real>(
    start: &Start,
    fluid: &Fluid,
    physics: &Physics,
    scheme: &Scheme,
    kernel: &Kernel<T>,
    walls: &Arc<Walls>,
) -> Vec<Piece<T, P>> {
    let mass = fluid.density * start.particle_volume;
    let (spacing, dims) = (start.spacing, start.region.lower.len());
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
    let of_bodies = pieces_of_bodies(fluid, physics, scheme, kernel, walls, mass, &pressures);
    let correction = Correction::pieces(dims, &terms);
    let pieces = terms.into_iter().map(Piece::Term).chain(correction);
    pieces.chain([state_equation]).chain(of_bodies).collect()
}
