//! The two parts of a step, as traits: a stage that reads neighbours and writes its own
//! rates, and a stage that reads its own rates and writes its own state.

use crate::columns::ColumnId;
use crate::domain::Domain;
use crate::view::{Near, Own, Rates};

/// When a stage runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Number of the step, counted from 0.
    pub step: u64,
    /// Time at the beginning of the step.
    pub time: f64,
    /// Length of the step.
    pub dt: f64,
    /// The stage's own time, `time + c_i dt`: what a boundary value or force that depends on
    /// time must be evaluated at inside a Runge-Kutta step.
    pub stage_time: f64,
}

/// Why a stage cannot go on; the run ends with it as the cause.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Fault(String);

impl Fault {
    /// A fault that says what is wrong, with values and their valid range.
    pub fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }
}

/// The first part of a step: from the state nearby, the rates of one sub-domain.
///
/// The arguments leave no way to race: [`Near`] only reads, and only the sub-domain and its
/// neighbours; [`Rates`] writes only the sub-domain's own part of the columns that
/// [`RateStage::writes`] lists. The same bits must come out whatever else runs: gather, in a
/// fixed order, and keep nothing in `self` or the scratch that a later call would see.
///
/// A stage that writes the *next state* instead of a rate is the same thing, followed by
/// [`crate::StepBuilder::swap`].
pub trait RateStage<D: Domain>: Send + Sync + 'static {
    /// Working memory of one worker; lives as long as the run.
    type Scratch: Default + Send + 'static;

    /// Name for error messages and traces.
    fn name(&self) -> &str {
        short_type_name::<Self>()
    }

    /// The rate columns it writes.
    fn writes(&self) -> Vec<ColumnId>;

    /// Computes the rates of `near.sub_domain()`.
    ///
    /// # Errors
    /// If the state makes no sense; ends the run with step, stage and sub-domain named.
    fn rate(
        &self,
        near: &Near<'_, D>,
        rates: &mut Rates<'_, D>,
        scratch: &mut Self::Scratch,
        moment: &Moment,
    ) -> Result<(), Fault>;
}

/// The second part of a step: from a sub-domain's own rates, its own state, in place.
pub trait UpdateStage<D: Domain>: Send + Sync + 'static {
    /// Working memory of one worker; lives as long as the run.
    type Scratch: Default + Send + 'static;

    /// Name for error messages and traces.
    fn name(&self) -> &str {
        short_type_name::<Self>()
    }

    /// Columns of which it owns other points than usually, those by a shift of the partition
    /// ([`crate::Partition::push_shift`]): what streams from point to point can then be advanced in place. No
    /// other stage of the step may read such a column from neighbours. None by default.
    fn shifts(&self) -> Vec<(ColumnId, usize)> {
        Vec::new()
    }

    /// Advances the state of one sub-domain.
    ///
    /// # Errors
    /// If the state makes no sense; ends the run with step, stage and sub-domain named.
    fn update(
        &self,
        own: &mut Own<'_, D>,
        scratch: &mut Self::Scratch,
        moment: &Moment,
    ) -> Result<(), Fault>;
}

/// Last segment of a type's path, without generics.
fn short_type_name<T: ?Sized>() -> &'static str {
    let full = std::any::type_name::<T>();
    let path = full.split('<').next().unwrap_or(full);
    path.rsplit("::").next().unwrap_or(path)
}
