//! The populations around a row of sites.

use finegrain_framework::space::Grid;
use finegrain_framework::{Near, Reach, Real, View};

use crate::in_place;
use crate::link::Link;
use crate::physics::Streaming;
use crate::row::copy_around;

/// The populations of the rows around a row, as far as streaming and links reach.
pub(crate) struct Around<'a, 'v, T> {
    /// Of each velocity.
    views: &'v [View<'a, T>],
    velocities: &'static [[i32; 3]],
    streaming: Streaming,
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
        streaming: Streaming,
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
        Self { views, velocities, streaming, rows }
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

    /// Where the population of velocity `q` is that leaves a site, as seen from there.
    #[inline]
    fn kept(&self, q: usize) -> [i32; 3] {
        match self.streaming {
            Streaming::TwoGrids => [0; 3],
            Streaming::InPlace => in_place::kept(self.velocities[q], q),
        }
    }

    /// Population `q` a step `to` away from site `x`.
    pub fn at(&self, q: usize, x: usize, to: [i32; 3]) -> T {
        let kept = self.kept(q);
        let row = self.row(q, [to[1] + kept[1], to[2] + kept[2]]).unwrap_or_default();
        row[wrap(x as i32 + to[0] + kept[0], row.len())]
    }

    /// Populations of velocity `q` that leave the sites of the row.
    pub fn leaving(&self, q: usize, into: &mut [T]) {
        let kept = self.kept(q);
        copy_around(self.row(q, [kept[1], kept[2]]).unwrap_or_default(), kept[0] as isize, into);
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
        self.at(crate::lattice::opposite(usize::from(link.q)), x, [0; 3])
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
