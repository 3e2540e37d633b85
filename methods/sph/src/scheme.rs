//! How a scene is discretised.

use finegrain_framework::Integrator;

use crate::body::{WallPressure, WallVelocity};
use crate::error::{SphError, not_negative, positive};
use crate::kernel::SmoothingFunction;
use crate::pairs::Pairs;
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
    /// Whether sweeps share their lists of neighbours.
    pub pairs: Pairs,
    /// Where density comes from.
    pub density: Density,
    /// Pressure evolves by itself, with diffusion; by the equation of state if `None`.
    pub edac: Option<Edac>,
    /// How the pressure of two particles makes a force.
    pub pressure_form: PressureForm,
    /// The gradient of the kernel in differences: in velocity gradients, and in the antisymmetric
    /// form of the pressure gradient.
    pub gradient: Gradient,
    /// Drift of the particles towards an even distribution, in units of that of Adami, Hu & Adams
    /// (2013) with a background pressure of `rho c^2` and a time step of `0.25 h / c`; none if 0.
    /// Goes only with density as a sum.
    pub transport: f64,
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
            pairs: Pairs::Searched,
            density: Density::Continuity,
            edac: None,
            pressure_form: PressureForm::Symmetric,
            gradient: Gradient::Kernel,
            transport: 0.0,
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
        if let Some(edac) = self.edac {
            not_negative("edac.diffusion", edac.diffusion)?;
            if self.pressure_form == PressureForm::Symmetric {
                let (choice, others) =
                    ("edac", "pressure_form = density-weighted or antisymmetric");
                return Err(SphError::Choice { choice, others });
            }
        }
        not_negative("transport", self.transport)?;
        if self.transport > 0.0 && self.density == Density::Continuity {
            // The equation of continuity has no w . grad rho: density would stay behind where
            // particles drift to.
            let (choice, others) = ("transport above 0", "density = summation");
            return Err(SphError::Choice { choice, others });
        }
        if self.stabilisation.tensile_control && self.pressure_form != PressureForm::Symmetric {
            let (choice, others) = ("tensile control", "pressure_form = symmetric");
            return Err(SphError::Choice { choice, others });
        }
        self.stabilisation.check()
    }
}

/// Where density comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Density {
    /// It evolves by the equation of continuity (Holmes et al. 2011, eq. I.1).
    #[default]
    Continuity,
    /// It is a sum over the particles around: mass times number density.
    Summation,
}

/// Entropically damped artificial compressibility (Ramachandran & Puri 2019).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edac {
    /// Diffusivity of the pressure in units of `h c / 8`; theirs is 0.5.
    pub diffusion: f64,
}

/// How the pressure of two particles makes a force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PressureForm {
    /// `p_i / rho_i^2 + p_j / rho_j^2` (Holmes et al. 2011, eq. I.2).
    #[default]
    Symmetric,
    /// `(rho_j p_i + rho_i p_j) / (rho_i + rho_j) (V_i^2 + V_j^2) / m^2` (Adami, Hu & Adams 2012,
    /// eq. 6).
    DensityWeighted,
    /// `p_j - p_i`: exactly nothing where the pressure is constant, but momentum is not conserved.
    Antisymmetric,
}

/// The gradient of the kernel in differences.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gradient {
    /// As it is.
    #[default]
    Kernel,
    /// Times the inverse of the moment matrix of the neighbours (Bonet & Lok 1999): gradients of
    /// linear fields are exact, however particles lie, beside free surfaces, too. One more sweep
    /// over the neighbours.
    Corrected,
}
