use std::error::Error;

use super::Inbox;
use super::arbiter::{Arbiter, Outcome};
use super::failure::guarded;

/// Runs one handler for every message of one port, in the order of posting.
///
/// # Example
/// ```
/// use finegrain_framework::port::{Arbiter, Port, Receive};
///
/// let (numbers, inbox) = Port::unbounded("numbers");
/// let mut squares = Receive::new(inbox, |n: u32| Ok::<_, std::fmt::Error>(n * n));
/// numbers.post(3)?;
/// numbers.post(4)?;
/// drop(numbers);
/// let squares: Result<Vec<_>, _> = squares.events().collect();
/// assert_eq!(squares?, [9, 16]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Receive<T, F> {
    inbox: Inbox<T>,
    handler: F,
}

impl<T, F> Receive<T, F> {
    /// Receives on `inbox` with `handler`.
    pub fn new<R, E>(inbox: Inbox<T>, handler: F) -> Self
    where
        F: FnMut(T) -> Result<R, E>,
    {
        Self { inbox, handler }
    }
}

impl<T, F, R, E> Arbiter for Receive<T, F>
where
    F: FnMut(T) -> Result<R, E>,
    E: Error + 'static,
{
    type Output = R;
    type Error = E;

    fn wait(&mut self) -> Option<Outcome<R, E>> {
        let message = self.inbox.take()?;
        Some(guarded(self.inbox.name(), || (self.handler)(message)))
    }

    fn try_wait(&mut self) -> Option<Outcome<R, E>> {
        let message = self.inbox.try_take()?;
        Some(guarded(self.inbox.name(), || (self.handler)(message)))
    }
}
