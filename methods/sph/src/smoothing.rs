//! How long the smoothing length is.

use crate::error::{SphError, positive};

/// How long the smoothing length is, and with it how many neighbours a particle has.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Smoothing {
    /// The same for all particles: [`Scheme::smoothing_ratio`](crate::Scheme::smoothing_ratio)
    /// times the spacing at the start. For fluids of nearly uniform density.
    #[default]
    Uniform,
    /// Follows the density, `h = eta (m / rho)^(1/d)` with the smoothing ratio as `eta`, so that
    /// the number of neighbours stays about the same; density is the sum
    /// `rho_i = m sum_j W(r_ij, h_i)` (Springel & Hernquist 2002; Price 2012). For gas.
    Adaptive {
        /// Longest smoothing length, m: neighbours are searched for as far as it reaches. A
        /// particle that would need a longer one ends the run.
        longest: f64,
    },
}

impl Smoothing {
    pub(crate) fn check(self) -> Result<(), SphError> {
        match self {
            Self::Uniform => Ok(()),
            Self::Adaptive { longest } => positive("longest smoothing length", longest),
        }
    }

    /// Whether it follows the density.
    pub fn is_adaptive(self) -> bool {
        self != Self::Uniform
    }
}
