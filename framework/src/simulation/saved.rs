//! What a checkpoint holds of a simulation, and in which form.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Position, RestoreError};
use crate::checkpoint::{CheckpointError, CheckpointReader, CheckpointWriter, Header};
use crate::format::Values;

/// Version of the metadata: of [`Saved`] and all in it.
const VERSION: u32 = 3;

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

#[cfg(all(test, not(loom)))]
mod tests {
    use super::*;
    use crate::columns::Columns;
    use crate::simulation::{Model, Settings, Simulation};
    use crate::space::Independent;
    use crate::step::Step;

    /// A simulation with the columns `a` and `b` of four points.
    fn simulation() -> Simulation<Independent> {
        let mut columns = Columns::new(4);
        for name in ["a", "b"] {
            let column = columns.state::<f64>(name);
            columns.values_mut(column).fill(1.0);
        }
        let (domain, step) = (Independent::with_share(4, 2), Step::builder().build());
        let model = Model::with_fixed_dt("test", domain, columns, step, 0.1);
        let settings = Settings { workers: 1, ..Settings::default() };
        Simulation::new(model, settings).unwrap()
    }

    fn header() -> Header {
        Header { method: "test".to_owned(), scene_hash: 7 }
    }

    #[test]
    fn run_state_of_another_version() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.ckpt");
        let envelope = Envelope { version: VERSION + 1, saved: vec![1, 2, 3] };
        CheckpointWriter::create(&path, &header(), &envelope).unwrap().finish().unwrap();
        let error = simulation().restore(&path, 7).unwrap_err();
        assert!(matches!(error, RestoreError::Version { found, supported, .. }
                if (found, supported) == (VERSION + 1, VERSION)));
    }

    /// The first column would fit, and must not be taken.
    #[test]
    fn a_column_of_another_length_leaves_the_simulation_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.ckpt");
        let mut simulation = simulation();
        let saved = Saved { position: simulation.position(), passenger: Vec::new() };
        let (a, b) = (vec![2.0; 4], vec![2.0; 3]);
        let blocks = [("a", Values::from(&a[..])), ("b", Values::from(&b[..]))];
        let blocks = blocks.map(|(name, values)| (column_block(name), values));
        saved.write(&path, &header(), blocks.into_iter()).unwrap();
        let before = simulation.state_hash();
        let error = simulation.restore(&path, 7).unwrap_err();
        assert!(
            matches!(&error, RestoreError::Checkpoint(CheckpointError::WrongCount { block, .. })
                if block == "column b"),
            "{error}"
        );
        assert_eq!(simulation.state_hash(), before);
    }
}
