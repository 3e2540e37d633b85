use std::io;
use std::path::PathBuf;

/// Why a picture could not be drawn or written.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// The file could not be written.
    #[error("cannot write `{}`", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The pixels could not be encoded.
    #[error("cannot encode `{}` as PNG", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// What the encoder says.
        source: png::EncodingError,
    },
    /// Something could not be drawn.
    #[error("cannot draw `{}`: {cause}", path.display())]
    Draw {
        /// The file.
        path: PathBuf,
        /// What the drawing library says.
        cause: String,
    },
    /// There is nothing to show.
    #[error("cannot draw `{}`: there is no point that can be shown ({why})", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// What could be shown.
        why: &'static str,
    },
    /// A grid has another number of values than points.
    #[error("cannot draw `{}`: a grid of {} x {} points has {values} values", path.display(), shape[0], shape[1])]
    Values {
        /// The file.
        path: PathBuf,
        /// Points in each direction.
        shape: [usize; 2],
        /// Values given.
        values: usize,
    },
    /// A length that must be positive is not.
    #[error("cannot draw `{}`: {what} is {value}; it must be positive and finite", path.display())]
    Length {
        /// The file.
        path: PathBuf,
        /// Which length.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// The picture is too small to be read or too large to be held.
    #[error(
        "cannot draw `{}`: {width} x {height} pixels; each side must have 300 to 10000",
        path.display()
    )]
    Size {
        /// The file.
        path: PathBuf,
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
}
