use std::error::Error;
use std::iter;

use super::Failure;

/// What one run of a handler gave.
pub type Outcome<R, E> = Result<R, Failure<E>>;

/// Waits for messages and runs a handler on the calling thread.
///
/// A failure concerns the messages of that one call only: the arbiter stays usable, and waiting
/// again goes on with the messages that follow.
pub trait Arbiter {
    /// What the handlers return.
    type Output;
    /// The error of the handlers.
    type Error: Error + 'static;

    /// Sleeps until a handler can run and runs it; `None` once no handler can ever run again,
    /// because the ports are closed and empty.
    fn wait(&mut self) -> Option<Outcome<Self::Output, Self::Error>>;

    /// Runs a handler if one can run now; `None` if not.
    fn try_wait(&mut self) -> Option<Outcome<Self::Output, Self::Error>>;

    /// Runs handlers as messages come, until the ports are closed and empty.
    fn events(&mut self) -> impl Iterator<Item = Outcome<Self::Output, Self::Error>> {
        iter::from_fn(|| self.wait())
    }

    /// Runs handlers for the messages that are there, and ends rather than wait.
    fn pending(&mut self) -> impl Iterator<Item = Outcome<Self::Output, Self::Error>> {
        iter::from_fn(|| self.try_wait())
    }
}
