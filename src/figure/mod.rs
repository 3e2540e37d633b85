//! Figures: PNG pictures of a run's results, drawn without a system font or C library.
//!
//! | picture | of |
//! |---|---|
//! | [`Chart`] | lines with markers: time, speed-up or efficiency against the number of processors |
//! | [`Field`] | the value of a field at points or on a grid, coloured, with a colour bar |
//! | [`Tiles`] | rows of coloured tiles with a few words in each |
//!
//! # Example
//! ```
//! use finegrain::figure::{Axis, Chart, Scale};
//!
//! let folder = tempfile::tempdir()?;
//! Chart::new("Speed-up")
//!     .x(Axis::new("processors").scale(Scale::Log2))
//!     .y(Axis::new("speed-up").scale(Scale::Log2))
//!     .series("100 000 particles", [[1.0, 1.0], [2.0, 1.97], [4.0, 3.9]])
//!     .reference("ideal", [[1.0, 1.0], [4.0, 4.0]])
//!     .save(&folder.path().join("speed-up.png"))?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;
mod canvas;
mod chart;
mod error;
mod field;
mod frame;
mod marker;
mod nearest;
mod number;
mod outline;
mod ruler;
mod tiles;
mod viridis;

pub use axis::{Axis, Scale};
pub use chart::Chart;
pub use error::FigureError;
pub use field::{Field, Mark};
pub use outline::Outline;
pub(crate) use ruler::Ruler;
pub use tiles::{Tile, Tiles, Tone};
