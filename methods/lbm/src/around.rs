//! The populations around a row of sites.

use finegrain_framework::space::Grid;
use finegrain_framework::{Near, Reach, Real, View};

use crate::link::Link;

/// The populations of the rows around a row, as far as streaming and links reach.
pub(crate) struct Around<'a, 'v, T> {
    /// Of each velocity.
    views: &'v [View<'a, T>],
    velocities: &'static [[i32; 3]],
    /// Rows from the one before to the one after in y, and so in z; `None` beyond a bounded end.
    rows: [[Option<Reach<'a>>; 3]; 3],
}

impl<'a, 'v, T: Real> Around<'a, 'v, T> {
    /// Around row `j` of plane `k`.
    #[inline]
    pub fn new(
        near: &Near<'a, Grid>,
        views: &'v [View<'a, T>],
        velocities: &'static [[i32; 3]],
        (j, k): (usize, usize),
    ) -> Self {
        let is_plane = velocities.iter().all(|c| c[2] == 0);
        let mut rows = [[None; 3]; 3];
        for (dz, plane) in rows.iter_mut().enumerate() {
            if is_plane && dz != 1 {
                continue;
            }
            for (dy, row) in plane.iter_mut().enumerate() {
                *row = near.reach_row((j + dy) as isize - 1, (k + dz) as isize - 1);
            }
        }
        Self { views, velocities, rows }
    }

    /// Populations of velocity `q` in the row that is `offset` from this one in y and z; `None`
    /// beyond a bounded end.
    #[inline(always)]
    pub fn row(&self, q: usize, offset: [i32; 2]) -> Option<&'a [T]> {
        let [dy, dz] = offset.map(|o| (o + 1) as usize);
        self.rows[dz][dy].map(|reach| self.views[q].at(reach))
    }

    /// Those that velocity `q` carries into this row; beyond a bounded end, where nothing may be
    /// pulled from, those of this row.
    #[inline(always)]
    pub fn source(&self, q: usize) -> &'a [T] {
        let [_, y, z] = self.velocities[q];
        self.row(q, [-y, -z]).or_else(|| self.row(q, [0, 0])).unwrap_or_default()
    }

    /// Population `q` a step `to` away from site `x`.
    pub fn at(&self, q: usize, x: usize, to: [i32; 3]) -> T {
        let row = self.row(q, [to[1], to[2]]).unwrap_or_default();
        row[wrap(x as i32 + to[0], row.len())]
    }

    /// The population that comes out of a body to site `x`.
    pub fn returned(&self, link: &Link<T>, x: usize) -> T {
        let q = usize::from(link.q);
        let c = self.velocities[q];
        link.returned(|opposite, n| {
            let q = if opposite { crate::lattice::opposite(q) } else { q };
            self.at(q, x, c.map(|c| n * c))
        })
    }

    /// The population that goes into a body from site `x`, opposite to the one that comes out.
    pub fn entering(&self, link: &Link<T>, x: usize) -> T {
        self.row(crate::lattice::opposite(usize::from(link.q)), [0, 0]).unwrap_or_default()[x]
    }
}

/// Place in a row of `n` sites, at most one beyond its ends.
#[inline(always)]
pub(crate) fn wrap(x: i32, n: usize) -> usize {
    let n = n as i32;
    (if x < 0 {
        x + n
    } else if x >= n {
        x - n
    } else {
        x
    }) as usize
}
