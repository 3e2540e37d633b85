//! Typed ports and the five arbiters of Holmes, Williams & Tilke (2011), section 3.1: how events
//! travel beside the time loops.
//!
//! A [`Port`] takes messages, its [`Inbox`] gives them out first in, first out, and an arbiter
//! waits for messages and runs a handler. Nobody polls: an arbiter sleeps until something arrives.
//!
//! | arbiter | runs a handler |
//! |---|---|
//! | [`Receive`] | for every message of one port |
//! | [`Choice`] | of the port on which the message arrived, of several |
//! | [`Interleave`] | beside the others, alone, or last of all, by the group its port is in |
//! | [`Join`] | once each of two ports holds a message |
//! | [`MultipleItemReceive`] | once a given number of messages is there |
//!
//! # What holds
//! - **No message is lost in silence.** A message whose post succeeded is handled, or its handler's
//!   error or panic is reported as a [`Failure`], for as long as the arbiter is run to its end; a
//!   post that comes too late fails and gives the message back.
//! - **Order of posting is order of handling**, over all the ports of one arbiter: if one post
//!   happened before another, its message is taken first.
//! - **Nothing hangs on a dead partner.** When the last clone of a port is dropped, its messages
//!   are handled and then the arbiter ends.
//!
//! # Example
//! A time loop looks at its control ports between two steps, without waiting:
//! ```
//! use finegrain_framework::port::{Arbiter, Choice, Port};
//!
//! enum Control { Stop, Checkpoint(String) }
//!
//! let (stop, stops) = Port::unbounded("stop");
//! let (checkpoint, requests) = Port::unbounded("checkpoint");
//! let mut control = Choice::new()
//!     .on(stops, |()| Ok::<_, std::io::Error>(Control::Stop))
//!     .on(requests, |path| Ok(Control::Checkpoint(path)));
//!
//! checkpoint.post("at-step-7".to_string())?;
//! stop.post(())?;
//! let mut done = Vec::new();
//! for event in control.pending() {
//!     match event? {
//!         Control::Stop => done.push("stop".to_string()),
//!         Control::Checkpoint(path) => done.push(path),
//!     }
//! }
//! assert_eq!(done, ["at-step-7", "stop"]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arbiter;
mod branches;
mod choice;
mod ends;
mod failure;
mod interleave;
mod join;
mod multiple;
mod receive;

pub use arbiter::{Arbiter, Outcome};
pub use choice::Choice;
pub use ends::{Inbox, Port, PostError};
pub use failure::Failure;
pub use interleave::{Ended, Interleave};
pub use join::Join;
pub use multiple::MultipleItemReceive;
pub use receive::Receive;
