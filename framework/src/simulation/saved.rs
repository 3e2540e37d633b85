//! What a checkpoint holds of a simulation, and in which form.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Position, RestoreError};
use crate::checkpoint::{CheckpointError, CheckpointReader, CheckpointWriter, Header};
use crate::format::Values;

/// Version of the metadata: of [`Saved`] and all in it.
const VERSION: u32 = 2;

/// Metadata of a checkpoint.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Saved {
    pub position: Position,
    /// What somebody around the simulation wants to have back; empty for nothing.
    pub passenger: Vec<u8>,
}

/// [`Saved`] as bytes, so that another version is recognised before it is misread.
#[derive(Serialize, Deserialize)]
struct Envelope {
    version: u32,
    saved: Vec<u8>,
}

impl Saved {
    /// Writes a checkpoint with `blocks` of numbers.
    pub fn write<'a>(
        &self,
        path: &Path,
        header: &Header,
        blocks: impl Iterator<Item = (String, Values<'a>)>,
    ) -> Result<(), CheckpointError> {
        let saved = postcard::to_stdvec(self)
            .map_err(|source| CheckpointError::Metadata { path: path.to_path_buf(), source })?;
        let envelope = Envelope { version: VERSION, saved };
        let mut writer = CheckpointWriter::create(path, header, &envelope)?;
        for (name, values) in blocks {
            writer.add_block(&name, values)?;
        }
        writer.finish()
    }

    /// The metadata of the checkpoint `path`, which `reader` has opened.
    pub fn read(path: &Path, reader: &CheckpointReader) -> Result<Self, RestoreError> {
        let Envelope { version, saved } = reader.metadata()?;
        if version != VERSION {
            return Err(RestoreError::Version {
                path: path.to_path_buf(),
                found: version,
                supported: VERSION,
            });
        }
        let saved = postcard::from_bytes(&saved)
            .map_err(|source| CheckpointError::Metadata { path: path.to_path_buf(), source })?;
        Ok(saved)
    }
}

/// Name of the block that holds a column.
pub(crate) fn column_block(column: &str) -> String {
    format!("column {column}")
}
