use std::error::Error;
use std::fmt;

use super::Inbox;
use super::arbiter::{Arbiter, Outcome};
use super::branches::Branches;
use super::failure::guarded;

/// Runs one of several handlers for each message: that of the port it arrived on.
///
/// Messages are taken in the order in which they were posted, whichever ports they were posted to.
/// All handlers return the same type, so a choice makes one stream of events out of several ports.
pub struct Choice<'h, R, E: Error + 'static> {
    branches: Branches<'h, Outcome<R, E>>,
}

impl<'h, R: 'h, E: Error + 'static> Choice<'h, R, E> {
    /// A choice of nothing, which has ended; add ports with [`Choice::on`].
    pub fn new() -> Self {
        Self { branches: Branches::new() }
    }

    /// Runs `handler` for the messages of `inbox`.
    #[must_use]
    pub fn on<T: Send + 'h>(
        mut self,
        inbox: Inbox<T>,
        mut handler: impl FnMut(T) -> Result<R, E> + Send + 'h,
    ) -> Self {
        self.branches.add(inbox, move |port, message| guarded(port, || handler(message)));
        self
    }
}

impl<'h, R: 'h, E: Error + 'static> Default for Choice<'h, R, E> {
    fn default() -> Self {
        Self::new()
    }
}

impl<R, E: Error + 'static> fmt::Debug for Choice<'_, R, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Choice").finish_non_exhaustive()
    }
}

impl<R, E: Error + 'static> Arbiter for Choice<'_, R, E> {
    type Output = R;
    type Error = E;

    fn wait(&mut self) -> Option<Outcome<R, E>> {
        self.branches.take()
    }

    fn try_wait(&mut self) -> Option<Outcome<R, E>> {
        self.branches.try_take()
    }
}
