//! Files for looking at results: ParaView's own formats, written straight from columns.
//!
//! | file | holds | written by |
//! |---|---|---|
//! | `.vtu` | points with fields (particles) | [`Vtu`] |
//! | `.vti` | a regular grid with fields | [`Vti`] |
//! | `.pvd` | which of these files belongs to which time | [`Pvd`] |
//!
//! Fields are borrowed ([`Array`], [`Values`]) and streamed through a small buffer; no copy of a
//! whole field is made. Every `save` replaces its file at once ([`AtomicFile`]): a reader sees the
//! old file or the new one, never half of one.
//!
//! # Example
//! ```
//! use finegrain_framework::format::{Array, Vtu};
//!
//! let (x, y) = ([0.0_f64, 1.0, 2.0], [0.5_f64, 0.5, 0.5]);
//! let density = [1000.0_f32, 998.0, 1001.0];
//! let mut file = Vec::new();
//! Vtu {
//!     points: Array::plane("position", [&x[..], &y[..]]),
//!     point_data: &[Array::scalar("density", &density[..])],
//!     time: Some(0.25),
//! }
//! .write(&mut file)?;
//! # Ok::<(), finegrain_framework::format::FormatError>(())
//! ```

mod array;
mod atomic_file;
mod document;
mod error;
mod pvd;
mod values;
mod vti;
mod vtu;
mod xml;

pub use array::Array;
pub use atomic_file::AtomicFile;
pub(crate) use atomic_file::remove_abandoned;
pub use error::FormatError;
pub use pvd::Pvd;
pub use values::{Element, Kind, Values};
pub use vti::Vti;
pub use vtu::Vtu;
