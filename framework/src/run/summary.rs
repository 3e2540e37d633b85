//! What a run came to.

use std::path::PathBuf;
use std::time::Duration;

use super::{History, Stopped};

/// What a run came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Why it ended.
    pub stopped: Stopped,
    /// Number of steps since the beginning of time.
    pub step: u64,
    /// Number of steps that this run did, the last restart being its beginning.
    pub steps_done: u64,
    /// Time reached.
    pub time: f64,
    /// Wall-clock time that this run took, outputs included.
    pub wall_clock: Duration,
    /// [`Simulation::state_hash`](crate::Simulation::state_hash) at the end.
    pub state_hash: u64,
    /// [`Simulation::instruction_sets`](crate::Simulation::instruction_sets).
    pub instruction_sets: Vec<String>,
    /// The monitors' histories since the beginning of time, in order of declaration.
    pub histories: Vec<History>,
    /// Files written, in order, but for checkpoints that were removed again.
    pub files: Vec<PathBuf>,
    /// The last checkpoint: written by this run, or the one it was restarted from.
    pub last_checkpoint: Option<PathBuf>,
}
