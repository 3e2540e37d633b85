//! The container of a checkpoint: what a run needs to go on with the same bits.
//!
//! It holds what the checkpoint is of ([`Header`]), metadata of any serializable type, and named
//! blocks of numbers. A [`CheckpointWriter`] makes the file appear under its name only when it is
//! complete; a [`CheckpointReader`] checks all of it before it gives anything out.
//!
//! # Layout
//! Numbers are little-endian; checksums are CRC-32.
//!
//! | part | bytes |
//! |---|---|
//! | preamble | `FINEGRN\0`, version of this layout (`u32`), checksum of both |
//! | header | frame of method, scene hash and metadata |
//! | each block | frame of name, kind and count; then the numbers; then their checksum |
//! | end | frame that says how many blocks there were; nothing follows |
//!
//! A *frame* is a length (`u64`), the checksum of the length, that many bytes (postcard), and their
//! checksum: a length is trusted only after it was checked, so no damage to a file can make its
//! reader ask for absurd amounts of memory.
//!
//! # Example
//! ```
//! use finegrain_framework::checkpoint::{CheckpointReader, CheckpointWriter, Header};
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("step7.ckpt");
//! let header = Header { method: "sph".into(), scene_hash: 0x5ce7e };
//! let density = vec![1000.0_f64, 998.5, 1001.25];
//! let mut writer = CheckpointWriter::create(&path, &header, &(7_u64, 0.35_f64))?;
//! writer.add_block("density", &density)?;
//! writer.finish()?;
//!
//! let mut reader = CheckpointReader::open(&path)?;
//! reader.require("sph", 0x5ce7e)?;
//! let (step, time): (u64, f64) = reader.metadata()?;
//! assert_eq!((step, time), (7, 0.35));
//! assert_eq!(reader.read::<f64>("density")?, density);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod error;
mod layout;
mod reader;
mod source;
mod writer;

pub use error::{CheckpointError, Part};
pub use layout::{BlockInfo, Header};
pub use reader::CheckpointReader;
pub use writer::CheckpointWriter;
