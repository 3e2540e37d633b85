//! Terms: one piece of physics each, composed by a scene.
//!
//! A term is a sum over the neighbours of a particle. It reads gathered lanes and returns its
//! contribution; the files read like their equations.

pub(crate) mod continuity;
pub(crate) mod energy;
pub(crate) mod momentum;
pub(crate) mod strain_rate;
pub(crate) mod viscosity;

use finegrain_framework::Real;
use serde::{Deserialize, Serialize};

use crate::neighbourhood::Quantity;

/// Viscous term of the momentum equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Viscosity {
    /// Strain-rate form of Holmes et al. (2011), eq. I.2: two rate stages, one for the
    /// strain-rate tensor of every particle and one for its divergence.
    StrainRate,
    /// Morris, Fox & Zhu (1997), eq. 22: one rate stage, second derivative by difference of a
    /// first derivative.
    Morris,
}

/// One term of a model, with its constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Term<T> {
    /// Conservation of mass, eq. I.1.
    Continuity,
    /// Strain-rate tensor, for the strain-rate forms of viscosity and heating.
    StrainRate(strain_rate::StrainRate<T>),
    /// Pressure gradient of eq. I.2.
    PressureGradient,
    /// Divergence of the viscous stress of eq. I.2.
    StressDivergence,
    /// Viscosity of Morris et al.
    MorrisViscosity(viscosity::Morris<T>),
    /// Conservation of energy, eq. I.3.
    Energy(energy::Energy<T>),
}

impl<T: Real> Term<T> {
    /// The quantities of neighbours that it reads.
    pub fn reads(&self, dims: usize) -> Vec<Quantity> {
        let velocity = (0..dims).map(Quantity::Velocity);
        let stress = (0..crate::fields::symmetric(dims)).map(Quantity::StressTerm);
        match self {
            Self::Continuity => velocity.collect(),
            Self::StrainRate(_) | Self::MorrisViscosity(_) => {
                velocity.chain([Quantity::Volume, Quantity::WallDepth]).collect()
            }
            Self::PressureGradient => vec![Quantity::PressureTerm],
            Self::StressDivergence => stress.chain([Quantity::WallDepth]).collect(),
            Self::Energy(energy) => {
                let own = if energy.is_viscous() { stress.collect() } else { Vec::new() };
                let others = [Quantity::Volume, Quantity::PressureTerm];
                velocity.chain(own).chain(others).collect()
            }
        }
    }

    /// Whether it needs what another term's rate stage computes for the neighbours.
    pub fn is_second(&self) -> bool {
        matches!(self, Self::StressDivergence | Self::Energy(_))
    }
}

/// Lanes that a term works with: a weight for each neighbour.
#[derive(Clone, Debug, Default)]
pub(crate) struct Work<T>([Vec<T>; 2]);

impl<T: Real> Work<T> {
    /// Two work lanes of `length` neighbours, holding whatever they held.
    #[inline(always)]
    pub fn lanes(&mut self, length: usize) -> [&mut [T]; 2] {
        let [first, second] = &mut self.0;
        if first.len() < length {
            first.resize(length, T::zero());
            second.resize(length, T::zero());
        }
        [&mut first[..length], &mut second[..length]]
    }
}
