//! What takes noise out of the flow and keeps particles regular, each a choice that costs nothing
//! where it is not made.

use finegrain_framework::Real;

use crate::error::{SphError, not_negative, positive};
use crate::kernel::Kernel;
use crate::physics::{Fluid, Physics};
use crate::term::artificial_pressure::ArtificialPressure;
use crate::term::repulsion::Repulsion;
use crate::term::shifting::Shifting;
use crate::term::tensile_control::TensileControl;
use crate::term::{AnyTerm, artificial_viscosity, density_diffusion};

/// Particles whose moment matrix has a smaller eigenvalue than this are of the free surface (Sun,
/// Colagrossi, Marrone & Zhang 2017, section 2.3).
const LEAST_FULLNESS: f64 = 0.75;

/// What takes out noise and keeps particles regular; nothing by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stabilisation {
    /// Artificial viscosity.
    pub artificial_viscosity: Option<ArtificialViscosity>,
    /// Diffusion of density.
    pub density_diffusion: Option<DensityDiffusion>,
    /// Strength `epsilon` of the artificial pressure of Monaghan (2000) where the fluid is under
    /// tension, about 0.2.
    pub artificial_pressure: Option<f64>,
    /// Whether the pressure gradient of particles under tension inside of the fluid is made of
    /// differences (tensile instability control, Sun et al. 2018).
    pub tensile_control: bool,
    /// Largest speed of the flow, m/s, about, for the shifting of particles (Sun et al. 2017).
    pub shifting: Option<f64>,
    /// Strength of the repulsion by the particles of bodies, m^2/s^2 (Monaghan 1994), about the
    /// square of the largest speed: it keeps apart what is nearer than a spacing.
    pub repulsion: Option<f64>,
}

/// Artificial viscosity of Monaghan (1992), between particles of the fluid that approach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArtificialViscosity {
    /// `alpha`: acts like a kinematic viscosity of about `alpha h c / (2 d + 4)` in `d` dimensions.
    pub alpha: f64,
    /// `beta`, against penetration in shocks.
    pub beta: f64,
}

/// Diffusion of density `delta h c sum_j V_j psi_ij . grad W_ij`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DensityDiffusion {
    /// What is diffused.
    pub form: DiffusionForm,
    /// `delta`, about 0.1.
    pub delta: f64,
}

/// What density diffusion smooths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiffusionForm {
    /// The density itself (Molteni & Colagrossi 2009): wrong where a free surface cuts off a
    /// gradient.
    MolteniColagrossi,
    /// What differs from a linear field (Antuono, Colagrossi, Marrone & Molteni 2010): the
    /// delta-SPH scheme; one more sweep over the neighbours.
    Antuono,
    /// What differs from hydrostatic equilibrium under the constant body acceleration (Fourtakas,
    /// Dominguez, Vacondio & Rogers 2019).
    Fourtakas,
}

impl Stabilisation {
    /// Nothing.
    pub const NONE: Self = Self {
        artificial_viscosity: None,
        density_diffusion: None,
        artificial_pressure: None,
        tensile_control: false,
        shifting: None,
        repulsion: None,
    };

    pub(crate) fn check(&self) -> Result<(), SphError> {
        if let Some(ArtificialViscosity { alpha, beta }) = self.artificial_viscosity {
            not_negative("artificial viscosity alpha", alpha)?;
            not_negative("artificial viscosity beta", beta)?;
        }
        if let Some(DensityDiffusion { delta, .. }) = self.density_diffusion {
            not_negative("density diffusion delta", delta)?;
        }
        if let Some(strength) = self.artificial_pressure {
            not_negative("artificial pressure", strength)?;
        }
        if let Some(speed) = self.shifting {
            positive("speed of shifting", speed)?;
        }
        if let Some(strength) = self.repulsion {
            not_negative("repulsion", strength)?;
        }
        Ok(())
    }

    /// The terms that it adds.
    pub(crate) fn terms<T: Real>(
        &self,
        fluid: &Fluid,
        physics: &Physics,
        kernel: &Kernel<T>,
        spacing: f64,
        mass: T,
    ) -> Vec<AnyTerm<T>> {
        let h = kernel.smoothing_length();
        let sound_speed = T::of(fluid.sound_speed);
        let inverse_kernel = T::one() / kernel.w(T::of(spacing) / h);
        let least_fullness = T::of(LEAST_FULLNESS);
        let mut terms = Vec::new();
        if let Some(DensityDiffusion { form, delta }) = self.density_diffusion {
            let at_rest = match form {
                DiffusionForm::Fourtakas => physics
                    .body_acceleration
                    .map(|g| T::of(fluid.density * g / fluid.sound_speed.powi(2))),
                _ => [T::zero(); 3],
            };
            let term = density_diffusion::DensityDiffusion {
                diffusivity: T::of(delta) * h * sound_speed,
                knows_gradient: form == DiffusionForm::Antuono,
                at_rest,
            };
            terms.push(term.into());
        }
        if let Some(ArtificialViscosity { alpha, beta }) = self.artificial_viscosity {
            let term = artificial_viscosity::ArtificialViscosity {
                mass,
                linear: T::of(alpha) * sound_speed,
                quadratic: T::of(beta),
                smoothing_length: h,
            };
            terms.push(term.into());
        }
        if let Some(strength) = self.artificial_pressure {
            terms.push(
                ArtificialPressure { mass, strength: T::of(strength), inverse_kernel }.into(),
            );
        }
        if self.tensile_control {
            terms.push(TensileControl { mass, least_fullness }.into());
        }
        if let Some(speed) = self.shifting {
            let support_radius = kernel.support_radius();
            let term =
                Shifting { speed: T::of(speed), support_radius, inverse_kernel, least_fullness };
            terms.push(term.into());
        }
        if let Some(strength) = self.repulsion {
            terms.push(Repulsion { strength: T::of(strength), spacing: T::of(spacing) }.into());
        }
        terms
    }
}
