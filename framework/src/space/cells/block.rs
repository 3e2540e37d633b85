//! A block of cells: the sub-domain, and how it finds its candidates.

use super::Cells;
use crate::domain::{Domain, Piece, Span, SubDomain};
use crate::real::Real;

/// A block of neighbouring cells; owns one span of particles.
pub struct CellBlock<'a, T> {
    cells: &'a Cells<T>,
    id: usize,
}

/// One existing cell of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Index among the existing cells.
    pub index: usize,
    /// Its particles.
    pub span: Span,
}

/// Consecutive particles that may interact with those of a cell, all seen through one image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// The sub-domain that owns them.
    pub owner: usize,
    /// The particles.
    pub span: Span,
    /// To be added to their positions: whole periods.
    pub shift: [f64; 3],
}

impl<'a, T: Real> CellBlock<'a, T> {
    pub(super) fn new(cells: &'a Cells<T>, id: usize) -> Self {
        Self { cells, id }
    }

    /// The domain.
    pub fn domain(&self) -> &'a Cells<T> {
        self.cells
    }

    /// Its existing cells, in order of their particles.
    pub fn cells(&self) -> impl Iterator<Item = Cell> + use<'a, T> {
        let cells = self.cells;
        let first = cells.blocks[self.id].1 as usize;
        (first..cells.cell_end(self.id)).map(move |index| Cell {
            index,
            span: Span {
                start: cells.first_point(index, cells.partition.points()),
                end: cells.first_point(index + 1, cells.partition.points()),
            },
        })
    }

    /// All particles that may lie within range of a particle of `cell`, the cell's own included,
    /// always in the same order: images plane by plane, row by row. A thin periodic box shows
    /// the same particles several times, with different shifts.
    pub fn candidates(&self, cell: Cell, runs: &mut Vec<Run>) {
        let at = self.cells.lattice.cell_sorted(self.cells.cells[cell.index].0);
        self.seen_from(at, at, runs);
    }

    /// All particles that may lie within range of any particle of the block, as
    /// [`CellBlock::candidates`] gives them for one of its cells: those of a cell are among them, in
    /// the same order.
    pub fn surroundings(&self, runs: &mut Vec<Run>) {
        let lattice = &self.cells.lattice;
        let block = lattice.block_at(self.cells.blocks[self.id].0);
        let first: [i64; 3] = std::array::from_fn(|a| block[a] * lattice.block[a]);
        let last =
            std::array::from_fn(|a| (first[a] + lattice.block[a]).min(lattice.counts[a]) - 1);
        self.seen_from(first, last, runs);
    }

    /// Particles of all cells within reach of those from `first` to `last`.
    fn seen_from(&self, first: [i64; 3], last: [i64; 3], runs: &mut Vec<Run>) {
        runs.clear();
        let cells = self.cells;
        let lattice = &cells.lattice;
        let points = cells.partition.points();
        let [xs, ys, zs] = std::array::from_fn(|a| {
            let reach = lattice.reach[a];
            first[a] - reach..=last[a] + reach
        });
        for k in zs {
            let Some((k, z)) = lattice.image(2, k) else {
                continue;
            };
            for j in ys.clone() {
                let Some((j, y)) = lattice.image(1, j) else {
                    continue;
                };
                for i in xs.clone() {
                    let Some((i, x)) = lattice.image(0, i) else {
                        continue;
                    };
                    let Some(index) = cells.cell_table.get(lattice.key([i, j, k])) else {
                        continue;
                    };
                    let block = lattice.block_key(lattice.block_of([i, j, k]));
                    let run = Run {
                        owner: cells
                            .block_table
                            .get(block)
                            .expect("an existing cell lies in an existing block"),
                        span: Span {
                            start: cells.first_point(index, points),
                            end: cells.first_point(index + 1, points),
                        },
                        shift: [x, y, z],
                    };
                    match runs.last_mut() {
                        Some(last)
                            if last.owner == run.owner
                                && last.span.end == run.span.start
                                && last.shift == run.shift =>
                        {
                            last.span.end = run.span.end;
                        }
                        _ => runs.push(run),
                    }
                }
            }
        }
    }
}

impl<T: Real> SubDomain for CellBlock<'_, T> {
    fn piece(&self) -> Piece<'_> {
        self.cells.partition().piece(self.id)
    }
}
