use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use crc32fast::Hasher;

use super::{CheckpointError, Part};

/// Bytes of numbers that are read at a time, a multiple of the size of every kind.
const AT_ONCE: usize = 64 * 1024;

/// The file that a checkpoint is read from. Nothing is read that the file is too short for.
#[derive(Debug)]
pub(super) struct Source {
    path: PathBuf,
    file: BufReader<File>,
    length: u64,
    position: u64,
}

impl Source {
    pub(super) fn open(path: &Path) -> Result<Self, CheckpointError> {
        let opened = File::open(path).and_then(|file| {
            let length = file.metadata()?.len();
            Ok(Self { path: path.to_path_buf(), file: BufReader::new(file), length, position: 0 })
        });
        opened.map_err(|source| cannot_read(path, source))
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Where the next read begins.
    pub(super) fn position(&self) -> u64 {
        self.position
    }

    /// How many bytes are behind that.
    pub(super) fn left(&self) -> u64 {
        self.length.saturating_sub(self.position)
    }

    pub(super) fn seek(&mut self, position: u64) -> Result<(), CheckpointError> {
        self.position = position;
        let sought = self.file.seek(SeekFrom::Start(position));
        sought.map(drop).map_err(|source| cannot_read(&self.path, source))
    }

    /// A frame: its length is checked before it is believed.
    pub(super) fn frame(&mut self, part: &Part) -> Result<Vec<u8>, CheckpointError> {
        let mut length = [0; 8];
        self.checked(part, &mut length)?;
        let length = u64::from_le_bytes(length);
        self.require(part, length)?;
        let length = usize::try_from(length).map_err(|_| CheckpointError::Malformed {
            path: self.path.clone(),
            part: part.clone(),
            what: format!("has {length} bytes, more than memory can hold"),
        })?;
        let mut bytes = vec![0; length];
        self.checked(part, &mut bytes)?;
        Ok(bytes)
    }

    /// Fills `bytes`, which their checksum follows.
    pub(super) fn checked(&mut self, part: &Part, bytes: &mut [u8]) -> Result<(), CheckpointError> {
        self.fill(part, bytes)?;
        self.checksum(part, crc32fast::hash(bytes))
    }

    /// Gives `length` bytes to `take`, whole numbers at a time, and checks the checksum that
    /// follows.
    pub(super) fn stream(
        &mut self,
        part: &Part,
        length: u64,
        mut take: impl FnMut(&[u8]),
    ) -> Result<(), CheckpointError> {
        self.require(part, length)?;
        let mut buffer = vec![0; AT_ONCE];
        let mut hasher = Hasher::new();
        let mut left = length;
        while left > 0 {
            let some = left.min(AT_ONCE as u64);
            let bytes = &mut buffer[..some as usize];
            self.fill(part, bytes)?;
            hasher.update(bytes);
            take(bytes);
            left -= some;
        }
        self.checksum(part, hasher.finalize())
    }

    /// Fills `bytes`.
    pub(super) fn fill(&mut self, part: &Part, bytes: &mut [u8]) -> Result<(), CheckpointError> {
        self.require(part, bytes.len() as u64)?;
        self.file.read_exact(bytes).map_err(|source| cannot_read(&self.path, source))?;
        self.position += bytes.len() as u64;
        Ok(())
    }

    /// Compares `found` with the checksum that follows.
    pub(super) fn checksum(&mut self, part: &Part, found: u32) -> Result<(), CheckpointError> {
        let mut expected = [0; 4];
        self.fill(part, &mut expected)?;
        let expected = u32::from_le_bytes(expected);
        if expected == found {
            return Ok(());
        }
        Err(CheckpointError::Checksum {
            path: self.path.clone(),
            part: part.clone(),
            expected,
            found,
        })
    }

    fn require(&self, part: &Part, expected: u64) -> Result<(), CheckpointError> {
        if expected <= self.left() {
            return Ok(());
        }
        Err(CheckpointError::Truncated {
            path: self.path.clone(),
            part: part.clone(),
            expected,
            found: self.left(),
        })
    }
}

fn cannot_read(path: &Path, source: io::Error) -> CheckpointError {
    CheckpointError::File { path: path.to_path_buf(), attempt: "read", source }
}
