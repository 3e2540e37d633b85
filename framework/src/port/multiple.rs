use std::error::Error;
use std::mem;
use std::num::NonZeroUsize;

use super::arbiter::{Arbiter, Outcome};
use super::ends::Held;
use super::failure::guarded;
use super::{Failure, Inbox};

/// Runs one handler with `count` messages of one port at a time, once all of them are there.
///
/// If the port closes after some but not all of them, that is a [`Failure::Incomplete`]: a worker
/// that died before it reported is noticed, not waited for.
#[derive(Debug)]
pub struct MultipleItemReceive<T, F> {
    inbox: Inbox<T>,
    count: NonZeroUsize,
    items: Vec<T>,
    handler: F,
}

impl<T, F> MultipleItemReceive<T, F> {
    /// Receives `count` messages at a time on `inbox`; `handler` gets them in the order of posting.
    pub fn new<R, E>(inbox: Inbox<T>, count: NonZeroUsize, handler: F) -> Self
    where
        F: FnMut(Vec<T>) -> Result<R, E>,
    {
        Self { inbox, count, items: Vec::new(), handler }
    }
}

impl<T, F, R, E> MultipleItemReceive<T, F>
where
    F: FnMut(Vec<T>) -> Result<R, E>,
    E: Error + 'static,
{
    fn add(&mut self, item: T) -> Option<Outcome<R, E>> {
        self.items.push(item);
        if self.items.len() < self.count.get() {
            return None;
        }
        let items = mem::take(&mut self.items);
        Some(guarded(self.inbox.name(), || (self.handler)(items)))
    }

    fn end(&mut self) -> Option<Outcome<R, E>> {
        let found = mem::take(&mut self.items).len();
        (found > 0).then(|| {
            Err(Failure::Incomplete {
                port: self.inbox.name().to_string(),
                expected: self.count.get(),
                found,
            })
        })
    }
}

impl<T, F, R, E> Arbiter for MultipleItemReceive<T, F>
where
    F: FnMut(Vec<T>) -> Result<R, E>,
    E: Error + 'static,
{
    type Output = R;
    type Error = E;

    fn wait(&mut self) -> Option<Outcome<R, E>> {
        while let Some(item) = self.inbox.take() {
            if let Some(outcome) = self.add(item) {
                return Some(outcome);
            }
        }
        self.end()
    }

    fn try_wait(&mut self) -> Option<Outcome<R, E>> {
        loop {
            match self.inbox.look() {
                Held::Nothing => return None,
                Held::End => return self.end(),
                Held::Message { .. } => {
                    let item = self.inbox.try_take()?;
                    if let Some(outcome) = self.add(item) {
                        return Some(outcome);
                    }
                }
            }
        }
    }
}
