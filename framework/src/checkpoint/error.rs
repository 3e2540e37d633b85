use std::fmt;
use std::io;
use std::path::PathBuf;

use crate::format::Kind;

/// Why a checkpoint could not be written or read.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The file itself could not be written or read.
    #[error("cannot {attempt} checkpoint `{}`", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What was tried, a verb.
        attempt: &'static str,
        /// What the system says.
        source: io::Error,
    },
    /// The file does not begin as checkpoints do.
    #[error("`{}` is not a checkpoint", path.display())]
    NotACheckpoint {
        /// The file.
        path: PathBuf,
    },
    /// The file has another layout than this program knows, probably that of a later program.
    #[error(
        "checkpoint `{}` has layout version {found}; this program reads version {supported}",
        path.display()
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// Version of the file.
        found: u32,
        /// Version that this program reads.
        supported: u32,
    },
    /// The file ends too early.
    #[error(
        "checkpoint `{}` is truncated: {part} needs {expected} more bytes, {found} are left",
        path.display()
    )]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Where it ends.
        part: Part,
        /// Bytes that should follow.
        expected: u64,
        /// Bytes that do.
        found: u64,
    },
    /// Bytes are not those that were written.
    #[error(
        "checkpoint `{}` is damaged: {part} has checksum {found:08x}, not {expected:08x}",
        path.display()
    )]
    Checksum {
        /// The file.
        path: PathBuf,
        /// What is damaged.
        part: Part,
        /// Checksum that the file says.
        expected: u32,
        /// Checksum of the bytes in the file.
        found: u32,
    },
    /// Bytes are as they were written, but not by this program.
    #[error("checkpoint `{}` makes no sense: {part} {what}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What makes no sense.
        part: Part,
        /// In which way, a verb first.
        what: String,
    },
    /// Something follows the end.
    #[error("checkpoint `{}` has {bytes} bytes after its end", path.display())]
    TrailingBytes {
        /// The file.
        path: PathBuf,
        /// How many bytes too many.
        bytes: u64,
    },
    /// The checkpoint is of another method.
    #[error("checkpoint `{}` is of method `{found}`, not `{expected}`", path.display())]
    WrongMethod {
        /// The file.
        path: PathBuf,
        /// The method that was asked for.
        expected: String,
        /// The method of the file.
        found: String,
    },
    /// The checkpoint is of another scene.
    #[error(
        "checkpoint `{}` is of the scene with hash {found:016x}, not {expected:016x}",
        path.display()
    )]
    WrongScene {
        /// The file.
        path: PathBuf,
        /// The hash of the scene that was asked for.
        expected: u64,
        /// The hash of the scene of the file.
        found: u64,
    },
    /// The metadata cannot be turned into bytes or back, or is of another type.
    #[error("cannot convert the metadata of checkpoint `{}`", path.display())]
    Metadata {
        /// The file.
        path: PathBuf,
        /// What the conversion says.
        source: postcard::Error,
    },
    /// No block has this name.
    #[error("checkpoint `{}` has no block `{block}`", path.display())]
    MissingBlock {
        /// The file.
        path: PathBuf,
        /// Name of the block.
        block: String,
    },
    /// A second block of the same name was to be written.
    #[error("checkpoint `{}` already has a block `{block}`", path.display())]
    SameName {
        /// The file.
        path: PathBuf,
        /// Name of the block.
        block: String,
    },
    /// A block holds another kind of numbers than was asked for.
    #[error("block `{block}` of checkpoint `{}` holds {found}, not {expected}", path.display())]
    WrongKind {
        /// The file.
        path: PathBuf,
        /// Name of the block.
        block: String,
        /// The kind that was asked for.
        expected: Kind,
        /// The kind in the file.
        found: Kind,
    },
    /// A block holds another amount of numbers than was asked for.
    #[error(
        "block `{block}` of checkpoint `{}` holds {found} numbers, not {expected}",
        path.display()
    )]
    WrongCount {
        /// The file.
        path: PathBuf,
        /// Name of the block.
        block: String,
        /// How many were asked for.
        expected: usize,
        /// How many are in the file.
        found: u64,
    },
}

/// A part of a checkpoint.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Part {
    /// Magic bytes and version.
    Preamble,
    /// Method, scene hash and metadata.
    Header,
    /// What stands before the numbers of block `index`, counted from 0; or, after the last block,
    /// the mark of the end.
    Head {
        /// Number of the block.
        index: usize,
    },
    /// The numbers of a block.
    Block {
        /// Name of the block.
        name: String,
    },
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Preamble => f.write_str("the preamble"),
            Self::Header => f.write_str("the header"),
            Self::Head { index } => write!(f, "the head of block number {index}"),
            Self::Block { name } => write!(f, "block `{name}`"),
        }
    }
}
