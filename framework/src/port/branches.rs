use crossbeam_channel::Select;

use super::Inbox;
use super::ends::Held;

/// Several inboxes, of messages of different types, that one arbiter waits on. What is taken out
/// of any of them is a `J`, which its branch makes of the message.
pub(super) struct Branches<'h, J> {
    open: Vec<Box<dyn Branch<J> + Send + 'h>>,
}

trait Branch<J> {
    fn look(&mut self) -> Held;
    fn take(&mut self) -> Option<J>;
    fn watch<'a>(&'a self, select: &mut Select<'a>);
    fn close(&self);
}

struct Mapped<T, F> {
    inbox: Inbox<T>,
    make: F,
}

impl<T, J, F: FnMut(&str, T) -> J> Branch<J> for Mapped<T, F> {
    fn look(&mut self) -> Held {
        self.inbox.look()
    }

    fn take(&mut self) -> Option<J> {
        let message = self.inbox.try_take()?;
        Some((self.make)(self.inbox.name(), message))
    }

    fn watch<'a>(&'a self, select: &mut Select<'a>) {
        self.inbox.watch(select);
    }

    fn close(&self) {
        self.inbox.close();
    }
}

impl<'h, J> Branches<'h, J> {
    pub(super) fn new() -> Self {
        Self { open: Vec::new() }
    }

    /// Adds a branch; `make` gets the name of the port and the message.
    pub(super) fn add<T: Send + 'h>(
        &mut self,
        inbox: Inbox<T>,
        make: impl FnMut(&str, T) -> J + Send + 'h,
    ) {
        self.open.push(Box::new(Mapped { inbox, make }));
    }

    /// Refuses further posts on all branches.
    pub(super) fn close(&self) {
        for branch in &self.open {
            branch.close();
        }
    }

    /// Sleeps until a message is there and takes it; `None` once all branches are at their end.
    pub(super) fn take(&mut self) -> Option<J> {
        loop {
            if let Some(job) = self.try_take() {
                return Some(job);
            }
            if self.open.is_empty() {
                return None;
            }
            let mut select = Select::new();
            for branch in &self.open {
                branch.watch(&mut select);
            }
            select.ready();
        }
    }

    /// Takes the message posted first, if there is any.
    pub(super) fn try_take(&mut self) -> Option<J> {
        let oldest = self.oldest()?;
        self.open[oldest].take()
    }

    /// The branch that holds the message posted first.
    fn oldest(&mut self) -> Option<usize> {
        // A message may arrive in a branch already looked at, followed by its successor in a branch
        // still to be looked at. So look again until nothing new turns up: then everything posted
        // before any of the messages held is held as well. Each round but the last fills a branch.
        let mut held = 0;
        loop {
            let mut oldest = None;
            let mut found = 0;
            let mut index = 0;
            self.open.retain_mut(|branch| match branch.look() {
                Held::End => false,
                Held::Nothing => {
                    index += 1;
                    true
                }
                Held::Message { stamp } => {
                    if oldest.is_none_or(|(first, _)| stamp < first) {
                        oldest = Some((stamp, index));
                    }
                    found += 1;
                    index += 1;
                    true
                }
            });
            if found == held {
                return oldest.map(|(_, index)| index);
            }
            held = found;
        }
    }
}
