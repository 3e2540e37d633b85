//! The run loop: steps a [`Simulation`](crate::Simulation) to its end, and writes what is asked
//! for on the way.
//!
//! | output | what | files |
//! |---|---|---|
//! | monitor | scalar history | `NAME.csv`, and [`Summary::histories`] |
//! | [`Dump`] | fields for viewing | `NAME-STEP.vtu` or `.vti`, and the series `NAME.pvd` |
//! | checkpoint | bits for restarting | `checkpoint-STEP.ckpt` |
//!
//! Stepping does not wait for a disk: rows and snapshots of columns are posted to a writer
//! thread, an [`Interleave`](crate::port::Interleave) that handles them in order. At most two
//! snapshots are under way; who wants a third waits until the disk has caught up, so that a slow
//! one slows the run instead of eating the memory.
//!
//! # What holds
//! - **Outputs never change a result.** Where a run is cut into legs, and what is written between
//!   them, has no influence on the time step or on any stage.
//! - **A restarted run is the uninterrupted one.** From a checkpoint at *any* step, the state, the
//!   histories and the dumps that follow have the same bytes, under any schedule and number of
//!   workers; files that are younger than the checkpoint leave the histories and the series.
//! - **What is saved stays saved.** Dumps, series and checkpoints appear under their names when
//!   they are complete; however a run ends, what it has written is whole.
//!
//! # Example
//! ```
//! # use finegrain_framework::{space::Grid, *};
//! # let domain = Grid::builder([16, 16]).build();
//! # let mut columns = Columns::new(domain.points());
//! # let temperature = columns.state::<f64>("temperature");
//! # let model = Model::with_fixed_dt("rest", domain, columns, Step::builder().build(), 0.1);
//! # let folder = tempfile::tempdir()?;
//! use finegrain_framework::run::{Dump, Every, Run, Until};
//!
//! let simulation = Simulation::new(model, Settings::default())?;
//! let mut run = Run::new(simulation)
//!     .until(Until { time: Some(1.0), ..Until::default() })
//!     .out(folder.path())
//!     .monitor("heat", Every::Steps(2), ["sum"], move |whole| {
//!         whole.sum(|near| [near.state(temperature).own().whole().iter().sum()])
//!     })
//!     .dump(Dump::new("fields", Every::Time(0.5)).scalar("temperature"))
//!     .checkpoint(Every::Steps(5), 2);
//! let summary = run.run()?;
//! assert_eq!((summary.step, summary.time), (10, 1.0));
//! assert_eq!(summary.histories[0].len(), 6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod check;
mod dump;
mod every;
mod failure;
mod history;
mod monitor;
mod plan;
mod progress;
mod record;
mod resume;
mod run_loop;
mod snapshot;
mod store;
mod summary;
mod until;
mod view;
mod writer;

pub use dump::Dump;
pub use every::Every;
pub use failure::{OutputError, RunFailed, RunFailure};
pub use history::History;
pub use plan::Run;
pub use progress::Progress;
pub use summary::Summary;
pub use until::{Stopped, Until};
