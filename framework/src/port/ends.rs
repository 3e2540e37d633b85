use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, PoisonError, RwLock, Weak};

use crossbeam_channel::{Receiver, Select, SendError, Sender, TryRecvError, TrySendError};

/// Gives every message its place in the order of all posts. Relaxed is enough: if one post happens
/// before another, the order of changes to a single atomic follows.
static POSTS: AtomicU64 = AtomicU64::new(0);

/// A message and its place in the order of all posts.
#[derive(Debug)]
struct Stamped<T> {
    stamp: u64,
    message: T,
}

/// The sender that all clones of a port share. Taking it out closes the port: a post in progress
/// holds a clone of it, so an inbox that empties its channel until it is disconnected has seen
/// every message that was ever accepted.
type Gate<T> = RwLock<Option<Sender<Stamped<T>>>>;

/// The posting end of a first-in-first-out queue of messages; clones post to the same queue.
///
/// The queue closes when the last clone is dropped, or when its [`Inbox`] is closed or dropped.
pub struct Port<T> {
    name: Arc<str>,
    gate: Arc<Gate<T>>,
}

impl<T> Port<T> {
    /// A port that never blocks who posts, and its inbox.
    ///
    /// `name` is what failures call the port by.
    pub fn unbounded(name: &str) -> (Self, Inbox<T>) {
        Self::over(name, crossbeam_channel::unbounded())
    }

    /// A port on which at most `capacity` messages wait (at least one), and its inbox: who posts
    /// one more sleeps until there is room. This back-pressure bounds the memory of large messages.
    ///
    /// A handler that posts to a full bounded port of its own arbiter waits for itself: do not.
    pub fn bounded(name: &str, capacity: usize) -> (Self, Inbox<T>) {
        Self::over(name, crossbeam_channel::bounded(capacity.max(1)))
    }

    fn over(
        name: &str,
        (sender, receiver): (Sender<Stamped<T>>, Receiver<Stamped<T>>),
    ) -> (Self, Inbox<T>) {
        let name: Arc<str> = name.into();
        let gate = Arc::new(RwLock::new(Some(sender)));
        let inbox =
            Inbox { name: Arc::clone(&name), receiver, head: None, gate: Arc::downgrade(&gate) };
        (Self { name, gate }, inbox)
    }

    /// The name the port was made with.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Appends `message` to the queue; only a full bounded port makes the caller wait.
    ///
    /// # Errors
    /// [`PostError::Closed`] gives the message back if nobody will receive it.
    pub fn post(&self, message: T) -> Result<(), PostError<T>> {
        match self.sender() {
            None => Err(self.closed(message)),
            Some(sender) => sender
                .send(stamped(message))
                .map_err(|SendError(refused)| self.closed(refused.message)),
        }
    }

    /// Appends `message` to the queue if that needs no waiting.
    ///
    /// # Errors
    /// [`PostError::Full`] or [`PostError::Closed`], with the message.
    pub fn try_post(&self, message: T) -> Result<(), PostError<T>> {
        match self.sender() {
            None => Err(self.closed(message)),
            Some(sender) => sender.try_send(stamped(message)).map_err(|refused| match refused {
                TrySendError::Disconnected(refused) => self.closed(refused.message),
                TrySendError::Full(refused) => {
                    PostError::Full { port: self.name.to_string(), message: refused.message }
                }
            }),
        }
    }

    /// A clone, so that the gate is not held while a post waits for room.
    fn sender(&self) -> Option<Sender<Stamped<T>>> {
        self.gate.read().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn closed(&self, message: T) -> PostError<T> {
        PostError::Closed { port: self.name.to_string(), message }
    }
}

fn stamped<T>(message: T) -> Stamped<T> {
    Stamped { stamp: POSTS.fetch_add(1, Ordering::Relaxed), message }
}

impl<T> Clone for Port<T> {
    fn clone(&self) -> Self {
        Self { name: Arc::clone(&self.name), gate: Arc::clone(&self.gate) }
    }
}

impl<T> fmt::Debug for Port<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Port").field(&self.name).finish()
    }
}

/// The receiving end of a [`Port`]; usually given to an arbiter.
pub struct Inbox<T> {
    name: Arc<str>,
    receiver: Receiver<Stamped<T>>,
    /// The oldest message, taken out of the channel to look at its stamp before it is its turn.
    head: Option<Stamped<T>>,
    /// Weak, so that dropping the last port still disconnects the channel.
    gate: Weak<Gate<T>>,
}

/// What an inbox holds right now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Held {
    /// A message, posted at this place in the order of all posts.
    Message { stamp: u64 },
    /// Nothing yet.
    Nothing,
    /// Nothing, and nothing will ever come.
    End,
}

impl<T> Inbox<T> {
    /// The name the port was made with.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Sleeps until a message is there and takes it; `None` once the port is closed and empty.
    pub fn take(&mut self) -> Option<T> {
        match self.head.take() {
            Some(head) => Some(head.message),
            None => self.receiver.recv().ok().map(|stamped| stamped.message),
        }
    }

    /// Takes the oldest message if there is one.
    pub fn try_take(&mut self) -> Option<T> {
        self.look();
        self.head.take().map(|head| head.message)
    }

    /// Refuses all further posts; messages already accepted stay to be taken.
    pub fn close(&self) {
        if let Some(gate) = self.gate.upgrade() {
            gate.write().unwrap_or_else(PoisonError::into_inner).take();
        }
    }

    /// Looks at the oldest message without giving it out.
    pub(super) fn look(&mut self) -> Held {
        if self.head.is_none() {
            match self.receiver.try_recv() {
                Ok(stamped) => self.head = Some(stamped),
                Err(TryRecvError::Empty) => return Held::Nothing,
                Err(TryRecvError::Disconnected) => return Held::End,
            }
        }
        self.head.as_ref().map_or(Held::Nothing, |head| {
            let stamp = head.stamp;
            Held::Message { stamp }
        })
    }

    /// Lets `select` wake up when there is something new to look at.
    pub(super) fn watch<'a>(&'a self, select: &mut Select<'a>) {
        select.recv(&self.receiver);
    }
}

impl<T> fmt::Debug for Inbox<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Inbox").field(&self.name).finish()
    }
}

/// Why a post was refused; holds the message.
#[derive(thiserror::Error)]
pub enum PostError<T> {
    /// Nobody will receive on the port any more.
    #[error("port `{port}` is closed")]
    Closed {
        /// Name of the port.
        port: String,
        /// The message that was refused.
        message: T,
    },
    /// The bounded port has no room at the moment (only [`Port::try_post`] says so).
    #[error("port `{port}` is full")]
    Full {
        /// Name of the port.
        port: String,
        /// The message that was refused.
        message: T,
    },
}

impl<T> PostError<T> {
    /// Gives the refused message back.
    pub fn into_message(self) -> T {
        match self {
            Self::Closed { message, .. } | Self::Full { message, .. } => message,
        }
    }
}

// By hand, so that a message need not be printable for its error to be.
impl<T> fmt::Debug for PostError<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, port) = match self {
            Self::Closed { port, .. } => ("Closed", port),
            Self::Full { port, .. } => ("Full", port),
        };
        f.debug_struct(kind).field("port", port).finish()
    }
}
