//! How a simulation is run: schedule, workers, checks.

use crate::schedule::{HandOut, Schedule};

/// How to run a model; none of it changes a result.
#[derive(Clone, Debug)]
pub struct Settings {
    /// How workers meet.
    pub schedule: Schedule,
    /// Number of workers; all cores by default.
    pub workers: usize,
    /// Order of hand-out.
    pub hand_out: HandOut,
    /// Check that state columns are finite after every so many steps; `None` never. A NaN
    /// spreads to a neighbourhood a step, so a check every few steps still says where it began.
    pub check_every: Option<u64>,
    /// Most steps that `PeerToPeer` runs between meetings; chosen from the size of the cache and
    /// of a sub-domain if `None`.
    pub steps_ahead: Option<u64>,
    /// Parts that each worker remembers having run, 32 bytes each, see [`Simulation::trace`]; 0
    /// records nothing and costs nothing.
    ///
    /// [`Simulation::trace`]: crate::Simulation::trace
    pub trace: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            schedule: Schedule::default(),
            workers: crate::dispatch::cores(),
            hand_out: HandOut::default(),
            check_every: Some(10),
            steps_ahead: None,
            trace: 0,
        }
    }
}
