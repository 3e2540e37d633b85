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
mod lattice;
mod sort;
mod table;

pub use block::{Cell, CellBlock, Run};

use bytemuck::Zeroable;

use crate::columns::{Columns, ElementKind, Handle, Line, State};
use crate::domain::{Domain, Partition, Span};
use crate::real::Real;
use crate::stage::Fault;
use crate::team::Team;
use crate::view::Near;
use crate::viewable::{Geometry, Viewable};
use lattice::Lattice;
use sort::Sorter;
use table::KeyTable;

/// The box that particles live in.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    /// Lower corner, one number a dimension.
    pub lower: Vec<f64>,
    /// Upper corner.
    pub upper: Vec<f64>,
    /// Which directions are periodic. In the others particles may go anywhere; the box there
    /// follows them.
    pub periodic: Vec<bool>,
}

/// Describes [`Cells`].
#[derive(Clone, Debug)]
pub struct CellsOptions {
    /// Where particles live; its dimension is the domain's.
    pub region: Region,
    /// Largest distance at which two particles interact.
    pub range: f64,
    /// How much further cells see, to sort less often; in the unit of `range`.
    pub skin: f64,
    /// A block has at least about so many particles.
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
    spare: Vec<Line>,
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
            spare: Vec::new(),
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
    /// If a position is not finite; names the particle.
    pub fn sort(&mut self, columns: &mut Columns, team: &mut Team) -> Result<(), Fault> {
        self.wrap(columns, team)?;
        self.lattice = self.fit(columns);
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
            copy_column(columns, from, to);
        }
        self.divide(columns.points());
        Ok(())
    }

    fn wrap(&self, columns: &mut Columns, team: &mut Team) -> Result<(), Fault> {
        for (a, &column) in self.positions.iter().enumerate() {
            let values = columns.values_mut(column);
            if let Some(i) = values.iter().position(|x| !x.is_finite()) {
                return Err(Fault::new(format!(
                    "particle {i} has coordinate {} in direction {a}, which is not finite",
                    values[i]
                )));
            }
            if !self.region.periodic[a] {
                continue;
            }
            let (lower, upper) = (self.region.lower[a], self.region.upper[a]);
            let length = upper - lower;
            let first = first_inside(lower);
            team.for_each_chunk(values, 16_384, |_, chunk| {
                for value in chunk {
                    let x = value.as_f64();
                    if !(lower..upper).contains(&x) {
                        let wrapped = x - ((x - lower) / length).floor() * length;
                        // Rounding may lead to the upper end, which is the lower end.
                        let wrapped = T::of(wrapped);
                        let is_inside = (lower..upper).contains(&wrapped.as_f64());
                        *value = if is_inside { wrapped } else { first };
                    }
                }
            });
        }
        Ok(())
    }

    /// The lattice for the present positions.
    fn fit(&self, columns: &Columns) -> Lattice {
        let dims = self.dims();
        let (mut lower, mut length, mut periodic) = ([0.0; 3], [1.0; 3], [false; 3]);
        for a in 0..dims {
            periodic[a] = self.region.periodic[a];
            let (mut low, mut high) = (self.region.lower[a], self.region.upper[a]);
            if !periodic[a] {
                let values = columns.values(self.positions[a]);
                let (least, most) = values
                    .iter()
                    .fold((T::infinity(), T::neg_infinity()), |m, &x| (m.0.min(x), m.1.max(x)));
                if !values.is_empty() {
                    (low, high) = (least.as_f64(), most.as_f64());
                }
            }
            lower[a] = low;
            length[a] = high - low;
        }
        // Positions are put into cells with a rounding error, which must not part two particles
        // that are exactly the range away from one another.
        let size = (0..dims).map(|a| lower[a].abs() + length[a]).fold(0.0, f64::max);
        let range = self.range + self.skin;
        let range = range + (8.0 * f64::EPSILON * size).min(range);
        let mut lattice = Lattice::new(lower, length, periodic, dims, range);
        // Particles a cell holds where there are any: judged from the whole box, which is an
        // underestimate for a sparse one; blocks are then a little large.
        let cells: f64 = lattice.counts.iter().map(|&n| n as f64).product();
        let per_cell = (columns.points() as f64 / cells).max(1.0);
        // As long in every direction as can be, where there are few cells first: what is missing
        // there, the other directions make up for.
        let mut wanted = self.block_points as f64 / per_cell;
        let mut axes = [0, 1, 2];
        axes[..dims].sort_unstable_by_key(|&a| lattice.counts[a]);
        for (&a, left) in axes[..dims].iter().zip((1..=dims).rev()) {
            let edge = wanted.max(1.0).powf(1.0 / left as f64).round() as i64;
            lattice.block[a] = edge.min(lattice.counts[a]);
            wanted /= lattice.block[a] as f64;
        }
        lattice
    }

    fn reorder(&mut self, columns: &mut Columns, team: &mut Team) {
        for id in columns.ids() {
            let column = columns.column(id);
            let kind = column.kind();
            if !column.is_kept() {
                continue;
            }
            self.spare.resize(columns.lines(id), Line::zeroed());
            let from = columns.bytes(id);
            let sorter = &self.sorter;
            let to: &mut [u8] = bytemuck::cast_slice_mut(&mut self.spare);
            let to = &mut to[..from.len()];
            match kind.size() {
                8 => gather::<u64>(team, sorter, from, to),
                4 => gather::<u32>(team, sorter, from, to),
                _ => gather::<u8>(team, sorter, from, to),
            }
            debug_assert!(kind != ElementKind::U8 || kind.size() == 1);
            columns.exchange_lines(id, &mut self.spare);
        }
    }

    /// Makes cells, blocks and partition from the sorted keys.
    fn divide(&mut self, points: usize) {
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
    fn cell_end(&self, block: usize) -> usize {
        self.blocks.get(block + 1).map_or(self.cells.len(), |&(_, first)| first as usize)
    }

    /// First particle of a cell; past the last cell, the number of particles.
    fn first_point(&self, cell: usize, points: usize) -> usize {
        self.cells.get(cell).map_or(points, |&(_, first)| first as usize)
    }
}

/// The number of type `T` that is at least `lower` and next to it.
fn first_inside<T: Real>(lower: f64) -> T {
    let first = T::of(lower);
    if first.as_f64() < lower { first + T::epsilon() * first.abs() } else { first }
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

fn copy_column<T: Real>(columns: &mut Columns, from: State<T>, to: State<T>) {
    let (from, to) = (from.id(), to.id());
    columns.copy(from, to);
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
            "particle {} has moved by {:.3e} since it was last sorted into its cell, more than half the \
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
