//! How a scene is discretised.

use finegrain_framework::Integrator;

use crate::body::{WallPressure, WallVelocity};
use crate::error::{SphError, positive};
use crate::kernel::SmoothingFunction;
use crate::smoothing::Smoothing;
use crate::stabilisation::Stabilisation;

/// How it is discretised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Smoothing kernel.
    pub kernel: SmoothingFunction,
    /// Smoothing length in units of the particle spacing.
    pub smoothing_ratio: f64,
    /// How long the smoothing length is.
    pub smoothing: Smoothing,
    /// How time is stepped.
    pub integrator: Integrator,
    /// Fraction of the stability limits that is used as time step.
    pub courant_number: f64,
    /// How much further than the support cells see, in particle spacings.
    pub skin: f64,
    /// Where the pressure in bodies comes from.
    pub wall_pressure: WallPressure,
    /// Which velocity friction sees in bodies.
    pub wall_velocity: WallVelocity,
    /// Largest linear extrapolation of the velocity into bodies, `beta_max` of Morris et al.
    /// (1997).
    pub beta_max: f64,
    /// What takes out noise and keeps particles regular.
    pub stabilisation: Stabilisation,
}

impl Default for Scheme {
    /// The paper's: Gaussian with h equal to the spacing, leapfrog.
    fn default() -> Self {
        Self {
            kernel: SmoothingFunction::Gaussian,
            smoothing_ratio: 1.0,
            smoothing: Smoothing::Uniform,
            integrator: Integrator::Leapfrog,
            courant_number: 1.0,
            skin: 0.2,
            wall_pressure: WallPressure::Evolved,
            wall_velocity: WallVelocity::Linear,
            beta_max: 1.5,
            stabilisation: Stabilisation::default(),
        }
    }
}

impl Scheme {
    pub(crate) fn check(&self) -> Result<(), SphError> {
        positive("smoothing_ratio", self.smoothing_ratio)?;
        self.smoothing.check()?;
        positive("courant_number", self.courant_number)?;
        positive("skin", self.skin)?;
        positive("beta_max", self.beta_max)?;
        self.stabilisation.check()
    }
}
