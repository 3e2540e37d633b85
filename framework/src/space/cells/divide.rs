//! Cells, blocks and the partition, from sorted particles.

use super::Cells;
use crate::domain::Span;
use crate::real::Real;

impl<T: Real> Cells<T> {
    /// Makes cells, blocks and partition from the sorted keys.
    pub(super) fn divide(&mut self, points: usize) {
        let lattice = &self.lattice;
        self.cells.clear();
        for (i, key) in self.sorter.keys().enumerate() {
            if self.cells.last().is_none_or(|&(last, _)| last != key) {
                self.cells.push((key, i as u32));
            }
        }
        self.cell_table
            .fill(self.cells.iter().map(|&(key, _)| lattice.key(lattice.cell_sorted(key))));
        let volume = lattice.block.iter().product::<i64>() as u64;
        self.blocks.clear();
        for (c, &(key, _)) in self.cells.iter().enumerate() {
            let block = key / volume;
            if self.blocks.last().is_none_or(|&(last, _)| last != block) {
                self.blocks.push((block, c as u32));
            }
        }
        self.block_table.fill(self.blocks.iter().map(|&(key, _)| key));
        self.partition.clear(points);
        for (id, &(key, _)) in self.blocks.iter().enumerate() {
            let at = lattice.block_at(key);
            for (a, near) in self.near_axes.iter_mut().enumerate() {
                lattice.near_blocks(a, at[a], near);
            }
            self.near_blocks.clear();
            let [xs, ys, zs] = &self.near_axes;
            for &k in zs {
                for &j in ys {
                    for &i in xs {
                        let key = lattice.block_key([i, j, k]);
                        self.near_blocks.extend(self.block_table.get(key).map(|b| b as u32));
                    }
                }
            }
            self.near_blocks.retain(|&b| b as usize != id);
            self.near_blocks.sort_unstable();
            let span = Span {
                start: self.first_point(self.blocks[id].1 as usize, points),
                end: self.first_point(self.cell_end(id), points),
            };
            self.partition.push([span], self.near_blocks.iter().copied());
        }
        self.partition
            .seal()
            .expect("sorted blocks own consecutive spans and see each other mutually");
    }

    /// One past the last cell of a block.
    pub(super) fn cell_end(&self, block: usize) -> usize {
        self.blocks.get(block + 1).map_or(self.cells.len(), |&(_, first)| first as usize)
    }

    /// First particle of a cell; past the last cell, the number of particles.
    pub(super) fn first_point(&self, cell: usize, points: usize) -> usize {
        self.cells.get(cell).map_or(points, |&(_, first)| first as usize)
    }
}
