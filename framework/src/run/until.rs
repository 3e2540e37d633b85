//! When a run ends.

use std::time::Duration;

/// What ends a run; whatever comes first does, and `None` never.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Until {
    /// Number of steps, counted from the beginning of time, not from a restart.
    pub steps: Option<u64>,
    /// Time, hit exactly: steps are made a little shorter, those of the last pace; of a method with
    /// a fixed time step that is all of them.
    pub time: Option<f64>,
    /// Wall-clock time that this run may take, looked at between legs of some 50 ms, or of one
    /// step if that takes longer.
    pub wall_clock: Option<Duration>,
}

/// Why a run ended in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stopped {
    /// Somebody asked for it.
    Asked,
    /// A criterion was met.
    Criterion,
    /// The number of steps was done.
    Steps,
    /// The end time was reached.
    Time,
    /// The wall-clock time was used up.
    WallClock,
}

impl std::fmt::Display for Stopped {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::Asked => "stopped on request",
            Self::Criterion => "stop criterion met",
            Self::Steps => "all steps done",
            Self::Time => "end time reached",
            Self::WallClock => "wall-clock limit reached",
        })
    }
}
