//! Collisions: how populations relax towards equilibrium.

mod central;
mod cumulant;
mod mrt;
mod regularised;
mod trt;

pub(crate) use central::Central;
pub(crate) use cumulant::Cumulant;
pub(crate) use mrt::Mrt;
pub(crate) use regularised::Regularised;
pub(crate) use trt::Trt;

use finegrain_framework::pack::Pack;
use serde::{Deserialize, Serialize};

use crate::error::{LbmError, positive};
use crate::lattice::Lattice;

/// Choice of a collision.
///
/// Central moments are the default because they survive where others do not (`docs/scenes.md` has the map)
/// and are as accurate where all do; in slow flow along walls two relaxation times are better.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Collision {
    /// One relaxation time (Bhatnagar, Gross & Krook 1954; Qian et al. 1992).
    Bgk,
    /// Two relaxation times (Ginzburg, Verhaeghe & d'Humieres 2008).
    Trt {
        /// `(tau_even - 1/2) (tau_odd - 1/2)`, above zero: with 3/16 half-way walls along the lattice
        /// are where they should be, with 1/4 it is most stable.
        magic: f64,
    },
    /// Multiple relaxation times of natural moments (Lallemand & Luo 2000; d'Humieres et al. 2002): as
    /// two relaxation times, but the bulk viscosity and even moments beyond the stress relax at once.
    Mrt {
        /// As for two relaxation times.
        magic: f64,
    },
    /// Central moments (Geier et al. 2006; De Rosis 2016, 2017): all moments but the stress are set to
    /// their equilibrium as seen from the fluid.
    #[default]
    CentralMoments,
    /// Cumulants (Geier et al. 2015), all but those of the stress set to their equilibrium.
    Cumulant,
    /// Recursive regularisation (Malaspinas 2015): what is beyond the stress is not relaxed but
    /// computed anew.
    Regularised,
}

impl Collision {
    pub(crate) fn check(&self) -> Result<(), LbmError> {
        match *self {
            Self::Trt { magic } | Self::Mrt { magic } => positive("magic", magic),
            Self::Bgk | Self::CentralMoments | Self::Cumulant | Self::Regularised => Ok(()),
        }
    }
}

/// A collision, in lattice units.
pub(crate) trait Collide<T>: Copy + Send + Sync + 'static {
    /// The populations after the collision, from those before it, the acceleration by the body
    /// force and the relaxation rate of the stress.
    fn collide<L: Lattice<Q>, V: Pack<Scalar = T>, const Q: usize>(
        &self,
        f: [V; Q],
        acceleration: [V; 3],
        omega: V,
    ) -> [V; Q];
}

#[cfg(test)]
mod tests;
