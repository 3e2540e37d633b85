//! Dispatch: hands sub-domains to whichever worker asks (Holmes et al. 2011, section 3.3).
//!
//! Its four duties, and where they are met:
//!
//! 1. *Finalization*: it knows when all values are handed out. [`Dispatch::request`] answers
//!    `None` from then on; [`ReadyDispatch`] counts the values still to come.
//! 2. *Completion*: complete fires only after every worker came back unserved, so the last
//!    values are processed by then: [`Dispatch::complete`] is a [`Meeting`].
//! 3. *Acquisition while distributing*: values may arrive while others are handed out; an empty
//!    queue is not the end. [`ReadyDispatch`] takes offers until all that was announced has
//!    been handed out.
//! 4. *Event driven*: a worker without work sleeps until a value arrives or the end is known;
//!    nobody polls (module `waiting`).

use std::sync::OnceLock;

pub(crate) mod deque;
mod meeting;
mod ready;
mod sequence;
pub(crate) mod waiting;

pub use meeting::Meeting;
pub use ready::{ReadyDispatch, Server};
pub use sequence::Dispatch;

/// Cores this process may use; asked for once, because the answer is read from files.
pub(crate) fn cores() -> usize {
    static CORES: OnceLock<usize> = OnceLock::new();
    *CORES.get_or_init(|| std::thread::available_parallelism().map_or(1, |n| n.get()))
}
