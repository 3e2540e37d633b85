//! Structured grids: rows contiguous in x, tiles of rows as sub-domains.

mod rows;

pub use rows::{Rows, RowsMut, RowsOfMut};

use crate::domain::{Domain, Partition, Piece, Span, SubDomain};
use crate::viewable::{Geometry, Viewable};

/// A 1-D, 2-D or 3-D structured grid.
///
/// Point (i, j, k) is number `(k ny + j) nx + i`. A tile is a block of whole rows; its neighbours
/// are the tiles that own a row within the stencil's reach, corners included.
///
/// Tiles are numbered strip by strip, a strip being some tiles side by side in y through all planes, so that
/// whoever walks by number soon comes by what it has left one plane ago: caches hold the planes of a strip, not those
/// of a large grid. Under `PeerToPeer` several steps are taken while they do.
///
/// Rows are whole: a 1-D grid is one row and so one sub-domain, which one worker steps. To have it
/// in parallel, lay it out in 2-D.
///
/// [`Rows`] wraps j and k in periodic directions; along x, within a row, a stage wraps by itself.
/// Beyond a wall there is no row: [`Rows::get`] gives `None`, [`Rows::row`] panics.
#[derive(Debug)]
pub struct Grid {
    shape: [usize; 3],
    periodic: [bool; 3],
    reach: usize,
    origin: [f64; 3],
    spacing: [f64; 3],
    /// Rows (in y) and planes (in z) of a tile.
    tile: [usize; 2],
    /// Tiles in y and z.
    tiles: [usize; 2],
    /// Tiles side by side in y that are numbered through all planes before those beyond; the last may be fewer.
    strip: usize,
    partition: Partition,
}

/// Describes a [`Grid`].
#[derive(Clone, Debug)]
#[must_use]
pub struct GridBuilder {
    shape: [usize; 3],
    periodic: [bool; 3],
    reach: usize,
    origin: [f64; 3],
    spacing: [f64; 3],
    bytes: usize,
    tile: Option<[usize; 2]>,
    shifts: Vec<[isize; 2]>,
}

impl GridBuilder {
    /// Which directions are periodic; none by default.
    pub fn periodic<const D: usize>(mut self, periodic: [bool; D]) -> Self {
        self.periodic[..D].copy_from_slice(&periodic);
        self
    }

    /// How many rows or planes away a stencil reads; 1 by default.
    pub fn reach(mut self, reach: usize) -> Self {
        self.reach = reach;
        self
    }

    /// Position of point (0, 0, 0); the origin by default.
    pub fn origin<const D: usize>(mut self, origin: [f64; D]) -> Self {
        self.origin[..D].copy_from_slice(&origin);
        self
    }

    /// Distance of points in each direction; 1 by default.
    pub fn spacing<const D: usize>(mut self, spacing: [f64; D]) -> Self {
        self.spacing[..D].copy_from_slice(&spacing);
        self
    }

    /// Bytes of a point in the fields that are stepped, each by itself; 8 by default. Tiles are chosen by what they take
    /// in the caches.
    pub fn bytes(mut self, bytes: usize) -> Self {
        self.bytes = bytes;
        self
    }

    /// Rows (in y) and planes (in z) of a tile; by default chosen so that a field takes some
    /// 64 KiB in a tile, a task of several microseconds, small against the second-level cache; as many
    /// planes as the stencil reaches: nothing is copied between tiles, so they need not be compact, and a
    /// front of tiles that run ahead under `PeerToPeer` moves on by the planes of one with every step; and, in
    /// space, some times as high as that, since every step of the front leaves as much of it behind in y.
    pub fn tile(mut self, rows: usize, planes: usize) -> Self {
        self.tile = Some([rows, planes]);
        self
    }

    /// Lets stages own rows with an offset ([`crate::UpdateStage::shifts`]): shift number `n` has each tile own
    /// the rows `shifts[n]` away from its own, in y and z.
    pub fn shifts(mut self, shifts: &[[isize; 2]]) -> Self {
        self.shifts = shifts.to_vec();
        self
    }

    /// The grid.
    ///
    /// # Panics
    /// If there is a shift in a direction that is not periodic, or beyond the reach. If a length of the grid or of a tile is 0.
    pub fn build(self) -> Grid {
        let [nx, ny, nz] = self.shape;
        assert!(nx * ny * nz > 0, "a grid of shape {:?} has no points", self.shape);
        let [rows, planes] =
            self.tile.unwrap_or_else(|| default_tile(self.shape, self.bytes, self.reach));
        assert!(rows * planes > 0, "a tile needs rows");
        let tile = [rows.min(ny), planes.min(nz)];
        let tiles = [ny.div_ceil(tile[0]), nz.div_ceil(tile[1])];
        let mut grid = Grid {
            shape: self.shape,
            periodic: self.periodic,
            reach: self.reach,
            origin: self.origin,
            spacing: self.spacing,
            tile,
            tiles,
            strip: if nz > 1 { strip(rows * nx * self.bytes, tiles[0]) } else { tiles[0] },
            partition: Partition::new(nx * ny * nz),
        };
        grid.divide(&self.shifts);
        grid
    }
}

fn default_tile([nx, ny, nz]: [usize; 3], bytes: usize, reach: usize) -> [usize; 2] {
    let planes = reach.clamp(1, nz);
    let least = if nz > 1 { 4 * planes } else { 1 };
    [(65_536 / (nx * bytes * planes)).max(least).min(ny), planes]
}

/// Tiles side by side in a strip, of `tiles` in all, a plane of one taking so many bytes: some 256 KiB in a plane, of
/// which the few planes of several steps are a part of a worker's share of the caches, and strips about equally
/// wide.
fn strip(bytes: usize, tiles: usize) -> usize {
    let widest = (262_144 / bytes).max(1);
    tiles.div_ceil(tiles.div_ceil(widest))
}

impl Grid {
    /// Begins a grid of `shape` points, 1 to 3 directions.
    pub fn builder<const D: usize>(shape: [usize; D]) -> GridBuilder {
        let mut full = [1; 3];
        full[..D].copy_from_slice(&shape);
        GridBuilder {
            shape: full,
            periodic: [false; 3],
            reach: 1,
            origin: [0.0; 3],
            spacing: [1.0; 3],
            bytes: 8,
            tile: None,
            shifts: Vec::new(),
        }
    }

    /// Points in each direction, 1 in those that the grid does not have.
    pub fn shape(&self) -> [usize; 3] {
        self.shape
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.shape.iter().product()
    }

    /// Which directions are periodic.
    pub fn periodic(&self) -> [bool; 3] {
        self.periodic
    }

    /// Position of point (0, 0, 0).
    pub fn origin(&self) -> [f64; 3] {
        self.origin
    }

    /// Distance of points in each direction.
    pub fn spacing(&self) -> [f64; 3] {
        self.spacing
    }

    /// Position of point `number`.
    pub fn position(&self, number: usize) -> [f64; 3] {
        let [nx, ny, _] = self.shape;
        let index = [number % nx, number / nx % ny, number / (nx * ny)];
        std::array::from_fn(|a| self.origin[a] + index[a] as f64 * self.spacing[a])
    }

    fn divide(&mut self, shifts: &[[isize; 2]]) {
        let [ny, nz] = [self.shape[1], self.shape[2]];
        if self.strip < self.tiles[0] {
            self.partition.number_in_strips(self.strip);
        }
        let mut neighbours = Vec::new();
        for id in 0..self.tiles[0] * self.tiles[1] {
            let [rows, planes] = self.extent(id);
            neighbours.clear();
            let near_rows = near(rows.clone(), self.reach, ny, self.periodic[1]);
            for k in near(planes.clone(), self.reach, nz, self.periodic[2]) {
                for &j in &near_rows {
                    neighbours.push(self.owner(j, k) as u32);
                }
            }
            neighbours.sort_unstable();
            neighbours.dedup();
            neighbours.retain(|&n| n as usize != id);
            let nx = self.shape[0];
            let spans = planes
                .map(|k| Span { start: (k * ny + rows.start) * nx, end: (k * ny + rows.end) * nx });
            self.partition.push(spans, neighbours.iter().copied());
        }
        for &shift in shifts {
            let within = |a: usize| {
                let is_far = shift[a].unsigned_abs() > self.reach;
                shift[a] == 0 || (self.periodic[a + 1] && !is_far)
            };
            assert!(within(0) && within(1), "rows cannot be owned with an offset of {shift:?}");
            let mut partition = std::mem::take(&mut self.partition);
            partition.push_shift(|id| self.displaced(id, shift));
            self.partition = partition;
        }
        self.partition.seal().expect("tiles cover the grid and see each other mutually");
    }

    /// Rows and planes of tile number `id`.
    fn extent(&self, id: usize) -> [std::ops::Range<usize>; 2] {
        let first = id / (self.strip * self.tiles[1]) * self.strip;
        let (place, width) = (id - first * self.tiles[1], self.strip_width(first));
        let (tj, tk) = (first + place % width, place / width);
        let cut = |t: usize, length: usize, n: usize| t * length..((t + 1) * length).min(n);
        [cut(tj, self.tile[0], self.shape[1]), cut(tk, self.tile[1], self.shape[2])]
    }

    /// The rows that are `shift` away from those of tile number `id`: of each plane those before the rows
    /// go around the end of the grid, and those after; either may be none.
    fn displaced(&self, id: usize, shift: [isize; 2]) -> impl Iterator<Item = Span> {
        let [rows, planes] = self.extent(id);
        let [nx, ny, nz] = self.shape;
        let along =
            move |i: usize, by: isize, n: usize| (i as isize + by).rem_euclid(n as isize) as usize;
        let turn = along(0, -shift[0], ny).clamp(rows.start, rows.end);
        planes.flat_map(move |k| {
            [rows.start..turn, turn..rows.end].map(|rows| {
                let first = along(k, shift[1], nz) * ny + along(rows.start, shift[0], ny);
                // A row is there to begin at even for none.
                Span { start: first * nx, end: (first + rows.len()) * nx }
            })
        })
    }

    /// The tile that owns row j of plane k.
    fn owner(&self, j: usize, k: usize) -> usize {
        let (tj, tk) = (j / self.tile[0], k / self.tile[1]);
        let first = tj - tj % self.strip;
        first * self.tiles[1] + tk * self.strip_width(first) + tj - first
    }

    /// Tiles side by side in the strip that begins with tile `first` in y.
    fn strip_width(&self, first: usize) -> usize {
        self.strip.min(self.tiles[0] - first)
    }
}

/// Indices within `reach` of `range`, wrapped or cut off at the ends of `0..n`.
fn near(range: std::ops::Range<usize>, reach: usize, n: usize, periodic: bool) -> Vec<usize> {
    let (first, end) = (range.start as isize - reach as isize, range.end + reach);
    let mut all: Vec<usize> = (first..end as isize)
        .filter(|&i| periodic || (0..n as isize).contains(&i))
        .map(|i| i.rem_euclid(n as isize) as usize)
        .collect();
    all.sort_unstable();
    all.dedup();
    all
}

impl Domain for Grid {
    type SubDomain<'a> = Tile<'a>;

    fn partition(&self) -> &Partition {
        &self.partition
    }

    fn sub_domain(&self, id: usize) -> Tile<'_> {
        let [rows, planes] = self.extent(id);
        Tile { grid: self, id, rows, planes }
    }
}

impl Viewable for Grid {
    fn geometry(&self) -> Geometry {
        Geometry::Image { shape: self.shape, origin: self.origin, spacing: self.spacing }
    }
}

/// A block of whole rows of a [`Grid`].
#[derive(Clone, Debug)]
pub struct Tile<'a> {
    grid: &'a Grid,
    id: usize,
    rows: std::ops::Range<usize>,
    planes: std::ops::Range<usize>,
}

impl<'a> Tile<'a> {
    /// Its rows as (j, k), in order of memory.
    pub fn rows(&self) -> impl Iterator<Item = (usize, usize)> + use<'a> {
        let rows = self.rows.clone();
        self.planes.clone().flat_map(move |k| rows.clone().map(move |j| (j, k)))
    }

    /// Its rows in y and its planes in z.
    pub fn extent(&self) -> [std::ops::Range<usize>; 2] {
        [self.rows.clone(), self.planes.clone()]
    }

    /// The grid.
    pub fn grid(&self) -> &'a Grid {
        self.grid
    }
}

impl SubDomain for Tile<'_> {
    fn piece(&self) -> Piece<'_> {
        self.grid.partition.piece(self.id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tile_sees_the_tiles_around_it() {
        let grid = Grid::builder([4, 9, 9]).periodic([true, true, false]).tile(3, 3).build();
        assert_eq!(grid.partition().neighbours(4), [0, 1, 2, 3, 5, 6, 7, 8]);
        assert_eq!(grid.partition().neighbours(0), [1, 2, 3, 4, 5]);
    }

    #[test]
    fn tiles_are_numbered_strip_by_strip() {
        // Strips of 4, 4 and 3 tiles, of 8 rows but the last, which has 5.
        let grid = Grid::builder([1024, 85, 3]).tile(8, 1).build();
        assert_eq!((grid.partition().len(), grid.partition().strip()), (11 * 3, Some(4)));
        let places = (0..33).map(|id| grid.sub_domain(id).rows().next().unwrap());
        let strips = [(0..4), (4..8), (8..11)].into_iter();
        let expected = strips.flat_map(|strip| {
            (0..3).flat_map(move |k| strip.clone().map(move |tile| (8 * tile, k)))
        });
        assert!(places.eq(expected));
        for id in 0..33 {
            assert!(grid.sub_domain(id).rows().all(|(j, k)| grid.owner(j, k) == id));
        }
    }

    #[test]
    fn a_wide_stencil_sees_past_thin_tiles() {
        let grid = Grid::builder([4, 9]).reach(3).tile(2, 1).build();
        assert_eq!(grid.partition().neighbours(0), [1, 2]);
        assert_eq!(grid.partition().neighbours(4), [2, 3]);
    }

    #[test]
    fn one_tile_around_a_periodic_grid_is_not_its_own_neighbour() {
        let grid = Grid::builder([4, 4]).periodic([true, true]).tile(4, 1).build();
        assert!(grid.partition().neighbours(0).is_empty());
    }
}
