//! One row of points, evaluated in packs.
//!
//! The packs at the two ends read a copy, with what lies beyond the end: the other end of a periodic axis, or ghost
//! points; all others read memory as it lies. Points next to closed ends have coefficients of their own, and go one
//! by one; that part is compiled once, not for every instruction set. A number has the same bits however it was
//! computed.

use finegrain_framework::Real;
use finegrain_framework::pack::{MOST_LANES, Pack, Packed};
use finegrain_framework::space::grid::RowsOfMut;

use crate::around::{Around, Closed, Weights};
use crate::equation::Equation;
use crate::line::{self, Ends};
use crate::packs::{Advance, Packs, Place};
use crate::plane::Plane;
use crate::sweep::Sweep;

/// A copy of what lies around the points next to an end of a row.
#[derive(Clone, Copy)]
pub(crate) struct Window<T>([T; WINDOW]);
/// Two packs and what is read on either side of them.
const WINDOW: usize = 3 * MOST_LANES;

impl<T: Real> Default for Window<T> {
    fn default() -> Self {
        Self([T::zero(); WINDOW])
    }
}

/// A pack of one.
type One<T> = <T as Packed>::Pack<pulp::Scalar>;

/// A field around one row.
#[derive(Clone, Copy)]
pub(crate) struct Cross<'a, T, const R: usize, const N: usize, const M: usize> {
    plane: &'a Plane<'a, T, R, N>,
    /// Of y and z, where an end of the axis is near. Not copied: a processor waits until what has just been written in
    /// pieces can be read as a whole.
    ends: [Option<&'a NearEnd<'a, T, M>>; 2],
}

impl<'a, T, const R: usize, const N: usize, const M: usize> Cross<'a, T, R, N, M> {
    #[inline(always)]
    pub fn new(plane: &'a Plane<'a, T, R, N>, ends: &'a [Option<NearEnd<'a, T, M>>; 2]) -> Self {
        Self { plane, ends: [ends[0].as_ref(), ends[1].as_ref()] }
    }
}

/// Rows along an axis of which an end is near.
#[derive(Clone, Copy)]
pub(crate) struct NearEnd<'a, T, const M: usize> {
    /// The middle one is that around which they lie; empty where none is to be read.
    pub rows: [&'a [T]; M],
    /// Coefficients next to a closed end, and what is given there.
    pub closed: Option<(&'a line::Row<T>, &'a [T])>,
}

/// A row to be evaluated.
pub(crate) struct Row<
    'a,
    T: Real,
    E,
    const F: usize,
    const G: usize,
    const R: usize,
    const N: usize,
    const M: usize,
> {
    pub sweep: &'a Sweep<T, E, F, G, R, N, M>,
    /// Its number in its plane.
    pub number: usize,
    pub unknowns: [Cross<'a, T, R, N, M>; F],
    pub given: [Cross<'a, T, R, N, M>; G],
    /// What is given on the boundary: of each unknown and axis.
    pub data: &'a [Vec<T>],
    pub advance: Advance<T>,
    pub dt: T,
    /// Points next to either end that have coefficients of their own along x.
    pub closed: usize,
}

/// A row of what is written.
pub(crate) struct Out<'a, 'n, T, const F: usize> {
    pub rows: &'a mut RowsOfMut<'n, T, F>,
    /// Its number in its plane, and that of the plane.
    pub row: (usize, usize),
}

impl<T, const F: usize> Out<'_, '_, T, F> {
    fn row(&mut self) -> [&mut [T]; F] {
        self.rows.row(self.row.0, self.row.1)
    }
}

impl<T: Real, E, const F: usize, const G: usize, const R: usize, const N: usize, const M: usize>
    Row<'_, T, E, F, G, R, N, M>
where
    E: Equation<T, F, G>,
{
    /// Whether it is away from closed ends of y and z.
    pub fn is_open(&self) -> bool {
        let mut ends = self.unknowns.iter().flat_map(|cross| cross.ends.iter().flatten());
        ends.all(|end| end.closed.is_none())
    }

    /// Whether what becomes of it depends on what was in its place before.
    #[inline(always)]
    fn is_onto(&self) -> bool {
        matches!(self.advance, Advance::TwoStep(_))
    }

    /// Field `f`, unknowns first.
    #[inline(always)]
    fn cross(&self, f: usize) -> &Cross<'_, T, R, N, M> {
        if f < F { &self.unknowns[f] } else { &self.given[f - F] }
    }

    /// Field `f` on the row itself.
    #[inline(always)]
    fn here(&self, f: usize) -> &[T] {
        self.cross(f).plane.along_z(self.number, 0)
    }

    /// Field `f` on the rows along y and z, as far as `K` of them reach; the row itself where none is to be read: all are
    /// as long as each other, so that no pack needs to be checked for being there.
    #[inline(never)]
    pub fn rows<const K: usize>(&self, f: usize, axes: usize) -> [[&[T]; K]; 2] {
        let (cross, here) = (self.cross(f), self.here(f));
        let mut rows = [[here; K]; 2];
        for a in 1..axes {
            for n in 0..K {
                let by = n as isize - (K / 2) as isize;
                let row = match cross.ends[a - 1] {
                    Some(end) => end.rows[n + M / 2 - K / 2],
                    None if by.unsigned_abs() > R => here,
                    None if a == 1 => cross.plane.along_y(self.number, by),
                    None => cross.plane.along_z(self.number, by),
                };
                rows[a - 1][n] = if row.is_empty() { here } else { row };
            }
        }
        rows
    }

    /// The points from `start` to `end`, at least a pack of them, of an open row.
    #[inline(always)]
    pub fn packs<V: Pack<Scalar = T>>(
        &self,
        simd: V::Simd,
        weights: &Weights<V, R>,
        windows: &mut [[Window<T>; 2]],
        [start, end]: [usize; 2],
        out: &mut Out<'_, '_, T, F>,
    ) {
        let nx = self.here(0).len();
        let whole = (end - start) / V::LANES;
        let at = |pack: usize| start + pack * V::LANES;
        // Packs that read nothing beyond the row; where points are left over, one more begins before what has been
        // done.
        let first = R.saturating_sub(start).div_ceil(V::LANES).min(whole);
        let last = ((nx - R - start) / V::LANES).clamp(first, whole);
        let (rest, upper) = (end - V::LANES, at(last).min(end - V::LANES));
        if first > 0 {
            self.copy(windows, 0, [start, at(first)], R);
        }
        let reads_beyond = end + R > nx;
        if reads_beyond {
            self.copy(windows, 1, [upper, end], R);
        }
        let places = [
            // Longest first: what has just been copied is there when the others read it.
            Place { x: at(first), count: last - first, window: None },
            Place { x: start, count: first, window: Some((0, 0)) },
            Place { x: at(last), count: whole - last, window: Some((1, at(last) - upper)) },
        ];
        let left = [Place { x: rest, count: 1, window: reads_beyond.then_some((1, rest - upper)) }];
        let again = at(whole) - rest;
        let runs = [(&places[..], [start, at(whole)], 0), (&left, [rest, end], again)];
        // In a loop, so that it is compiled once.
        for &(places, range, again) in runs.iter().take(if at(whole) < end { 2 } else { 1 }) {
            let is_kept = again > 0 && self.is_onto();
            let mut kept = [[T::zero(); MOST_LANES]; F];
            if is_kept {
                for (kept, row) in kept.iter_mut().zip(out.row()) {
                    kept[..again].copy_from_slice(&row[range[0]..][..again]);
                }
            }
            self.run::<V, N>(simd, weights, windows, places, range, out);
            if is_kept {
                for (kept, row) in kept.iter().zip(out.row()) {
                    row[range[0]..][..again].copy_from_slice(&kept[..again]);
                }
            }
        }
    }

    /// The points from `start` to `end`, with coefficients of their own where ends are closed.
    pub fn points(
        &self,
        weights: &Weights<One<T>, R>,
        windows: &mut [[Window<T>; 2]],
        [start, end]: [usize; 2],
        out: &mut Out<'_, '_, T, F>,
    ) {
        let nx = self.here(0).len();
        let margin = self.closed.max(M / 2);
        let mut x = start;
        while x < end {
            let mut place = Place { x, count: 1, window: None };
            if margin <= x && x + margin < nx {
                place.count = end.min(nx - margin) - x;
            } else {
                place.window = Some((0, 0));
                self.copy(windows, 0, [x, x + 1], M / 2);
            }
            let range = [x, x + place.count];
            self.run::<One<T>, M>(pulp::Scalar, weights, windows, &[place], range, out);
            x += place.count;
        }
    }

    /// Copies the points from `start` to `end` into the windows of an end, with so many places on either side, of
    /// which some may lie beyond the row.
    fn copy(
        &self,
        windows: &mut [[Window<T>; 2]],
        end_of_row: usize,
        [start, end]: [usize; 2],
        aside: usize,
    ) {
        let nx = self.here(0).len();
        let from = start as isize - aside as isize;
        for (f, windows) in windows.iter_mut().enumerate() {
            let (row, line) = (self.here(f), self.sweep.line(f, 0));
            let window = &mut windows[end_of_row].0[..end - start + 2 * aside];
            if line.is_some_and(|line| matches!(line.ends, Ends::Periodic)) {
                let mut place = from.rem_euclid(nx as isize) as usize;
                for value in window {
                    *value = row[place];
                    place = if place + 1 < nx { place + 1 } else { 0 };
                }
            } else {
                for (value, place) in window.iter_mut().zip(from..) {
                    let within = usize::try_from(place).ok().and_then(|place| row.get(place));
                    *value = within.copied().unwrap_or_else(|| self.beyond(f, place));
                }
            }
        }
    }

    /// Field `f` at a place beyond a bounded row; 0 where there is nothing.
    fn beyond(&self, f: usize, place: isize) -> T {
        let row = self.here(f);
        let nx = row.len() as isize;
        let Some(line) = self.sweep.line(f, 0) else { return T::zero() };
        match &line.ends {
            Ends::Periodic | Ends::Closed(_) => T::zero(),
            Ends::Ghosts(ghosts) => {
                let (end, depth) = if place < 0 { (0, -1 - place) } else { (1, place - nx) };
                let Some(ghost) = ghosts[end].get(depth as usize) else { return T::zero() };
                let data = if f < F { self.data[f * 3][end] } else { T::zero() };
                ghost.keep * row[line.counted_from(ghost.source, end)] + ghost.data * data
            }
        }
    }

    /// Points of the row, in places that hold all of them.
    #[inline(always)]
    fn run<V: Pack<Scalar = T>, const K: usize>(
        &self,
        simd: V::Simd,
        weights: &Weights<V, R>,
        windows: &[[Window<T>; 2]],
        places: &[Place],
        [start, end]: [usize; 2],
        out: &mut Out<'_, '_, T, F>,
    ) {
        let task =
            Packs::<V, E, F, G, R, N, M, K> { row: self, simd, weights, windows, places, start };
        // Asked of the equation first: what no equation needs is not compiled.
        if E::SECOND_ORDER
            && let Advance::TwoStep(dt_squared) = self.advance
        {
            task.onto(dt_squared, out.row().map(|row| V::packs_mut(simd, &mut row[start..end])));
        } else {
            out.rows.fill::<V>(simd, out.row, start..end, task);
        }
    }

    /// Field `f` around packs, of which [`Row::rows`] has the rows.
    #[inline(always)]
    pub fn around<'b, V: Pack<Scalar = T>, const K: usize>(
        &'b self,
        simd: V::Simd,
        f: usize,
        rows: &[[&'b [T]; K]; 2],
        windows: &'b [[Window<T>; 2]],
        place: Place,
    ) -> Around<'b, V, K> {
        let Place { x, count, window } = place;
        let length = count * V::LANES;
        let mut around = Around { simd, lines: [[&[][..]; K]; 3], closed: [None; 3] };
        let aside = if K > N { K / 2 } else { R };
        let along = match window {
            None => &self.here(f)[x - aside..],
            Some((end, place)) => &windows[f][end].0[place..],
        };
        let along = &along[..length + 2 * aside];
        for n in 0..2 * aside + 1 {
            around.lines[0][K / 2 - aside + n] = &V::packs(simd, &along[n..][..length])[..count];
        }
        for a in 1..3 {
            for n in 0..K {
                around.lines[a][n] = &V::packs(simd, &rows[a - 1][n][x..x + length])[..count];
            }
        }
        if K > N && f < F {
            for a in 1..3 {
                let closed = self.unknowns[f].ends[a - 1].and_then(|end| end.closed);
                if let Some((row, data)) = closed {
                    let data = &V::packs(simd, &data[x..x + length])[..count];
                    around.closed[a] = Some(Closed { row, data });
                }
            }
            // Points that near to the ends of a row go one by one.
            if let Some((row, end)) = self.sweep.line(f, 0).and_then(|line| line.row(x)) {
                let data = V::packs(simd, &self.data[f * 3][end..=end]);
                around.closed[0] = Some(Closed { row, data });
            }
        }
        around
    }
}
