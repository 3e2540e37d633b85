//! Rows of a grid's columns, as stages see them.

use std::ops::Range;

use super::{Grid, Tile};
use crate::columns::{Element, Handle, Rate, State};
use crate::domain::Span;
use crate::pack::{Bypass, Fill, Pack};
use crate::real::Real;
use crate::view::{Near, Own, Part, PartMut, Rates, Reach, View};

/// Rows of one column, read only, as far as they can be seen from one tile.
pub struct Rows<'a, T> {
    near: Near<'a, Grid>,
    column: View<'a, T>,
}

impl<'a, T> Rows<'a, T> {
    /// Row j of plane k, all of x. Periodic directions wrap.
    ///
    /// # Panics
    /// If there is no such row, or it lies beyond the stencil's reach, as for [`Near::reach_row`].
    #[inline]
    pub fn row(&self, j: isize, k: isize) -> &'a [T] {
        self.get(j, k).unwrap_or_else(|| {
            panic!(
                "row ({j}, {k}) lies outside the grid, which is not periodic there: `get` tells \
                 what lies inside"
            )
        })
    }

    /// As [`Rows::row`], but `None` past a bounded end.
    ///
    /// # Panics
    /// As [`Near::reach_row`].
    #[inline]
    pub fn get(&self, j: isize, k: isize) -> Option<&'a [T]> {
        Some(self.column.at(self.near.reach_row(j, k)?))
    }

    /// The rows of plane k that lie straight beside the tile's own, one after the other; `None` past a bounded
    /// end. For stages to which finding rows one by one costs much.
    ///
    /// # Panics
    /// As [`Near::reach_row`].
    pub fn beside(&self, k: isize) -> Option<&'a [T]> {
        let (grid, tile) = (self.near.domain(), self.near.sub_domain());
        let [nx, ny, nz] = grid.shape;
        let k = wrap(k, nz, grid.periodic[2])?;
        let j = tile.rows.start;
        debug_assert!(
            is_within_reach(&tile, j, k),
            "plane {k} lies further from the tile than the reach of {}: see GridBuilder::reach",
            grid.reach
        );
        let start = (k * ny + j) * nx;
        let span = Span { start, end: start + tile.rows.len() * nx };
        Some(self.column.at(self.near.reach(grid.owner(j, k), span)))
    }
}

fn wrap(i: isize, n: usize, periodic: bool) -> Option<usize> {
    if (0..n as isize).contains(&i) {
        Some(i as usize)
    } else {
        periodic.then(|| i.rem_euclid(n as isize) as usize)
    }
}

/// Whether a stencil around the tile's rows reads row j of plane k.
fn is_within_reach(tile: &Tile<'_>, j: usize, k: usize) -> bool {
    let Grid { shape: [_, ny, nz], periodic, reach, .. } = *tile.grid;
    let sees = |own: &Range<usize>, i: usize, n: usize, periodic: bool| {
        if periodic {
            // Forward from the first row, or back to it.
            let (ahead, behind) = ((i + n - own.start) % n, (own.start + n - i) % n);
            ahead < own.len() + reach || behind <= reach
        } else {
            i + reach >= own.start && i < own.end + reach
        }
    };
    sees(&tile.rows, j, ny, periodic[1]) && sees(&tile.planes, k, nz, periodic[2])
}

/// A tile's own rows of one column, to be written.
pub struct RowsMut<'a, T> {
    tile: Tile<'a>,
    part: PartMut<'a, T>,
    /// Whether these are other rows than the tile's.
    is_shifted: bool,
}

impl<T> RowsMut<'_, T> {
    /// Row j of plane k, all of x; in a column that is owned with an offset, the row that is so far
    /// away from it.
    ///
    /// # Panics
    /// If row j of plane k is not the tile's.
    #[inline]
    pub fn row(&mut self, j: usize, k: usize) -> &mut [T] {
        let (span, range) = place(&self.tile, j, k);
        if self.is_shifted {
            return shifted(&mut self.part, span, range);
        }
        &mut self.part.span(span)[range]
    }
}

/// A row of a plane that is owned with an offset: in the span before the rows go around the end of the grid, or
/// in that after.
#[inline]
fn shifted<'a, T>(part: &'a mut PartMut<'_, T>, plane: usize, range: Range<usize>) -> &'a mut [T] {
    let before = part.span(2 * plane).len();
    if range.end <= before {
        &mut part.span(2 * plane)[range]
    } else {
        &mut part.span(2 * plane + 1)[range.start - before..range.end - before]
    }
}

/// A tile's own rows of several columns, to be written, for stages that write many.
pub struct RowsOfMut<'a, T, const N: usize> {
    tile: Tile<'a>,
    parts: [PartMut<'a, T>; N],
    /// Of each column, whether these are other rows than the tile's.
    is_shifted: [bool; N],
    /// Leave to write past the caches.
    bypass: Option<Bypass<'a>>,
}

impl<T, const N: usize> RowsOfMut<'_, T, N> {
    /// Row j of plane k of each column, as [`RowsMut::row`].
    ///
    /// # Panics
    /// As [`RowsMut::row`].
    #[inline]
    pub fn row(&mut self, j: usize, k: usize) -> [&mut [T]; N] {
        let (span, range) = place(&self.tile, j, k);
        let mut rows = std::array::from_fn(|_| <&mut [T]>::default());
        for ((row, part), is_shifted) in rows.iter_mut().zip(&mut self.parts).zip(self.is_shifted) {
            let range = range.clone();
            *row =
                if is_shifted { shifted(part, span, range) } else { &mut part.span(span)[range] };
        }
        rows
    }
}

impl<T: Real, const N: usize> RowsOfMut<'_, T, N> {
    /// Lets `task` write points `x` of row j of plane k of each column, vector by vector; what is left over behind
    /// the last whole vector stays as it is. It goes past the caches where that pays: if all columns are far
    /// larger than these, and the whole domain is stepped before anybody comes back here. So whole lines should be
    /// written, one vector after the other, and [`RowsOfMut::row`] not be asked for rows in between.
    ///
    /// # Panics
    /// As [`RowsOfMut::row`], if the row has no such points, or if a column is owned with an offset.
    #[inline(always)]
    pub fn fill<P: Pack<Scalar = T>>(
        &mut self,
        simd: P::Simd,
        (j, k): (usize, usize),
        x: Range<usize>,
        task: impl Fill<P::Vector, N>,
    ) {
        assert!(!self.is_shifted.contains(&true), "rows are filled without offset");
        let (span, row) = place(&self.tile, j, k);
        assert!(x.end <= row.len(), "the row has {} points", row.len());
        let range = row.start + x.start..row.start + x.end;
        PartMut::fill::<P, N>(simd, &mut self.parts, (span, range), self.bypass, task);
    }
}

/// A tile's own rows of one column, read only.
pub struct OwnRows<'a, T> {
    tile: Tile<'a>,
    part: Part<'a, T>,
}

impl<'a, T> OwnRows<'a, T> {
    /// Row j of plane k, all of x.
    ///
    /// # Panics
    /// If the tile does not own it.
    #[inline]
    pub fn row(&self, j: usize, k: usize) -> &'a [T] {
        let (span, range) = place(&self.tile, j, k);
        &self.part.span(span)[range]
    }
}

/// Which span of its tile a row lies in, and where.
fn place(tile: &Tile<'_>, j: usize, k: usize) -> (usize, std::ops::Range<usize>) {
    assert!(
        tile.rows.contains(&j) && tile.planes.contains(&k),
        "row ({j}, {k}) is not the tile's own"
    );
    let nx = tile.grid.shape[0];
    let start = (j - tile.rows.start) * nx;
    (k - tile.planes.start, start..start + nx)
}

impl<'a> Near<'a, Grid> {
    /// Makes row j of plane k readable in any number of columns ([`View::at`]), for stages that read
    /// many. Periodic directions wrap; `None` past a bounded end.
    ///
    /// # Panics
    /// If the row lies beyond the stencil's [`reach`](super::GridBuilder::reach) from the tile: with debug
    /// assertions always, without only if it is not a neighbour's.
    #[inline]
    pub fn reach_row(&self, j: isize, k: isize) -> Option<Reach<'a>> {
        let grid = self.domain();
        let [nx, ny, nz] = grid.shape;
        let j = wrap(j, ny, grid.periodic[1])?;
        let k = wrap(k, nz, grid.periodic[2])?;
        debug_assert!(
            is_within_reach(&self.sub_domain(), j, k),
            "row ({j}, {k}) lies further from its tile than the reach of {}: see GridBuilder::reach",
            grid.reach
        );
        let start = (k * ny + j) * nx;
        Some(self.reach(grid.owner(j, k), Span { start, end: start + nx }))
    }

    /// Rows of a state column, as far as they can be seen from here.
    ///
    /// # Panics
    /// As [`Near::state`].
    pub fn rows<T: Element>(&self, column: State<T>) -> Rows<'a, T> {
        Rows { near: *self, column: self.state(column) }
    }

    /// Rows of a rate column that an earlier stage wrote.
    ///
    /// # Panics
    /// As [`Near::rate`].
    pub fn rate_rows<T: Element>(&self, column: Rate<T>) -> Rows<'a, T> {
        Rows { near: *self, column: self.rate(column) }
    }
}

impl<'a> Rates<'a, Grid> {
    /// The tile's own rows of a rate column.
    ///
    /// # Panics
    /// As [`Rates::column`].
    pub fn rows<T: Element>(&mut self, column: Rate<T>) -> RowsMut<'a, T> {
        RowsMut {
            tile: crate::Domain::sub_domain(self.domain(), self.id()),
            part: self.column(column),
            is_shifted: false,
        }
    }

    /// The tile's own rows of several rate columns.
    ///
    /// # Panics
    /// As [`Rates::column`].
    pub fn rows_of<T: Element, const N: usize>(
        &mut self,
        columns: [Rate<T>; N],
    ) -> RowsOfMut<'a, T, N> {
        RowsOfMut {
            tile: crate::Domain::sub_domain(self.domain(), self.id()),
            is_shifted: [false; N],
            bypass: self.bypass(),
            parts: columns.map(|column| self.column(column)),
        }
    }
}

impl<'a> Own<'a, Grid> {
    /// The tile's own rows of a state column, to be advanced.
    ///
    /// # Panics
    /// As [`Own::state_mut`].
    pub fn rows_mut<T: Element>(&mut self, column: State<T>) -> RowsMut<'a, T> {
        let is_shifted = self.is_shifted(column.id());
        RowsMut { tile: self.sub_domain(), part: self.state_mut(column), is_shifted }
    }

    /// The tile's own rows of several state columns, to be advanced.
    ///
    /// # Panics
    /// As [`Own::state_mut`].
    pub fn rows_of_mut<T: Element, const N: usize>(
        &mut self,
        columns: [State<T>; N],
    ) -> RowsOfMut<'a, T, N> {
        RowsOfMut {
            tile: self.sub_domain(),
            is_shifted: columns.map(|column| self.is_shifted(column.id())),
            bypass: None,
            parts: columns.map(|column| self.state_mut(column)),
        }
    }

    /// The tile's own rows of a rate column.
    ///
    /// # Panics
    /// As [`Own::rate`].
    pub fn rate_rows<T: Element>(&mut self, column: Rate<T>) -> OwnRows<'a, T> {
        assert!(!self.is_shifted(column.id()), "rates are owned without offset");
        OwnRows { tile: self.sub_domain(), part: self.rate(column) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Domain;

    #[test]
    fn reach_is_counted_from_the_tile_not_from_its_neighbours() {
        let grid = Grid::builder([4, 12]).periodic([false, true]).tile(3, 1).reach(2).build();
        let seen_from = |id| {
            let tile = grid.sub_domain(id);
            (0..12).filter(|&j| is_within_reach(&tile, j, 0)).collect::<Vec<_>>()
        };
        assert_eq!(seen_from(0), [0, 1, 2, 3, 4, 10, 11]);
        assert_eq!(seen_from(1), [1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(seen_from(3), [0, 1, 7, 8, 9, 10, 11]);

        let bounded = Grid::builder([4, 12]).tile(3, 1).build();
        let tile = bounded.sub_domain(3);
        let seen: Vec<_> = (0..12).filter(|&j| is_within_reach(&tile, j, 0)).collect();
        assert_eq!(seen, [8, 9, 10, 11]);
    }
}
