//! finegrain framework
#![warn(missing_docs)]
pub mod clock;
mod columns;
pub mod dispatch;
mod domain;
mod leg;
mod schedule;
mod stage;
mod step;
mod sync;
mod team;
mod view;

pub use columns::*;
pub use domain::*;
pub use leg::{Cause, Failure};
pub use schedule::{HandOut, Schedule};
pub use stage::*;
pub use step::{Stage, Step, StepBuilder};
pub use team::Team;
pub use view::*;
