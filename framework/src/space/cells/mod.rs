//! Cells: a sparse spatial hash for particles (Holmes et al. 2011, section 4.4).
//!
//! The cells that find neighbours in O(N) are also what sub-domains are made of: blocks of cells,
//! sized so that a task is worth its hand-out. Particles are kept sorted by block and cell; a
//! block owns one span. Periodic images are seen by shifting what is read; there are no ghosts.
//!
//! Cells have a side of at least interaction range plus *skin*, so that particles need not be
//! sorted anew every step: as long as none has moved by more than half a skin since the last
//! sort, two particles within range lie in cells that see each other. That is checked before
//! every rate stage; a run past it ends with an error, never with a missed neighbour.

mod block;
mod divide;
mod fit;
mod lattice;
mod region;
mod reorder;
mod sort;
mod table;

pub use block::{Cell, CellBlock, Run};
pub use region::Region;

use crate::columns::{Columns, Handle, State};
use crate::domain::{Domain, Partition};
use crate::memory::{Line, Memory};
use crate::real::Real;
use crate::stage::Fault;
use crate::team::Team;
use crate::view::Near;
use crate::viewable::{Geometry, Viewable};
use lattice::Lattice;
use sort::Sorter;
use table::KeyTable;

/// Describes [`Cells`].
#[derive(Clone, Debug)]
pub struct CellsOptions {
    /// Where particles live; its dimension is the domain's.
    pub region: Region,
    /// Largest distance at which two particles interact.
    pub range: f64,
    /// How much further cells see, to sort less often; in the unit of `range`.
    pub skin: f64,
    /// A block inside what is filled has about so many particles.
    pub block_points: usize,
}

/// Particles in cells; see the [module](self).
#[derive(Debug)]
pub struct Cells<T> {
    region: Region,
    range: f64,
    skin: f64,
    block_points: usize,
    positions: Vec<State<T>>,
    /// Where particles were when they were last sorted.
    sorted_at: Vec<State<T>>,
    lattice: Lattice,
    /// Sort keys of existing cells, ascending, and the first particle of each.
    cells: Vec<(u64, u32)>,
    cell_table: KeyTable,
    /// Block keys of existing blocks, ascending, and the first cell of each.
    blocks: Vec<(u64, u32)>,
    block_table: KeyTable,
    partition: Partition,
    sorter: Sorter,
    spare: Memory,
    near_axes: [Vec<i64>; 3],
    near_blocks: Vec<u32>,
}

impl<T: Real> Cells<T> {
    /// Cells for particles whose positions are in `positions`, one column a dimension.
    ///
    /// Call [`Cells::sort`] when the positions are set.
    ///
    /// # Errors
    /// If the range or the box makes no sense; the message names the value.
    pub fn new(
        columns: &mut Columns,
        positions: &[State<T>],
        options: CellsOptions,
    ) -> Result<Self, Fault> {
        let CellsOptions { region, range, skin, block_points } = options;
        let dims = region.lower.len();
        if !(1..=3).contains(&dims)
            || [region.upper.len(), region.periodic.len(), positions.len()] != [dims; 3]
        {
            return Err(Fault::new(format!(
                "cells need 1 to 3 dimensions, the same for the box ({dims}) and the positions ({})",
                positions.len()
            )));
        }
        if !(range > 0.0 && range.is_finite() && skin >= 0.0 && skin.is_finite()) {
            return Err(Fault::new(format!(
                "interaction range {range} and skin {skin} must be finite, positive and not negative"
            )));
        }
        for a in 0..dims {
            let (lower, upper) = (region.lower[a], region.upper[a]);
            if !(upper > lower && lower.is_finite() && upper.is_finite()) {
                return Err(Fault::new(format!(
                    "box from {lower} to {upper} in direction {a}: the upper end must be larger"
                )));
            }
        }
        let sorted_at = (0..dims)
            .map(|a| columns.state(&format!("sorted_at_{}", ["x", "y", "z"][a])))
            .collect();
        Ok(Self {
            lattice: Lattice::new([0.0; 3], [1.0; 3], [false; 3], 0, range),
            region,
            range,
            skin,
            block_points,
            positions: positions.to_vec(),
            sorted_at,
            cells: Vec::new(),
            cell_table: KeyTable::default(),
            blocks: Vec::new(),
            block_table: KeyTable::default(),
            partition: Partition::new(0),
            sorter: Sorter::default(),
            spare: Memory::new(0, 0),
            near_axes: Default::default(),
            near_blocks: Vec::new(),
        })
    }

    /// Number of dimensions.
    pub fn dims(&self) -> usize {
        self.positions.len()
    }

    /// The columns that hold the positions.
    pub fn positions(&self) -> &[State<T>] {
        &self.positions
    }

    /// Where particles live.
    pub fn region(&self) -> &Region {
        &self.region
    }

    /// Largest distance of interaction.
    pub fn range(&self) -> f64 {
        self.range
    }

    /// How far particles may move between sorts: half the skin.
    pub fn slack(&self) -> f64 {
        0.5 * self.skin
    }

    /// Bytes held besides the columns.
    pub fn memory(&self) -> usize {
        (self.cells.capacity() + self.blocks.capacity()) * size_of::<(u64, u32)>()
            + self.cell_table.memory()
            + self.block_table.memory()
            + self.partition.memory()
            + self.sorter.memory()
            + self.spare.capacity() * size_of::<Line>()
    }

    /// Wraps positions into the box, sorts all kept columns by cell and divides space anew.
    ///
    /// A whole-domain stage: internally parallel, stable, the same for any number of workers.
    ///
    /// # Errors
    /// If a position is not finite; names the particle's place in the columns.
    pub fn sort(&mut self, columns: &mut Columns, team: &mut Team) -> Result<(), Fault> {
        self.region.wrap(columns, &self.positions, team)?;
        self.lattice = self.fit(columns, team);
        let dims = self.dims();
        let lattice = &self.lattice;
        let at = values_of(columns, &self.positions);
        let moved = self.sorter.sort(team, columns.points(), lattice.sort_keys(), |i| {
            lattice.sort_key(lattice.coordinates(position(&at[..dims], i)))
        });
        if moved {
            self.reorder(columns, team);
        }
        for (&to, &from) in self.sorted_at.iter().zip(&self.positions) {
            columns.copy(from.id(), to.id());
        }
        self.divide(columns.points());
        Ok(())
    }
}

/// The values of up to three columns.
fn values_of<'a, T: Real>(columns: &'a Columns, of: &[State<T>]) -> [&'a [T]; 3] {
    std::array::from_fn(|a| of.get(a).map_or(&[][..], |&column| columns.values(column)))
}

/// Position number `i`, zero in directions that do not exist.
#[inline]
fn position<T: Real>(at: &[&[T]], i: usize) -> [f64; 3] {
    let mut x = [0.0; 3];
    for (x, at) in x.iter_mut().zip(at) {
        *x = at[i].as_f64();
    }
    x
}

impl<T: Real> Domain for Cells<T> {
    type SubDomain<'a> = CellBlock<'a, T>;

    fn partition(&self) -> &Partition {
        &self.partition
    }

    fn sub_domain(&self, id: usize) -> CellBlock<'_, T> {
        CellBlock::new(self, id)
    }

    fn check(&self, near: &Near<'_, Self>) -> Result<(), Fault> {
        let own = |column: Option<&State<T>>| match column {
            Some(&column) => near.state(column).own().whole(),
            None => &[],
        };
        let now: [_; 3] = std::array::from_fn(|a| own(self.positions.get(a)));
        let then: [_; 3] = std::array::from_fn(|a| own(self.sorted_at.get(a)));
        let dims = self.dims();
        let mut worst = (0.0, 0);
        for i in 0..now[0].len() {
            let squares = (0..dims).map(|a| {
                let d = (now[a][i] - then[a][i]).as_f64();
                d * d
            });
            let moved: f64 = squares.sum();
            if moved > worst.0 || moved.is_nan() {
                worst = (moved, i);
            }
        }
        let slack = self.slack();
        if worst.0 <= slack * slack {
            return Ok(());
        }
        Err(Fault::new(format!(
            "the particle at place {} has moved by {:.3e} since it was last sorted into its cell, more than half the \
             skin, {:.3e}: the time step is past stability, or the skin too thin",
            near.spans()[0].start + worst.1,
            f64::sqrt(worst.0),
            slack
        )))
    }

    fn save(&self) -> Vec<u64> {
        let l = &self.lattice;
        let floats = [l.lower, l.side, l.period];
        let integers = [l.counts, l.reach, l.block];
        let floats = floats.iter().flatten().map(|x| x.to_bits());
        floats.chain(integers.iter().flatten().map(|&i| i as u64)).collect()
    }

    fn restore(&mut self, saved: &[u64], columns: &Columns) -> Result<(), Fault> {
        let wrong = || Fault::new("the checkpoint's cells do not fit its particles");
        let numbers: &[u64; 18] = saved.try_into().map_err(|_| wrong())?;
        let floats = |k: usize| std::array::from_fn(|a| f64::from_bits(numbers[3 * k + a]));
        let integers = |k: usize| std::array::from_fn(|a| numbers[3 * k + a] as i64);
        let lattice = Lattice {
            lower: floats(0),
            side: floats(1),
            period: floats(2),
            counts: integers(3),
            reach: integers(4),
            block: integers(5),
        };
        if lattice.counts.iter().chain(&lattice.block).any(|&n| !(1..=1_000_000).contains(&n)) {
            return Err(wrong());
        }
        // The particles are in order already, and their cells are those of the last sort.
        let (at, dims) = (values_of(columns, &self.sorted_at), self.dims());
        let mut alone = Team::new(1).map_err(|e| Fault::new(e.to_string()))?;
        let moved = self.sorter.sort(&mut alone, columns.points(), lattice.sort_keys(), |i| {
            lattice.sort_key(lattice.coordinates(position(&at[..dims], i)))
        });
        if moved {
            return Err(wrong());
        }
        self.lattice = lattice;
        self.divide(columns.points());
        Ok(())
    }
}

impl<T: Real> Viewable for Cells<T> {
    fn geometry(&self) -> Geometry {
        Geometry::Points(self.positions.iter().map(|position| position.id()).collect())
    }
}
