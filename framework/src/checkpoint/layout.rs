use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::format::Kind;

/// What every checkpoint begins with.
pub(super) const MAGIC: [u8; 8] = *b"FINEGRN\0";

/// The version of the layout that this program writes and reads.
pub(super) const VERSION: u32 = 1;

/// What a checkpoint is of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Header {
    /// Name of the method.
    pub method: String,
    /// Hash of all that the scene models: a checkpoint continues this scene only.
    pub scene_hash: u64,
}

/// A block of numbers in a checkpoint.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct BlockInfo {
    /// Its name.
    pub name: String,
    /// The type of its numbers.
    pub kind: Kind,
    /// How many numbers it holds.
    pub count: u64,
}

/// Contents of the first frame.
#[derive(Serialize, Deserialize)]
pub(super) struct HeaderFrame<'a> {
    #[serde(borrow)]
    pub(super) method: Cow<'a, str>,
    pub(super) scene_hash: u64,
    #[serde(borrow)]
    pub(super) metadata: &'a [u8],
}

/// Contents of every further frame.
#[derive(Serialize, Deserialize)]
pub(super) enum Record {
    /// The numbers of this block follow.
    Block(BlockInfo),
    /// Nothing follows.
    End { blocks: u64 },
}
