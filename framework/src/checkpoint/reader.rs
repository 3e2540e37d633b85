use std::path::Path;

use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::layout::{HeaderFrame, MAGIC, Record, VERSION};
use super::source::Source;
use super::{BlockInfo, CheckpointError, Header, Part};
use crate::format::Element;

/// Reads a checkpoint, after all of it was found sound.
#[derive(Debug)]
pub struct CheckpointReader {
    source: Source,
    header: Header,
    metadata: Vec<u8>,
    blocks: Vec<Place>,
}

/// A block and where its numbers begin in the file.
#[derive(Debug)]
struct Place {
    info: BlockInfo,
    position: u64,
}

impl CheckpointReader {
    /// Opens the checkpoint `path` and checks every byte of it.
    ///
    /// # Errors
    /// If the file cannot be read, is no checkpoint, is of another version, truncated or damaged.
    pub fn open(path: impl AsRef<Path>) -> Result<Self, CheckpointError> {
        let mut source = Source::open(path.as_ref())?;
        check_preamble(&mut source)?;
        let bytes = source.frame(&Part::Header)?;
        let header: HeaderFrame = decode(&source, &Part::Header, &bytes)?;
        let metadata = header.metadata.to_vec();
        let header = Header { method: header.method.into_owned(), scene_hash: header.scene_hash };
        let blocks = check_blocks(&mut source)?;
        if source.left() > 0 {
            return Err(CheckpointError::TrailingBytes {
                path: source.path().to_path_buf(),
                bytes: source.left(),
            });
        }
        Ok(Self { source, header, metadata, blocks })
    }

    /// What the checkpoint is of.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The blocks, in the order in which they were written.
    pub fn blocks(&self) -> impl Iterator<Item = &BlockInfo> {
        self.blocks.iter().map(|place| &place.info)
    }

    /// Makes sure that the checkpoint is of this method and this scene.
    ///
    /// # Errors
    /// If it is of another.
    pub fn require(&self, method: &str, scene_hash: u64) -> Result<(), CheckpointError> {
        self.require_method(method)?;
        if self.header.scene_hash != scene_hash {
            return Err(CheckpointError::WrongScene {
                path: self.source.path().to_path_buf(),
                expected: scene_hash,
                found: self.header.scene_hash,
            });
        }
        Ok(())
    }

    /// Makes sure that the checkpoint is of this method.
    ///
    /// # Errors
    /// If it is of another.
    pub fn require_method(&self, method: &str) -> Result<(), CheckpointError> {
        if self.header.method != method {
            return Err(CheckpointError::WrongMethod {
                path: self.source.path().to_path_buf(),
                expected: method.to_string(),
                found: self.header.method.clone(),
            });
        }
        Ok(())
    }

    /// The metadata, which must be of the type that was written: the file does not know the type,
    /// and another one is noticed only if its bytes do not fit.
    ///
    /// # Errors
    /// If the bytes do not fit the type.
    pub fn metadata<M: DeserializeOwned>(&self) -> Result<M, CheckpointError> {
        let metadata = match postcard::take_from_bytes(&self.metadata) {
            Ok((metadata, [])) => Ok(metadata),
            Ok(_) => Err(postcard::Error::DeserializeBadEncoding),
            Err(error) => Err(error),
        };
        metadata.map_err(|source| CheckpointError::Metadata {
            path: self.source.path().to_path_buf(),
            source,
        })
    }

    /// The numbers of the block `name`, to the bit.
    ///
    /// # Errors
    /// If there is no such block, if it holds another kind of numbers, or if the file changed since
    /// it was opened.
    pub fn read<T: Element>(&mut self, name: &str) -> Result<Vec<T>, CheckpointError> {
        let (part, position, count) = self.find::<T>(name)?;
        // The file, which is known to hold this many, fits a memory of the same size.
        let mut numbers = Vec::with_capacity(count as usize);
        self.stream(&part, position, count, |number| numbers.push(number))?;
        Ok(numbers)
    }

    /// Fills `numbers` with those of the block `name`, to the bit.
    ///
    /// # Errors
    /// If there is no such block, if it holds another kind or count of numbers, or if the file
    /// changed since it was opened; only then some of `numbers` may have been overwritten.
    pub fn read_into<T: Element>(
        &mut self,
        name: &str,
        numbers: &mut [T],
    ) -> Result<(), CheckpointError> {
        let (part, position, count) = self.find::<T>(name)?;
        if count != numbers.len() as u64 {
            return Err(CheckpointError::WrongCount {
                path: self.source.path().to_path_buf(),
                block: name.to_string(),
                expected: numbers.len(),
                found: count,
            });
        }
        let mut places = numbers.iter_mut();
        self.stream(&part, position, count, |number| {
            if let Some(place) = places.next() {
                *place = number;
            }
        })
    }

    /// Name, place and count of a block of numbers of type `T`.
    fn find<T: Element>(&self, name: &str) -> Result<(Part, u64, u64), CheckpointError> {
        let place = self.blocks.iter().find(|place| place.info.name == name);
        let place = place.ok_or_else(|| CheckpointError::MissingBlock {
            path: self.source.path().to_path_buf(),
            block: name.to_string(),
        })?;
        if place.info.kind != T::KIND {
            return Err(CheckpointError::WrongKind {
                path: self.source.path().to_path_buf(),
                block: name.to_string(),
                expected: T::KIND,
                found: place.info.kind,
            });
        }
        let name = name.to_string();
        Ok((Part::Block { name }, place.position, place.info.count))
    }

    fn stream<T: Element>(
        &mut self,
        part: &Part,
        position: u64,
        count: u64,
        mut take: impl FnMut(T),
    ) -> Result<(), CheckpointError> {
        let size = T::KIND.size();
        self.source.seek(position)?;
        self.source.stream(part, count * size as u64, |bytes| {
            bytes.chunks_exact(size).map(T::load).for_each(&mut take);
        })
    }
}

fn check_preamble(source: &mut Source) -> Result<(), CheckpointError> {
    let mut preamble = [0; MAGIC.len() + 4];
    let (magic, version) = preamble.split_at_mut(MAGIC.len());
    let not_a_checkpoint = CheckpointError::NotACheckpoint { path: source.path().to_path_buf() };
    if source.left() < MAGIC.len() as u64 {
        return Err(not_a_checkpoint);
    }
    source.fill(&Part::Preamble, magic)?;
    if magic != MAGIC {
        return Err(not_a_checkpoint);
    }
    source.fill(&Part::Preamble, version)?;
    let found = u32::load(version);
    // Before the checksum: another layout may have it elsewhere.
    if found != VERSION {
        return Err(CheckpointError::Version {
            path: source.path().to_path_buf(),
            found,
            supported: VERSION,
        });
    }
    source.checksum(&Part::Preamble, crc32fast::hash(&preamble))
}

/// Goes through the blocks to the mark of the end.
fn check_blocks(source: &mut Source) -> Result<Vec<Place>, CheckpointError> {
    let mut places: Vec<Place> = Vec::new();
    loop {
        let part = Part::Head { index: places.len() };
        let bytes = source.frame(&part)?;
        let malformed = |what: String| CheckpointError::Malformed {
            path: source.path().to_path_buf(),
            part: part.clone(),
            what,
        };
        let info = match decode(source, &part, &bytes)? {
            Record::Block(info) => info,
            Record::End { blocks } if blocks == places.len() as u64 => return Ok(places),
            Record::End { blocks } => {
                return Err(malformed(format!("says that there are {blocks} blocks")));
            }
        };
        let length = info.count.checked_mul(info.kind.size() as u64);
        let length = length.ok_or_else(|| malformed("has a count beyond all files".into()))?;
        let position = source.position();
        let name = info.name.clone();
        source.stream(&Part::Block { name }, length, |_| {})?;
        places.push(Place { info, position });
    }
}

fn decode<'a, T: Deserialize<'a>>(
    source: &Source,
    part: &Part,
    bytes: &'a [u8],
) -> Result<T, CheckpointError> {
    postcard::from_bytes(bytes).map_err(|error| CheckpointError::Malformed {
        path: source.path().to_path_buf(),
        part: part.clone(),
        what: format!("cannot be decoded: {error}"),
    })
}
