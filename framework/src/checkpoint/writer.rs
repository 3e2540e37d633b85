use std::borrow::Cow;
use std::collections::HashSet;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crc32fast::Hasher;
use serde::Serialize;

use super::layout::{HeaderFrame, MAGIC, Record, VERSION};
use super::{BlockInfo, CheckpointError, Header};
use crate::format::{AtomicFile, Values};

/// Writes a checkpoint, which appears under its name when it is finished.
///
/// Dropped before that, it leaves what stood under the name before.
#[derive(Debug)]
pub struct CheckpointWriter {
    path: PathBuf,
    file: AtomicFile,
    names: HashSet<String>,
}

impl CheckpointWriter {
    /// Begins the checkpoint `path`, whose folder must exist, with `metadata` of any type.
    ///
    /// # Errors
    /// If the file cannot be created or written, or if the metadata cannot be serialized.
    pub fn create(
        path: impl AsRef<Path>,
        header: &Header,
        metadata: &impl Serialize,
    ) -> Result<Self, CheckpointError> {
        let path = path.as_ref().to_path_buf();
        let metadata = encode(&path, metadata)?;
        let header = HeaderFrame {
            method: Cow::Borrowed(&header.method),
            scene_hash: header.scene_hash,
            metadata: &metadata,
        };
        let header = encode(&path, &header)?;
        let file = AtomicFile::create(&path).map_err(|source| cannot_write(&path, source))?;
        let mut writer = Self { path, file, names: HashSet::new() };
        writer.write(|file| {
            let mut preamble = MAGIC.to_vec();
            preamble.extend(VERSION.to_le_bytes());
            write_checked(file, &preamble)?;
            write_frame(file, &header)
        })?;
        Ok(writer)
    }

    /// Writes `values`, to the bit, as the block `name`.
    ///
    /// # Errors
    /// If there is a block of this name, or if the file cannot be written.
    pub fn add_block<'a>(
        &mut self,
        name: &str,
        values: impl Into<Values<'a>>,
    ) -> Result<(), CheckpointError> {
        let values = values.into();
        if !self.names.insert(name.to_string()) {
            return Err(CheckpointError::SameName {
                path: self.path.clone(),
                block: name.to_string(),
            });
        }
        let record = Record::Block(BlockInfo {
            name: name.to_string(),
            kind: values.kind(),
            count: values.len() as u64,
        });
        let record = encode(&self.path, &record)?;
        self.write(|file| {
            write_frame(file, &record)?;
            let mut hashing = Hashing { out: file, hasher: Hasher::new() };
            values.write_le(&mut hashing)?;
            let checksum = hashing.hasher.finalize();
            file.write_all(&checksum.to_le_bytes())
        })
    }

    /// Makes the checkpoint durable and gives it its name, replacing an older one at once.
    ///
    /// # Errors
    /// If the file cannot be written, now or when a block was added; then what stood under the name
    /// is still there.
    pub fn finish(mut self) -> Result<(), CheckpointError> {
        let blocks = self.names.len() as u64;
        let end = encode(&self.path, &Record::End { blocks })?;
        self.write(|file| write_frame(file, &end))?;
        self.file.commit().map_err(|source| cannot_write(&self.path, source))
    }

    fn write(
        &mut self,
        write: impl FnOnce(&mut AtomicFile) -> io::Result<()>,
    ) -> Result<(), CheckpointError> {
        write(&mut self.file).map_err(|source| cannot_write(&self.path, source))
    }
}

fn encode(path: &Path, value: &impl Serialize) -> Result<Vec<u8>, CheckpointError> {
    postcard::to_stdvec(value)
        .map_err(|source| CheckpointError::Metadata { path: path.to_path_buf(), source })
}

fn cannot_write(path: &Path, source: io::Error) -> CheckpointError {
    CheckpointError::File { path: path.to_path_buf(), attempt: "write", source }
}

fn write_frame(out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    write_checked(out, &(bytes.len() as u64).to_le_bytes())?;
    write_checked(out, bytes)
}

fn write_checked(out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    out.write_all(bytes)?;
    out.write_all(&crc32fast::hash(bytes).to_le_bytes())
}

/// Passes bytes on and takes their checksum.
struct Hashing<'a, W> {
    out: &'a mut W,
    hasher: Hasher,
}

impl<W: Write> Write for Hashing<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
