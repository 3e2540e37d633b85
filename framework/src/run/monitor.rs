//! Monitors and stop criteria: what looks at everything between two steps.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::History;
use super::every::Timetable;
use crate::domain::Domain;
use crate::failure::Cause;
use crate::panic_message::panic_message;
use crate::simulation::{RunError, Simulation};
use crate::whole::Whole;

/// Appends one row of numbers.
type Probe<D> = Box<dyn FnMut(&mut Whole<'_, D>, &mut Vec<f64>) + Send>;

/// Whether to stop.
type Question<D> = Box<dyn FnMut(&mut Whole<'_, D>, &[History]) -> bool + Send>;

/// What makes a scalar history.
pub(super) struct Monitor<D: Domain> {
    pub timetable: Timetable,
    pub probe: Probe<D>,
}

/// A stop criterion.
pub(super) struct Criterion<D: Domain> {
    pub timetable: Timetable,
    pub question: Question<D>,
}

/// Lets a user's code look at everything; its panic is an error of the stage `name`.
pub(super) fn look<D: Domain, R>(
    simulation: &mut Simulation<D>,
    name: impl FnOnce() -> String,
    look: impl FnOnce(&mut Whole<'_, D>) -> R,
) -> Result<R, RunError> {
    let looked = catch_unwind(AssertUnwindSafe(|| look(&mut simulation.whole())));
    looked.map_err(|panic| simulation.error_now(name(), None, Cause::Panic(panic_message(panic))))
}
