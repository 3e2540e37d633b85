//! finegrain framework
#![warn(missing_docs)]
pub mod checkpoint;
pub mod clock;
mod columns;
#[cfg(doctest)]
mod compile_fail;
pub mod dispatch;
mod domain;
pub mod format;
pub mod integrator;
pub mod lanes;
mod leg;
#[cfg(all(test, loom))]
mod model_checks;
pub mod port;
mod real;
pub mod run;
mod schedule;
pub mod shape;
mod simulation;
pub mod space;
mod stage;
mod step;
mod sync;
mod team;
mod view;
mod viewable;
mod whole;

pub use columns::*;
pub use domain::*;
pub use integrator::{Evolution, Integrator, Plan};
pub use leg::{Cause, Failure};
pub use real::Real;
pub use schedule::{HandOut, Schedule};
pub use simulation::{Model, Position, RestoreError, RunError, Settings, Simulation};
pub use stage::*;
pub use step::{Stage, Step, StepBuilder};
pub use team::Team;
pub use view::*;
pub use viewable::{Geometry, Viewable};
pub use whole::{FixedPace, Pace, Pacing, Whole, WholeStage};
