use std::io;
use std::path::PathBuf;

use super::Kind;

/// Why a file for viewing could not be written.
#[derive(Debug, thiserror::Error)]
pub enum FormatError {
    /// The file itself could not be written.
    #[error("cannot write `{}`", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// The stream that the file is written to failed.
    #[error("cannot write the file's stream")]
    Stream {
        /// What the stream says.
        #[from]
        source: io::Error,
    },
    /// An array, or a component of it, has values for another number of points than the rest.
    #[error("array `{array}` has values for {found} points where {expected} are expected")]
    Length {
        /// Name of the array.
        array: String,
        /// How many points there are.
        expected: usize,
        /// How many points it has values for.
        found: usize,
    },
    /// The numbers of an interleaved vector cannot be grouped by three.
    #[error("vector array `{array}` has {found} numbers, which is not a multiple of 3")]
    Triples {
        /// Name of the array.
        array: String,
        /// How many numbers it has.
        found: usize,
    },
    /// The components of a vector are of different kinds.
    #[error("array `{array}` has components of kind {first} and of kind {other}")]
    Kind {
        /// Name of the array.
        array: String,
        /// Kind of the first component.
        first: Kind,
        /// The kind that differs.
        other: Kind,
    },
    /// The positions of points are not floating-point vectors.
    #[error("array `{array}` holds {components} {kind} per point; positions are 3 f32 or f64")]
    Positions {
        /// Name of the array.
        array: String,
        /// Numbers per point.
        components: usize,
        /// Their kind.
        kind: Kind,
    },
    /// Two arrays of one file have the same name, so that one would hide the other.
    #[error("two arrays are called `{array}`")]
    SameName {
        /// The name.
        array: String,
    },
    /// A name is empty or holds a character that XML cannot.
    #[error("{name:?} cannot be a name in the file: it is empty or has control characters")]
    Name {
        /// The name.
        name: String,
    },
    /// A number that describes the grid or the time makes no sense.
    #[error("`{key}` is {value}; it must be {must}")]
    Value {
        /// What the number is.
        key: &'static str,
        /// The number.
        value: f64,
        /// What would make sense.
        must: &'static str,
    },
}
