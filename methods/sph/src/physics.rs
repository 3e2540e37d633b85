//! What a scene models.

use finegrain_framework::VectorField;

use crate::body::{Body, Slip};
use crate::error::{SphError, finite, not_negative, positive};
use crate::fringe::Fringe;
use crate::gas::ShockCapturing;
use crate::state_equation::StateEquation;

/// A weakly compressible fluid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluid {
    /// Reference density, kg/m^3.
    pub density: f64,
    /// Numerical sound speed, m/s: some ten times the largest speed. An ideal gas has its own, by its
    /// energy.
    pub sound_speed: f64,
    /// Kinematic viscosity, m^2/s.
    pub kinematic_viscosity: f64,
    /// Pressure from density.
    pub state_equation: StateEquation,
}

impl Fluid {
    pub(crate) fn check(&self) -> Result<(), SphError> {
        positive("density", self.density)?;
        positive("sound_speed", self.sound_speed)?;
        not_negative("kinematic_viscosity", self.kinematic_viscosity)
    }
}

/// What is modelled besides mass and pressure; what is not named here costs nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Physics {
    /// Viscous term, if any.
    pub viscosity: Option<Viscosity>,
    /// Energy equation.
    pub energy: bool,
    /// What an ideal gas needs where there are shocks.
    pub shock_capturing: Option<ShockCapturing>,
    /// Constant acceleration of the fluid, m/s^2; zero if none.
    pub body_acceleration: [f64; 3],
    /// Acceleration of the fluid that varies, besides.
    pub acceleration_field: Option<VectorField>,
    /// Where the fluid is brought to a velocity, if anywhere.
    pub fringe: Option<Fringe>,
    /// Bodies, filled with particles that do not move.
    pub bodies: Vec<Body>,
    /// Whether the fluid sticks to them.
    pub slip: Slip,
    /// Whether the forces of the fluid on bodies are wanted, see
    /// [`measure::force_on_body`](crate::measure::force_on_body).
    pub forces_on_bodies: bool,
}

impl Physics {
    pub(crate) fn check(&self) -> Result<(), SphError> {
        for acceleration in self.body_acceleration {
            finite("body_acceleration", acceleration)?;
        }
        if let Some(fringe) = &self.fringe {
            fringe.check()?;
        }
        for (number, body) in self.bodies.iter().enumerate() {
            body.check().map_err(|cause| SphError::Body { number, cause })?;
        }
        Ok(())
    }
}

/// Viscous term of the momentum equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Viscosity {
    /// Strain-rate form of Holmes et al. (2011), eq. I.2: two rate stages, one for the
    /// strain-rate tensor of every particle and one for its divergence.
    StrainRate,
    /// Morris, Fox & Zhu (1997), eq. 22: one rate stage, second derivative by difference of a
    /// first derivative.
    Morris,
    /// Adami, Hu & Adams (2012), eq. 9: as Morris, weighted with the squares of the volumes, as the
    /// density-weighted pressure gradient is.
    Adami,
    /// Cleary & Monaghan (1999), Monaghan (2005): along the line between two particles, which
    /// conserves angular momentum, too.
    Monaghan,
}
