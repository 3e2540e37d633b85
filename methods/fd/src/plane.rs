//! Rows of a tile's plane and what lies around them, found once for all of them.

use std::ops::Range;

use finegrain_framework::space::Grid;
use finegrain_framework::space::grid::Rows;
use finegrain_framework::{Near, Real, State};

/// Rows of one column in a plane of a tile, and the `R` on either side of each along y and z. Those that lie past a
/// bounded end are empty.
pub(crate) struct Plane<'a, T, const R: usize, const N: usize> {
    /// Any others, found one by one.
    pub far: Rows<'a, T>,
    /// Points of a row.
    length: usize,
    /// The tile's rows.
    rows: Range<usize>,
    /// As many in planes up to `R` away, the middle one being the tile's.
    beside: [&'a [T]; N],
    /// The `R` rows before the tile's, nearest first, and those after.
    beyond: [[&'a [T]; R]; 2],
}

impl<'a, T: Real, const R: usize, const N: usize> Plane<'a, T, R, N> {
    pub fn new(near: &Near<'a, Grid>, column: State<T>, rows: &Range<usize>, k: usize) -> Self {
        let (far, k, rows) = (near.rows(column), k as isize, rows.clone());
        let beside = |n: usize| far.beside(k + n as isize - R as isize).unwrap_or(&[]);
        let before = |by: usize| far.get(rows.start as isize - 1 - by as isize, k).unwrap_or(&[]);
        let after = |by: usize| far.get((rows.end + by) as isize, k).unwrap_or(&[]);
        let beyond = [std::array::from_fn(before), std::array::from_fn(after)];
        let beside = std::array::from_fn(beside);
        Self { far, length: near.domain().shape()[0], rows, beside, beyond }
    }

    /// The row so far further along z than row `j`, at most `R`.
    #[inline(always)]
    pub fn along_z(&self, j: usize, by: isize) -> &'a [T] {
        let beside = self.beside[(by + R as isize) as usize];
        &beside[(j - self.rows.start) * self.length..][..self.length]
    }

    /// The row so far further along y than row `j`, at most `R`.
    #[inline(always)]
    pub fn along_y(&self, j: usize, by: isize) -> &'a [T] {
        let y = j as isize + by;
        if y < self.rows.start as isize {
            self.beyond[0][(self.rows.start as isize - 1 - y) as usize]
        } else if y >= self.rows.end as isize {
            self.beyond[1][(y - self.rows.end as isize) as usize]
        } else {
            self.along_z(y as usize, 0)
        }
    }
}
