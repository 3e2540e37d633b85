//! One row of points, evaluated in packs.
//!
//! The packs at the two ends read a copy, with what lies beyond the end: the other end of a periodic axis, or ghost
//! points; all others read memory as it lies. Points next to closed ends have coefficients of their own, and go one
//! by one; that part is compiled once, not for every instruction set. A number has the same bits however it was
//! computed.

use std::ops::Range;

use finegrain_framework::Real;
use finegrain_framework::pack::{Fill, MOST_LANES, Pack, Packed, Targets, prefetch};
use finegrain_framework::space::grid::RowsOfMut;

use crate::around::{Around, At, Closed, Weights};
use crate::equation::Equation;
use crate::line::{self, Ends};
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

/// How many packs are asked for before they are needed.
const AHEAD: usize = 16;

/// A pack of one.
type One<T> = <T as Packed>::Pack<pulp::Scalar>;

/// What becomes of a rate of change, with the numbers for it; see [`crate::sweep::Form`].
#[derive(Clone, Copy)]
pub(crate) enum Advance<T> {
    Rate,
    Euler(T),
    TwoStep(T),
}

impl<T: Real> Advance<T> {
    #[inline(always)]
    fn to<V: Pack<Scalar = T>>(self, here: V, rate: V) -> V {
        if let Self::Euler(dt) = self { rate.mul_add(rate.splat_like(dt), here) } else { rate }
    }
}

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

/// Where packs are: `count` from point `x` on. What is read along the row lies in the row itself, or in the window of
/// an end, from a place on.
#[derive(Clone, Copy)]
struct Place {
    x: usize,
    count: usize,
    window: Option<(usize, usize)>,
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
    fn rows<const K: usize>(&self, f: usize, axes: usize) -> [[&[T]; K]; 2] {
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
    fn around<'b, V: Pack<Scalar = T>, const K: usize>(
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

/// Rows of unknowns and of given fields along y and z: see [`Row::rows`].
type Rows<'b, T, const F: usize, const G: usize, const K: usize> =
    ([[[&'b [T]; K]; 2]; F], [[[&'b [T]; K]; 2]; G]);

/// Packs of a row from point `start` on.
struct Packs<
    'a,
    V: Pack<Scalar: Real>,
    E,
    const F: usize,
    const G: usize,
    const R: usize,
    const N: usize,
    const M: usize,
    const K: usize,
> {
    row: &'a Row<'a, V::Scalar, E, F, G, R, N, M>,
    simd: V::Simd,
    weights: &'a Weights<V, R>,
    windows: &'a [[Window<V::Scalar>; 2]],
    places: &'a [Place],
    start: usize,
}

impl<
    V: Pack<Scalar: Real>,
    E,
    const F: usize,
    const G: usize,
    const R: usize,
    const N: usize,
    const M: usize,
    const K: usize,
> Packs<'_, V, E, F, G, R, N, M, K>
where
    E: Equation<V::Scalar, F, G>,
{
    /// The rows of all fields.
    #[inline(always)]
    fn rows(&self, axes: usize) -> Rows<'_, V::Scalar, F, G, K> {
        let mut unknowns = [self.row.rows::<K>(0, axes); F];
        for f in 1..F {
            unknowns[f] = self.row.rows::<K>(f, axes);
        }
        let mut given = [unknowns[0]; G];
        for g in 0..G {
            given[g] = self.row.rows::<K>(F + g, axes);
        }
        (unknowns, given)
    }

    /// All fields around packs.
    #[inline(always)]
    fn arounds<'b>(
        &'b self,
        (unknown_rows, given_rows): &Rows<'b, V::Scalar, F, G, K>,
        place: Place,
    ) -> ([Around<'b, V, K>; F], [Around<'b, V, K>; G]) {
        let around = |f, rows| self.row.around::<V, K>(self.simd, f, rows, self.windows, place);
        let mut unknowns = [around(0, &unknown_rows[0]); F];
        for f in 1..F {
            unknowns[f] = around(f, &unknown_rows[f]);
        }
        let mut given = [unknowns[0]; G];
        for g in 0..G {
            given[g] = around(F + g, &given_rows[g]);
        }
        (unknowns, given)
    }

    /// The unknowns and their rates of change, of an equation along so many axes.
    #[inline(always)]
    fn rates(
        &self,
        axes: usize,
        (unknowns, given): &([Around<'_, V, K>; F], [Around<'_, V, K>; G]),
        pack: usize,
    ) -> [[V; F]; 2] {
        let mut u = [At::new(&unknowns[0], self.weights, axes, pack); F];
        for f in 1..F {
            u[f] = At::new(&unknowns[f], self.weights, axes, pack);
        }
        let mut c = [u[0]; G];
        for g in 0..G {
            c[g] = At::new(&given[g], self.weights, axes, pack);
        }
        let rates = self.row.sweep.equation.rate(u, c, self.row.dt);
        let mut here = rates;
        for f in 0..F {
            here[f] = u[f].here();
            // Processors foresee no further than the end of a page, which is about that of a row.
            let [_, rows, planes] = &unknowns[f].lines;
            let furthest = if axes > 2 { planes[K - 1] } else { rows[K - 1] };
            prefetch(furthest, pack + AHEAD);
        }
        [here, rates]
    }

    /// Places that hold packs, and where these lie in what is written.
    #[inline(always)]
    fn places(&self) -> impl Iterator<Item = (Place, Range<usize>)> {
        let places = self.places.iter().filter(|place| place.count > 0);
        places.map(|place| {
            let first = (place.x - self.start) / V::LANES;
            (*place, first..first + place.count)
        })
    }

    /// Writes the next state, or the rates. Of light equations compiled for two and for three axes and inlined, so that
    /// no pack asks how many there are.
    #[inline(always)]
    fn fill_along(&self, axes: usize, targets: &mut Targets<'_, V::Vector, F>) {
        let (advance, rows) = (self.row.advance, self.rows(axes));
        for (place, range) in self.places() {
            let arounds = self.arounds(&rows, place);
            let mut targets = targets.part(range);
            for pack in 0..place.count {
                let [here, rates] = self.rates(axes, &arounds, pack);
                let mut next = [here[0].vector(); F];
                for f in 0..F {
                    next[f] = advance.to(here[f], rates[f]).vector();
                }
                targets.write(pack, next);
            }
        }
    }

    /// Two steps from the state before, which the targets hold, to the next.
    #[inline(always)]
    fn onto(self, dt_squared: V::Scalar, mut targets: [&mut [V::Vector]; F]) {
        match self.weights.axes {
            3 if V::LANES > 1 && E::IS_LIGHT => self.onto_along(3, dt_squared, &mut targets),
            2 if V::LANES > 1 && E::IS_LIGHT => self.onto_along(2, dt_squared, &mut targets),
            axes => self.onto_along(axes, dt_squared, &mut targets),
        }
    }

    #[inline(always)]
    fn onto_along(&self, axes: usize, dt_squared: V::Scalar, targets: &mut [&mut [V::Vector]; F]) {
        let (rows, dt_squared) = (self.rows(axes), V::splat(self.simd, dt_squared));
        for (place, range) in self.places() {
            let arounds = self.arounds(&rows, place);
            let targets = targets.each_mut().map(|to| &mut to[range.clone()]);
            for pack in 0..place.count {
                let [here, rates] = self.rates(axes, &arounds, pack);
                for f in 0..F {
                    prefetch(targets[f], pack + AHEAD);
                    let before = V::of(self.simd, targets[f][pack]);
                    let next = rates[f].mul_add(dt_squared, here[f] + (here[f] - before));
                    targets[f][pack] = next.vector();
                }
            }
        }
    }
}

impl<
    V: Pack<Scalar: Real>,
    E,
    const F: usize,
    const G: usize,
    const R: usize,
    const N: usize,
    const M: usize,
    const K: usize,
> Fill<V::Vector, F> for Packs<'_, V, E, F, G, R, N, M, K>
where
    E: Equation<V::Scalar, F, G>,
{
    #[inline(always)]
    fn fill(self, targets: &mut Targets<'_, V::Vector, F>) {
        // Equations of second order are stepped by `onto`, and come here only where someone looks.
        let is_light = V::LANES > 1 && E::IS_LIGHT && !E::SECOND_ORDER;
        match self.weights.axes {
            3 if is_light => self.fill_along(3, targets),
            2 if is_light => self.fill_along(2, targets),
            axes => self.fill_along(axes, targets),
        }
    }
}
