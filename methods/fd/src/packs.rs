//! Packs of a row: the fields around each, their rates of change, and what becomes of these.

use std::ops::Range;

use finegrain_framework::Real;
use finegrain_framework::pack::{Fill, Pack, Targets, prefetch};

use crate::around::{Around, At, Weights};
use crate::equation::Equation;
use crate::row::{Row, Window};

/// How many packs are asked for before they are needed.
const AHEAD: usize = 16;

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

/// Where packs are: `count` from point `x` on. What is read along the row lies in the row itself, or in the window of
/// an end, from a place on.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub x: usize,
    pub count: usize,
    pub window: Option<(usize, usize)>,
}

/// Rows of unknowns and of given fields along y and z: see [`Row::rows`].
type Rows<'b, T, const F: usize, const G: usize, const K: usize> =
    ([[[&'b [T]; K]; 2]; F], [[[&'b [T]; K]; 2]; G]);

/// Packs of a row from point `start` on.
pub(crate) struct Packs<
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
    pub row: &'a Row<'a, V::Scalar, E, F, G, R, N, M>,
    pub simd: V::Simd,
    pub weights: &'a Weights<V, R>,
    pub windows: &'a [[Window<V::Scalar>; 2]],
    pub places: &'a [Place],
    pub start: usize,
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
    pub fn onto(self, dt_squared: V::Scalar, mut targets: [&mut [V::Vector]; F]) {
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
