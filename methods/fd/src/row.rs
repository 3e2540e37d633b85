//! One row of points, evaluated in packs.
//!
//! Short rows are copied, with what lies beyond their ends: the other end of a periodic axis, or ghost points.
//! In long ones only the packs at the two ends read a copy, the others memory as it lies. Points next to closed
//! ends have coefficients of their own, and go one by one; that part is compiled once, not for every
//! instruction set. A number has the same bits however it was computed.

use finegrain_framework::Real;
use finegrain_framework::pack::{Fill, MOST_LANES, Pack, Packed, Targets, prefetch};
use finegrain_framework::space::grid::RowsOfMut;

use crate::around::{Around, At, Closed, Weights};
use crate::equation::Equation;
use crate::line::{self, Ends};
use crate::sweep::Sweep;

/// A copy of a stretch of a row, and of what is read on either side of it.
#[repr(align(64))]
#[derive(Clone)]
pub(crate) struct Window<T>([T; WINDOW]);
const WINDOW: usize = STRETCH / size_of::<f32>() + 2 * MARGIN;
/// Rows of up to so many bytes are copied as one, a small part of the nearest cache: packs at ends cost as much as
/// several others.
const STRETCH: usize = 2048;
/// Room for what lies beyond an end; packs behind it are aligned.
const MARGIN: usize = MOST_LANES;

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
    Before(T),
}

impl<T: Real> Advance<T> {
    /// Whether it depends on what was in its place before.
    fn is_onto(self) -> bool {
        matches!(self, Self::TwoStep(_) | Self::Before(_))
    }

    #[inline(always)]
    fn to<V: Pack<Scalar = T>>(self, here: V, rate: V) -> V {
        if let Self::Euler(dt) = self { here + rate * dt } else { rate }
    }

    #[inline(always)]
    fn onto<V: Pack<Scalar = T>>(self, here: V, rate: V, before: V) -> V {
        match self {
            Self::Before(half_dt_squared) => here + before + rate * half_dt_squared,
            Self::TwoStep(dt_squared) => here + (here - before) + rate * dt_squared,
            _ => self.to(here, rate),
        }
    }
}

/// A field's rows around one row.
#[derive(Clone, Copy)]
pub(crate) struct Cross<'a, T, const M: usize> {
    pub here: &'a [T],
    /// Rows further along y and z, the middle one being this; empty where none is to be read.
    pub lines: [[&'a [T]; M]; 2],
    /// Coefficients next to closed ends of y and z, and what is given there.
    pub closed: [Option<(&'a line::Row<T>, &'a [T])>; 2],
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
    pub unknowns: [Cross<'a, T, M>; F],
    pub given: [Cross<'a, T, M>; G],
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

/// Where packs are: `count` from `x` on, in the row itself, or in the window, from `offset` on.
#[derive(Clone, Copy)]
struct Place {
    x: usize,
    count: usize,
    offset: Option<usize>,
}

impl<T: Real, E, const F: usize, const G: usize, const R: usize, const N: usize, const M: usize>
    Row<'_, T, E, F, G, R, N, M>
where
    E: Equation<T, F, G>,
{
    /// Whether it is away from closed ends of y and z.
    pub fn is_open(&self) -> bool {
        self.unknowns.iter().all(|cross| cross.closed.iter().all(Option::is_none))
    }

    /// Field `f`, unknowns first.
    #[inline(always)]
    fn cross(&self, f: usize) -> &Cross<'_, T, M> {
        if f < F { &self.unknowns[f] } else { &self.given[f - F] }
    }

    /// The points from `start` to `end`, at least a pack of them, of an open row.
    #[inline(always)]
    pub fn packs<V: Pack<Scalar = T>>(
        &self,
        simd: V::Simd,
        weights: &Weights<V, R>,
        window: &mut [Window<T>],
        [start, end]: [usize; 2],
        out: &mut Out<'_, '_, T, F>,
    ) {
        let stretch = STRETCH / size_of::<T>();
        // Where packs read nothing beyond the row, in whole packs from its beginning.
        let first = if start >= R { start } else { R.next_multiple_of(V::LANES) };
        let last = end.min(self.unknowns[0].here.len() - R);
        let mut done = start;
        while done < end {
            let mut place = Place { x: done, count: 1, offset: None };
            if end - done > stretch && first <= done && done + V::LANES <= last {
                place.count = (last - done) / V::LANES;
            } else {
                // The last pack begins before what has been done.
                place.x = done.min(end - V::LANES);
                if end - place.x <= stretch {
                    place.count = (end - place.x) / V::LANES;
                }
                place.offset = Some(MARGIN);
                self.copy(window, place.x, R, place.count * V::LANES + 2 * R);
            }
            let again = done - place.x;
            if again == 0 {
                self.run::<V, N>(simd, weights, window, place, out);
            } else {
                let mut kept = [[T::zero(); MOST_LANES]; F];
                for (kept, row) in kept.iter_mut().zip(out.row()) {
                    kept[..again].copy_from_slice(&row[place.x..done]);
                }
                self.run::<V, N>(simd, weights, window, place, out);
                for (kept, row) in kept.iter().zip(out.row()) {
                    row[place.x..done].copy_from_slice(&kept[..again]);
                }
            }
            done = place.x + place.count * V::LANES;
        }
    }

    /// The points from `start` to `end`, with coefficients of their own where ends are closed.
    pub fn points(
        &self,
        weights: &Weights<One<T>, R>,
        window: &mut [Window<T>],
        [start, end]: [usize; 2],
        out: &mut Out<'_, '_, T, F>,
    ) {
        let nx = self.unknowns[0].here.len();
        let margin = self.closed.max(M / 2);
        let mut x = start;
        while x < end {
            let mut place = Place { x, count: 1, offset: None };
            if margin <= x && x + margin < nx {
                place.count = end.min(nx - margin) - x;
            } else {
                place.offset = Some(MARGIN);
                self.copy(window, x, M / 2, M);
            }
            self.run::<One<T>, M>(pulp::Scalar, weights, window, place, out);
            x += place.count;
        }
    }

    /// Copies `length` places of the rows, from `before` before `x` on, with what lies beyond their ends, to
    /// where place `x` is at [`MARGIN`].
    fn copy(&self, window: &mut [Window<T>], x: usize, before: usize, length: usize) {
        let nx = self.unknowns[0].here.len();
        // Of the window, how much lies before the row and how much does not lie beyond it.
        let (start, end) = (before.saturating_sub(x), (nx + before).saturating_sub(x).min(length));
        for f in 0..F + G {
            let window = &mut window[f].0[MARGIN - before..][..length];
            let row = self.cross(f).here;
            window[start..end].copy_from_slice(&row[x + start - before..x + end - before]);
            for n in (0..start).chain(end..length) {
                window[n] = self.beyond(f, (x + n) as isize - before as isize);
            }
        }
    }

    /// Field `f` at a place beyond the row; 0 where there is nothing.
    fn beyond(&self, f: usize, place: isize) -> T {
        let row = self.cross(f).here;
        let nx = row.len() as isize;
        let Some(line) = self.sweep.line(f, 0) else { return T::zero() };
        match &line.ends {
            Ends::Periodic => row[place.rem_euclid(nx) as usize],
            Ends::Closed(_) => T::zero(),
            Ends::Ghosts(ghosts) => {
                let (end, depth) = if place < 0 { (0, -1 - place) } else { (1, place - nx) };
                let Some(ghost) = ghosts[end].get(depth as usize) else { return T::zero() };
                let data = if f < F { self.data[f * 3][end] } else { T::zero() };
                ghost.keep * row[line.counted_from(ghost.source, end)] + ghost.data * data
            }
        }
    }

    #[inline(always)]
    fn run<V: Pack<Scalar = T>, const K: usize>(
        &self,
        simd: V::Simd,
        weights: &Weights<V, R>,
        window: &[Window<T>],
        place: Place,
        out: &mut Out<'_, '_, T, F>,
    ) {
        let Place { x, count, .. } = place;
        let mut unknowns = [self.around::<V, K>(simd, 0, window, place); F];
        for f in 1..F {
            unknowns[f] = self.around::<V, K>(simd, f, window, place);
        }
        let mut given = [unknowns[0]; G];
        for g in 0..G {
            given[g] = self.around::<V, K>(simd, F + g, window, place);
        }
        let length = count * V::LANES;
        let task = Packs { row: self, weights, unknowns, given, count };
        if self.advance.is_onto() {
            let rows = out.row();
            task.onto(rows.map(|row| &mut V::packs_mut(simd, &mut row[x..x + length])[..count]));
        } else {
            out.rows.fill::<V>(simd, out.row, x..x + length, task);
        }
    }

    /// Field `f` around packs.
    #[inline(always)]
    fn around<'b, V: Pack<Scalar = T>, const K: usize>(
        &'b self,
        simd: V::Simd,
        f: usize,
        window: &'b [Window<T>],
        place: Place,
    ) -> Around<'b, V, K> {
        let Place { x, count, offset } = place;
        let length = count * V::LANES;
        let cross = self.cross(f);
        let mut around = Around { simd, lines: [[&[][..]; K]; 3], closed: [None; 3] };
        let nearby = if K > N { K / 2 } else { R };
        for n in K / 2 - nearby..K / 2 + nearby + 1 {
            let piece = match offset {
                None => &cross.here[x + n - K / 2..][..length],
                Some(offset) => &window[f].0[offset + n - K / 2..][..length],
            };
            around.lines[0][n] = &V::packs(simd, piece)[..count];
        }
        for a in 1..3 {
            for n in 0..K {
                let row = cross.lines[a - 1][n + M / 2 - K / 2];
                // All as long as each other, so that no pack needs to be checked for being there.
                let row = if row.is_empty() { cross.here } else { row };
                around.lines[a][n] = &V::packs(simd, &row[x..x + length])[..count];
            }
        }
        if K > N && f < F {
            for a in 1..3 {
                if let Some((row, data)) = cross.closed[a - 1] {
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

/// Packs side by side, and all around them.
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
    weights: &'a Weights<V, R>,
    unknowns: [Around<'a, V, K>; F],
    given: [Around<'a, V, K>; G],
    count: usize,
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
    /// The unknowns and their rates of change, of an equation along so many axes.
    #[inline(always)]
    fn rates(&self, axes: usize, pack: usize) -> [[V; F]; 2] {
        let mut u = [At::new(&self.unknowns[0], self.weights, axes, pack); F];
        for f in 1..F {
            u[f] = At::new(&self.unknowns[f], self.weights, axes, pack);
        }
        let mut c = [u[0]; G];
        for g in 0..G {
            c[g] = At::new(&self.given[g], self.weights, axes, pack);
        }
        let rates = self.row.sweep.equation.rate(u, c, self.row.dt);
        let mut here = rates;
        for f in 0..F {
            here[f] = u[f].here();
            // Processors foresee no further than the end of a page, which is about that of a row.
            let [_, rows, planes] = &self.unknowns[f].lines;
            let furthest = if u[f].axes() > 2 { planes[K - 1] } else { rows[K - 1] };
            prefetch(furthest, pack + AHEAD);
        }
        [here, rates]
    }

    /// Writes the next state, or the rates. Compiled for each number of axes, so that no pack asks how many there are.
    #[inline(always)]
    fn fill_along<const AXES: usize>(&self, targets: &mut Targets<'_, V::Vector, F>) {
        let advance = self.row.advance;
        for pack in 0..self.count {
            let [here, rates] = self.rates(AXES, pack);
            let mut next = [here[0].vector(); F];
            for f in 0..F {
                next[f] = advance.to(here[f], rates[f]).vector();
            }
            targets.write(pack, next);
        }
    }

    /// Advances what the targets hold.
    #[inline(always)]
    fn onto(self, targets: [&mut [V::Vector]; F]) {
        let advance = self.row.advance;
        for pack in 0..self.count {
            let [here, rates] = self.rates(self.weights.axes, pack);
            for f in 0..F {
                prefetch(targets[f], pack + AHEAD);
                let before = V::of(here[f].simd(), targets[f][pack]);
                targets[f][pack] = advance.onto(here[f], rates[f], before).vector();
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
        match self.weights.axes {
            3 => self.fill_along::<3>(targets),
            2 => self.fill_along::<2>(targets),
            _ => self.fill_along::<1>(targets),
        }
    }
}
