//! Equations: one file each, that reads as the equation does on paper.
//!
//! An equation says what the rate of change of its unknowns is, in terms of [`At`]: fields around a
//! pack of points and their derivatives. It knows nothing of rows, boundaries, threads or time steps.

pub(crate) mod advection;
pub(crate) mod burgers;
pub(crate) mod drift;
pub(crate) mod gas;
pub(crate) mod heat;
pub mod wave;

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

pub use advection::Advection;
pub use burgers::Burgers;
pub use drift::Drift;
pub use gas::{Gas, GasEnd, GasState};
pub use heat::Heat;
pub use wave::Wave;

use crate::around::At;

/// The rate of change of `F` unknowns, with `G` fields given.
///
/// Of given fields an equation may read neighbours only where axes are periodic or have ghost points.
pub trait Equation<T: Real, const F: usize, const G: usize>: Send + Sync + 'static {
    /// Whether these are second derivatives in time: equations of first order are not compiled for steps that need
    /// the state before.
    const SECOND_ORDER: bool = false;
    /// Whether a point takes so few operations that asking for the number of axes would show: it is compiled for two
    /// and for three of them besides.
    const IS_LIGHT: bool = true;

    /// Name for messages and traces.
    fn name(&self) -> &'static str;

    /// The rate of change at a pack of points.
    fn rate<V: Pack<Scalar = T>, const R: usize, const K: usize>(
        &self,
        u: [At<'_, V, R, K>; F],
        given: [At<'_, V, R, K>; G],
        dt: T,
    ) -> [V; F];
}
