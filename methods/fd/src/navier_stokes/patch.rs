//! A tile of one field with what lies around it, so that operators need not know where they are.

use finegrain_framework::Real;
use finegrain_framework::pack::MOST_LANES;
use finegrain_framework::space::grid::Rows;

/// What lies beyond the ends of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Beyond {
    /// The other end.
    Periodic,
    /// Something else at the lower and upper end.
    Ends([Edge; 2]),
}

/// What an end is to a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Edge {
    /// A wall, through which the field, a velocity on the faces of cells, does not go: the first point lies on the
    /// lower wall, and one past the last on the upper.
    Wall,
    /// A wall half a spacing away. Across it operators read one point; what lies further beyond has no meaning.
    HalfWay(Ghost),
    /// The field goes on along a straight line.
    Straight,
}

/// How a point beyond an end follows from another inside: `keep` times that, plus `next` times what is
/// one further inside, plus `add`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ghost {
    keep: f64,
    next: f64,
    add: f64,
}

impl Ghost {
    /// The same as inside.
    pub const SAME: Self = Self { keep: 1.0, next: 0.0, add: 0.0 };

    /// On the parabola through `value` at the wall and the two points before it.
    pub fn with_value_at_wall(value: f64) -> Self {
        Self { keep: -2.0, next: 1.0 / 3.0, add: 8.0 / 3.0 * value }
    }
}

impl Beyond {
    /// For point `i` outside `0..n`: the point that it follows from, if any, and how.
    fn source(&self, i: isize, n: isize) -> (Option<isize>, Ghost) {
        let same = Ghost::SAME;
        let Self::Ends([lower, upper]) = self else { return (Some(i.rem_euclid(n)), same) };
        let (edge, last, mirrored) = if i < 0 { (lower, 0, -i) } else { (upper, n - 1, 2 * n - i) };
        match edge {
            Edge::Wall if i == n => (None, same),
            Edge::Wall => (Some(mirrored), same),
            Edge::HalfWay(ghost) => (Some(mirrored - 1), *ghost),
            Edge::Straight => {
                let distance = (i - last).unsigned_abs() as f64;
                (Some(last), Ghost { keep: 1.0 + distance, next: -distance, add: 0.0 })
            }
        }
    }
}

/// Where a tile lies in its grid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// Points of the grid.
    pub shape: [usize; 3],
    /// First row and plane of the tile.
    pub first: [usize; 2],
    /// Rows and planes of the tile.
    pub count: [usize; 2],
    /// Points read to either side along x and y, and along z.
    pub reach: [usize; 2],
}

impl Extent {
    /// Distance in memory of neighbours along each axis. Rows have room for whole packs.
    pub fn strides(&self) -> [usize; 3] {
        let row = self.shape[0].next_multiple_of(MOST_LANES) + 2 * self.reach[0];
        [1, row, row * (self.count[0] + 2 * self.reach[0])]
    }

    /// Where row `j` of plane `k` of the tile, counted from its first, has its first point.
    pub fn place(&self, j: usize, k: usize) -> usize {
        let [_, row, plane] = self.strides();
        (k + self.reach[1]) * plane + (j + self.reach[0]) * row + self.reach[0]
    }
}

/// The field's values, in memory that is reused.
pub(crate) struct Patch<T>(Vec<T>);

impl<T> Default for Patch<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T: Real> Patch<T> {
    pub fn values(&self) -> &[T] {
        &self.0
    }

    /// Fills it with a sum of columns, each with its factor.
    pub fn fill(&mut self, extent: &Extent, beyond: &[Beyond; 3], sum: &[(Rows<'_, T>, T)]) {
        let [_, row, plane] = extent.strides();
        let [ry, rz] = extent.reach;
        let [rows, planes] = [extent.count[0] + 2 * ry, extent.count[1] + 2 * rz];
        self.0.resize(plane * planes, T::zero());
        let place =
            |i: usize, a: usize| i as isize + extent.first[a] as isize - extent.reach[a] as isize;
        for k in 0..planes {
            for j in 0..rows {
                let to = &mut self.0[k * plane + j * row..][..row];
                for (n, (column, factor)) in sum.iter().enumerate() {
                    let Some(from) = column.get(place(j, 0), place(k, 1)) else { break };
                    let to = &mut to[ry..ry + from.len()];
                    if n == 0 {
                        to.iter_mut().zip(from).for_each(|(to, &u)| *to = *factor * u);
                    } else {
                        to.iter_mut().zip(from).for_each(|(to, &u)| *to += *factor * u);
                    }
                }
                ends_of_row(to, extent, &beyond[0]);
            }
        }
        // Rows beyond the ends of y, then whole planes beyond those of z.
        for k in 0..planes {
            for j in 0..rows {
                let n = extent.shape[1] as isize;
                self.continue_to(place(j, 0), n, &beyond[1], k * plane + j * row, row, row);
            }
        }
        for k in 0..planes {
            let n = extent.shape[2] as isize;
            self.continue_to(place(k, 1), n, &beyond[2], k * plane, plane, plane);
        }
    }

    /// Makes what lies at `to`, of length `length`, from lines inside if it is line `i` beyond the ends of `n` lines
    /// `stride` apart.
    fn continue_to(
        &mut self,
        i: isize,
        n: isize,
        beyond: &Beyond,
        to: usize,
        stride: usize,
        length: usize,
    ) {
        if (0..n).contains(&i) || *beyond == Beyond::Periodic {
            return;
        }
        let (source, ghost) = beyond.source(i, n);
        let Some(source) = source else { return self.0[to..to + length].fill(T::zero()) };
        let at = |line: isize| (to as isize + (line - i) * stride as isize) as usize;
        let from = at(source);
        self.0.copy_within(from..from + length, to);
        let [keep, add] = [ghost.keep, ghost.add].map(T::of);
        self.0[to..to + length].iter_mut().for_each(|u| *u = keep * *u + add);
        if ghost.next != 0.0 {
            // What lies inside is after the lower end and before the upper one.
            let (ghosts, inside) = if i < 0 {
                let (before, after) = self.0.split_at_mut(at(source + 1));
                (&mut before[to..to + length], &after[..length])
            } else {
                let (before, after) = self.0.split_at_mut(to);
                let next = at(source - 1);
                (&mut after[..length], &before[next..next + length])
            };
            let factor = T::of(ghost.next);
            ghosts.iter_mut().zip(inside).for_each(|(u, &v)| *u += factor * v);
        }
    }
}

fn ends_of_row<T: Real>(row: &mut [T], extent: &Extent, beyond: &Beyond) {
    let (n, reach) = (extent.shape[0], extent.reach[0]);
    for depth in 0..reach {
        for (i, inward) in [(-1 - depth as isize, 1), ((n + depth) as isize, -1)] {
            let (source, ghost) = beyond.source(i, n as isize);
            let at = |i: isize| (i + reach as isize) as usize;
            row[at(i)] = source.map_or(T::zero(), |source| {
                let [keep, next, add] = [ghost.keep, ghost.next, ghost.add].map(T::of);
                let next = if ghost.next == 0.0 { next } else { next * row[at(source + inward)] };
                keep * row[at(source)] + add + next
            });
        }
    }
}
