//! Why a run failed.

use std::error::Error;
use std::fmt;
use std::io;
use std::path::PathBuf;

use crate::checkpoint::CheckpointError;
use crate::format::FormatError;
use crate::simulation::{RestoreError, RunError};

/// A run failed, and this is where it can be taken up again.
///
/// Shown in words by `Debug` too, with all causes, so that a `main` that returns it says what is
/// wrong.
pub struct RunFailed {
    /// Why.
    pub cause: RunFailure,
    /// The last checkpoint that is known to be complete: written by this run, or the one it was
    /// restarted from.
    pub last_checkpoint: Option<PathBuf>,
}

impl fmt::Display for RunFailed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.cause.fmt(f)?;
        match &self.last_checkpoint {
            Some(path) => write!(f, " (last good checkpoint: `{}`)", path.display()),
            None => Ok(()),
        }
    }
}

impl fmt::Debug for RunFailed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")?;
        let mut source = self.source();
        while let Some(cause) = source {
            write!(f, ": {cause}")?;
            source = cause.source();
        }
        Ok(())
    }
}

impl Error for RunFailed {
    /// What is behind the cause, which has been shown.
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.cause.source()
    }
}

/// Why a run failed.
#[derive(Debug, thiserror::Error)]
pub enum RunFailure {
    /// A stage, a monitor or a check of the state.
    #[error(transparent)]
    Step(Box<RunError>),
    /// An output could not be written.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The run cannot go on from the checkpoint.
    #[error(transparent)]
    Restore(#[from] RestoreError),
    /// The checkpoint is of another scene.
    #[error("checkpoint `{}` is of another scene: {differences}", path.display())]
    Scene {
        /// The checkpoint.
        path: PathBuf,
        /// What differs.
        differences: String,
    },
    /// The checkpoint is later than the end of the run.
    #[error(
        "checkpoint `{}` is of {reached}, past {end}, the end of the run (both count from the \
         beginning of time)",
        path.display()
    )]
    PastEnd {
        /// The checkpoint.
        path: PathBuf,
        /// Where it is.
        reached: String,
        /// Where the run is to end.
        end: String,
    },
    /// A monitor has other columns in the checkpoint.
    #[error(
        "checkpoint `{}` has monitor `{monitor}` with columns {found:?}, the run with {expected:?}",
        path.display()
    )]
    Monitor {
        /// The checkpoint.
        path: PathBuf,
        /// Name of the monitor.
        monitor: String,
        /// Its columns in the run.
        expected: Vec<String>,
        /// Its columns in the checkpoint.
        found: Vec<String>,
    },
    /// A number of the plan makes no sense.
    #[error("{key} is {value}; it must be {must}")]
    Value {
        /// What the number is.
        key: String,
        /// The number.
        value: String,
        /// What would make sense.
        must: &'static str,
    },
    /// The name of an output cannot be one.
    #[error("{output} `{name}` {why}")]
    Name {
        /// What is called so.
        output: &'static str,
        /// The name.
        name: String,
        /// Why it cannot be.
        why: &'static str,
    },
    /// A dump names a column that the model does not have.
    #[error("dump `{dump}` shows column `{column}`, which the model does not have; it has {known}")]
    Column {
        /// Name of the dump.
        dump: String,
        /// Name of the column.
        column: String,
        /// Names of the model's columns.
        known: String,
    },
    /// There are files to write, but no folder for them.
    #[error("{output} needs a folder to be written to (`Run::out`)")]
    NoFolder {
        /// What is to be written.
        output: String,
    },
    /// Nothing would ever end the run.
    #[error(
        "nothing ends the run: it needs a number of steps, an end time, a wall-clock limit, a stop \
         criterion or a port that asks it to stop"
    )]
    Endless,
    /// The writer thread could not be started.
    #[error("cannot start the writer thread")]
    Thread(#[source] io::Error),
    /// The writer panicked, which is an error of this program.
    #[error("the writer thread failed: {0}")]
    Writer(String),
}

impl From<RunError> for RunFailure {
    fn from(error: RunError) -> Self {
        Self::Step(Box::new(error))
    }
}

/// Why an output could not be written.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The system refused something.
    #[error("cannot {attempt} `{}`", path.display())]
    File {
        /// What was tried, a verb.
        attempt: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// Another run has not ended yet.
    #[error(
        "another run is writing to the folder `{}`: wait until it has ended, or give this one another",
        folder.display()
    )]
    InUse {
        /// The folder.
        folder: PathBuf,
    },
    /// A file for viewing.
    #[error(transparent)]
    Format(#[from] FormatError),
    /// A checkpoint.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
}
