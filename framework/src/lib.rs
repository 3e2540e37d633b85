//! The framework of finegrain: parallel time stepping on multi-core machines, for any numerical
//! method.
//!
//! It turns the idea of Holmes, Williams & Tilke (2011) into traits. Space is divided into many
//! *fine-grained sub-domains* ([`Domain`], [`SubDomain`]). A step has two parts: a [`RateStage`]
//! reads the state of a sub-domain and its neighbours and writes only its own rates; an
//! [`UpdateStage`] reads its own rates and writes only its own state. A [`dispatch`] hands
//! sub-domains to worker threads as they become free, under one of several [`Schedule`]s, all with
//! the same bits. No locks, no ghost copies, no messages; and the arguments of the two traits leave
//! a method no way to express a race.
//!
//! | to do this | use |
//! |---|---|
//! | divide space | [`space::Grid`], [`space::Cells`], [`space::Independent`], or a [`Domain`] of your own |
//! | declare fields | [`Columns::state`], [`Columns::rate`] |
//! | write physics | [`RateStage`], [`UpdateStage`]; whole-domain work in a [`WholeStage`] |
//! | vectorise it where the compiler does not | [`pack`], [`lanes`] |
//! | build a step | [`Integrator::plan`], or [`Step::builder`] |
//! | run it | [`Simulation`]; with outputs, checkpoints and restart [`run::Run`] |
//! | see who did what when | [`Settings::trace`], [`trace`] |
//!
//! # Example
//! Heat in a ring: the rate stage computes the next temperature, which then takes the place of the
//! present one.
//! ```
//! use finegrain_framework::{space::Grid, *};
//!
//! struct Diffusion {
//!     temperature: State<f64>,
//!     next: Rate<f64>,
//! }
//!
//! impl RateStage<Grid> for Diffusion {
//!     type Scratch = ();
//!
//!     fn writes(&self) -> Vec<ColumnId> {
//!         vec![self.next.id()]
//!     }
//!
//!     fn rate(
//!         &self,
//!         near: &Near<'_, Grid>,
//!         rates: &mut Rates<'_, Grid>,
//!         _: &mut (),
//!         _: &Moment,
//!     ) -> Result<(), Fault> {
//!         let (now, mut next) = (near.rows(self.temperature), rates.rows(self.next));
//!         // A grid of rows along y, one point each, shows neighbours at work.
//!         for (j, k) in near.sub_domain().rows() {
//!             let at = |dj: isize| now.row(j as isize + dj, k as isize)[0];
//!             next.row(j, k)[0] = at(0) + 0.25 * (at(-1) - 2.0 * at(0) + at(1));
//!         }
//!         Ok(())
//!     }
//! }
//!
//! let domain = Grid::builder([1, 100]).periodic([false, true]).tile(10, 1).build();
//! let mut columns = Columns::new(domain.points());
//! let (temperature, next) = (columns.state("temperature"), columns.rate("next"));
//! columns.values_mut(temperature)[50] = 1.0;
//! let step = Step::builder()
//!     .rate(Diffusion { temperature, next })
//!     .swap(temperature, next)
//!     .build();
//! let model = Model::with_fixed_dt("heat", domain, columns, step, 1.0);
//! let mut simulation = Simulation::new(model, Settings::default())?;
//! simulation.advance(200)?;
//! let total: f64 = simulation.columns().values(temperature).iter().sum();
//! assert!((total - 1.0).abs() < 1e-14);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![warn(missing_docs)]
mod activity;
pub mod checkpoint;
pub mod clock;
mod columns;
#[cfg(doctest)]
mod compile_fail;
mod desk;
pub mod dispatch;
mod domain;
mod failure;
pub mod format;
pub mod instructions;
pub mod integrator;
pub mod lanes;
mod leg;
mod memory;
#[cfg(all(test, loom))]
mod model_checks;
mod notes;
pub mod pack;
mod panic_message;
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
pub mod trace;
mod vector_field;
mod view;
mod viewable;
mod whole;
mod workload;

pub use activity::{Activities, Activity};
pub use columns::*;
pub use domain::*;
pub use failure::{Cause, Failure};
pub use integrator::{Evolution, Integrator, Plan};
pub use memory::{NoMemory, check_memory};
pub use notes::{Note, Notes};
pub use real::Real;
pub use schedule::{HandOut, Schedule};
pub use simulation::{Model, Position, RestoreError, RunError, Settings, Simulation};
pub use stage::*;
pub use step::{Stage, Step, StepBuilder};
pub use team::Team;
pub use vector_field::VectorField;
pub use view::*;
pub use viewable::{Geometry, Viewable};
pub use whole::{FixedPace, Pace, Pacing, RigidPace, Whole, WholeStage};
pub use workload::{PartCost, Workload};
