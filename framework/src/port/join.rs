use std::error::Error;

use crossbeam_channel::Select;

use super::arbiter::{Arbiter, Outcome};
use super::ends::Held;
use super::failure::guarded;
use super::{Failure, Inbox};

/// Runs one handler with a message of each of two ports, once both are there.
///
/// If one port closes while a message waits on the other, the pair can never be: that is a
/// [`Failure::Incomplete`] which names the port that closed, and the join ends, closing both ports.
#[derive(Debug)]
pub struct Join<A, B, F> {
    first: Inbox<A>,
    second: Inbox<B>,
    handler: F,
    ended: bool,
}

impl<A, B, F> Join<A, B, F> {
    /// Joins `first` and `second` with `handler`.
    pub fn new<R, E>(first: Inbox<A>, second: Inbox<B>, handler: F) -> Self
    where
        F: FnMut(A, B) -> Result<R, E>,
    {
        Self { first, second, handler, ended: false }
    }

    /// Ends the join, for `closed` will bring no more; messages left on the other side make this a
    /// failure.
    fn end<E: Error>(&mut self, closed: String) -> Option<Failure<E>> {
        self.ended = true;
        self.first.close();
        self.second.close();
        // To the very end, so that a post that was accepted just now is reported too.
        let mut left = 0;
        while self.first.take().is_some() {
            left += 1;
        }
        while self.second.take().is_some() {
            left += 1;
        }
        (left > 0).then_some(Failure::Incomplete { port: closed, expected: 1, found: 0 })
    }

    fn sleep(&self, first: Held, second: Held) {
        let mut select = Select::new();
        if first == Held::Nothing {
            self.first.watch(&mut select);
        }
        if second == Held::Nothing {
            self.second.watch(&mut select);
        }
        select.ready();
    }
}

/// How far a pair has come.
enum Pair<O> {
    Done(O),
    Missing(Held, Held),
    Ended,
}

impl<A, B, F, R, E> Join<A, B, F>
where
    F: FnMut(A, B) -> Result<R, E>,
    E: Error + 'static,
{
    fn look(&mut self) -> Pair<Outcome<R, E>> {
        if self.ended {
            return Pair::Ended;
        }
        let failure = match (self.first.look(), self.second.look()) {
            (Held::End, _) => self.end(self.first.name().to_string()),
            (_, Held::End) => self.end(self.second.name().to_string()),
            (Held::Message { .. }, Held::Message { .. }) => {
                let (Some(a), Some(b)) = (self.first.try_take(), self.second.try_take()) else {
                    unreachable!("both messages were just seen, and only this join takes them");
                };
                let port = format!("{} + {}", self.first.name(), self.second.name());
                return Pair::Done(guarded(&port, || (self.handler)(a, b)));
            }
            (first, second) => return Pair::Missing(first, second),
        };
        failure.map_or(Pair::Ended, |failure| Pair::Done(Err(failure)))
    }
}

impl<A, B, F, R, E> Arbiter for Join<A, B, F>
where
    F: FnMut(A, B) -> Result<R, E>,
    E: Error + 'static,
{
    type Output = R;
    type Error = E;

    fn wait(&mut self) -> Option<Outcome<R, E>> {
        loop {
            match self.look() {
                Pair::Done(outcome) => return Some(outcome),
                Pair::Missing(first, second) => self.sleep(first, second),
                Pair::Ended => return None,
            }
        }
    }

    fn try_wait(&mut self) -> Option<Outcome<R, E>> {
        match self.look() {
            Pair::Done(outcome) => Some(outcome),
            Pair::Missing(..) | Pair::Ended => None,
        }
    }
}
