//! A copy of some columns at one step, on its way to a file.

use crate::columns::{ColumnId, Columns, ElementKind, values_of};
use crate::format::Values;

/// Copies of columns; the memory is used again and again.
#[derive(Debug, Default)]
pub(super) struct Snapshot {
    pub step: u64,
    pub time: f64,
    points: usize,
    copies: Vec<ColumnCopy>,
}

/// Words, so that any element type is aligned in them.
#[derive(Debug)]
struct ColumnCopy {
    kind: ElementKind,
    words: Vec<u64>,
}

impl Snapshot {
    /// Copies the columns `ids`.
    pub fn take(&mut self, step: u64, time: f64, columns: &Columns, ids: &[ColumnId]) {
        (self.step, self.time, self.points) = (step, time, columns.points());
        while self.copies.len() < ids.len() {
            self.copies.push(ColumnCopy { kind: ElementKind::F64, words: Vec::new() });
        }
        for (copy, &id) in self.copies.iter_mut().zip(ids) {
            let bytes = columns.bytes(id);
            copy.kind = columns.column(id).kind();
            copy.words.resize(bytes.len().div_ceil(size_of::<u64>()), 0);
            let to: &mut [u8] = bytemuck::cast_slice_mut(&mut copy.words);
            to[..bytes.len()].copy_from_slice(bytes);
        }
    }

    /// The copy of the column that was given at place `place`.
    pub fn values(&self, place: usize) -> Values<'_> {
        let ColumnCopy { kind, words } = &self.copies[place];
        values_of(*kind, words, self.points)
    }
}
