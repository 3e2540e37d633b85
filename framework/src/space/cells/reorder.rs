//! Columns in the order of the sorted particles.

use super::Cells;
use super::sort::Sorter;
use crate::columns::Columns;
use crate::memory::Line;
use crate::real::Real;
use crate::team::Team;

impl<T: Real> Cells<T> {
    /// Brings all kept columns into the order that the sorter has found.
    pub(super) fn reorder(&mut self, columns: &mut Columns, team: &mut Team) {
        for id in columns.ids() {
            let column = columns.column(id);
            if !column.is_kept() {
                continue;
            }
            self.spare.resize(columns.lines(id));
            let from = columns.bytes(id);
            let sorter = &self.sorter;
            let to: &mut [u8] = bytemuck::cast_slice_mut::<Line, u8>(&mut self.spare);
            let to = &mut to[..from.len()];
            match column.kind().size() {
                8 => gather::<u64>(team, sorter, from, to),
                4 => gather::<u32>(team, sorter, from, to),
                _ => gather::<u8>(team, sorter, from, to),
            }
            columns.exchange_lines(id, &mut self.spare);
        }
    }
}

fn gather<U: bytemuck::Pod + Send + Sync>(
    team: &mut Team,
    sorter: &Sorter,
    from: &[u8],
    to: &mut [u8],
) {
    const CHUNK: usize = 16_384;
    let from: &[U] = bytemuck::cast_slice(from);
    team.for_each_chunk(bytemuck::cast_slice_mut::<u8, U>(to), CHUNK, |k, chunk| {
        for (i, x) in chunk.iter_mut().enumerate() {
            *x = from[sorter.source(k * CHUNK + i)];
        }
    });
}
