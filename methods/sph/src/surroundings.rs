//! All particles that may interact with those of a sub-domain: gathered once, into records.

use std::any::TypeId;
use std::ops::Range;

use finegrain_framework::lanes::{self, Buffer, Found, RECORD, Record, Selection};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::{CellBlock, Run};
use finegrain_framework::{Near, Real, View};

use crate::fields::Column;
use crate::gathered::{ABSENT, Gathered, Layout, Source};
use crate::neighbourhood::Particle;
use crate::quantity::Quantity;
use crate::wall::Extrapolation;

/// All particles that may interact with those of a sub-domain, and of these, those that may interact
/// with the particles of the cell at hand.
#[derive(Clone, Debug)]
pub(crate) struct Surroundings<T, const D: usize> {
    runs: Vec<Run>,
    /// Where all are, from the centre of the sub-domain's own particles and in ranges of the
    /// interaction, however long these are: to search among.
    places: [Buffer<f32>; D],
    /// The range, m.
    range: T,
    /// Where they are seen, less the origin.
    position: [Buffer<T>; D],
    /// By how much a distance may come out longer than it is, in searching, in ranges.
    rounding: f32,
    /// The centre of the sub-domain's own particles where positions are more precise than the rest:
    /// what is rounded then is small. 0 where they are not.
    origin: [f64; D],
    /// Per page, one record a particle.
    pub pages: Vec<Buffer<Record<T>>>,
    /// Where the sub-domain's own particles are among all.
    own: Vec<u32>,
    /// Its cells: the numbers of their particles among its own.
    pub cells: Vec<Range<usize>>,
    /// Whether any of all is in a body.
    pub sees_bodies: bool,
    /// Those within range of the cell at hand.
    near_cell: Selection<D>,
}

impl<T: Real, const D: usize> Default for Surroundings<T, D> {
    fn default() -> Self {
        Self {
            runs: Vec::new(),
            places: std::array::from_fn(|_| Buffer::default()),
            range: T::one(),
            position: std::array::from_fn(|_| Buffer::default()),
            rounding: 0.0,
            origin: [0.0; D],
            pages: Vec::new(),
            own: Vec::new(),
            cells: Vec::new(),
            sees_bodies: false,
            near_cell: Selection::default(),
        }
    }
}

impl<T: Real, const D: usize> Surroundings<T, D> {
    /// Collects what the particles of `block` may see, positions as they are seen from there, to search
    /// for those within `range`, m.
    pub fn collect<P: Real>(
        &mut self,
        gathered: &Gathered<T, P>,
        near: &Near<'_, Cells<P>>,
        block: &CellBlock<'_, P>,
        range: T,
    ) {
        self.range = range;
        block.surroundings(&mut self.runs);
        let span = near.spans()[0];
        self.cells.clear();
        self.cells.extend(block.cells().map(|cell| {
            let Range { start, end } = cell.span.range();
            start - span.start..end - span.start
        }));
        let count = self.runs.iter().map(|run| run.span.len()).sum();
        self.locate(near, span.len());
        self.see(gathered, near, count);
        self.pages.resize_with(gathered.pages.len(), Buffer::default);
        for (page, sources) in self.pages.iter_mut().zip(&gathered.pages) {
            page.resize(count);
            let columns: Record<View<'_, T>> = std::array::from_fn(|s| match sources[s] {
                Source::Position(_) | Source::Nothing => near.state(gathered.any),
                Source::Column(Column::State(column)) => near.state(column),
                Source::Column(Column::Rate(column)) => near.rate(column),
            });
            let mut place = 0;
            for run in &self.runs {
                let places = place..place + run.span.len();
                place = places.end;
                let reach = near.reach(run.owner, run.span);
                let mut values = columns.map(|column| column.at(reach));
                for (values, source) in values.iter_mut().zip(sources) {
                    if let Source::Position(a) = source {
                        *values = &self.position[*a][places.clone()];
                    }
                }
                T::interleave(values, &mut page[places]);
            }
        }
        let depth = gathered.layout.places[Quantity::WallDepth.index()];
        self.sees_bodies = depth != ABSENT
            && self.pages[depth / RECORD].iter().any(|record| record[depth % RECORD] > T::zero());
    }

    /// Number of all.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.places[0].len()
    }

    /// Finds the sub-domain's own particles, of which there are `count`, among all.
    fn locate<P: Real>(&mut self, near: &Near<'_, Cells<P>>, count: usize) {
        let first = near.spans()[0].start;
        self.own.resize(count, 0);
        let mut place = 0;
        for run in &self.runs {
            if run.owner == near.id() && run.shift == [0.0; 3] {
                let own = run.span.start - first..run.span.end - first;
                self.own[own].iter_mut().zip(place..).for_each(|(own, place)| *own = place);
            }
            place += run.span.len() as u32;
        }
    }

    /// Notes where all particles are seen, of which there are `count`.
    fn see<P: Real>(&mut self, gathered: &Gathered<T, P>, near: &Near<'_, Cells<P>>, count: usize) {
        let mut furthest = 0.0f32;
        let per_range = P::of(self.range.as_f64()).recip();
        for a in 0..D {
            let position = near.state(gathered.position[a]);
            let bounds = (P::infinity(), P::neg_infinity());
            let own = position.own().whole();
            let (low, high) = own.iter().fold(bounds, |(low, high), &x| (low.min(x), high.max(x)));
            let centre = P::of(0.5) * (low + high);
            let is_precise = TypeId::of::<P>() != TypeId::of::<T>();
            let origin = if is_precise { centre } else { P::zero() };
            self.origin[a] = origin.as_f64();
            let (places, positions) = (&mut self.places[a], &mut self.position[a]);
            places.resize(count);
            positions.resize(count);
            let (mut places, mut positions) = (&mut places[..], &mut positions[..]);
            for run in &self.runs {
                let (these_places, these_positions);
                (these_places, places) = places.split_at_mut(run.span.len());
                (these_positions, positions) = positions.split_at_mut(run.span.len());
                let shift = P::of(run.shift[a]);
                let values = position.at(near.reach(run.owner, run.span));
                for ((place, position), &x) in
                    these_places.iter_mut().zip(these_positions).zip(values)
                {
                    let seen = x + shift;
                    *place = ((seen - centre) * per_range).as_f64() as f32;
                    *position = T::of((seen - origin).as_f64());
                }
            }
            furthest = furthest.max(largest_magnitude(&self.places[a]));
        }
        // Two places are rounded, and what is computed with them, by half a unit each time.
        self.rounding = 8.0 * f32::EPSILON * furthest;
    }

    /// Selects what lies within range of the box around some of the sub-domain's own particles.
    #[inline(always)]
    pub fn select(&mut self, own: Range<usize>) {
        let (mut lower, mut upper) = ([f32::INFINITY; D], [f32::NEG_INFINITY; D]);
        for &i in &self.own[own] {
            for a in 0..D {
                let x = self.places[a][i as usize];
                lower[a] = lower[a].min(x);
                upper[a] = upper[a].max(x);
            }
        }
        let mut places = [&[][..]; D];
        for a in 0..D {
            places[a] = &self.places[a];
        }
        let range = 1.0 + self.rounding;
        lanes::near_box(places, lower, upper, range * range, &mut self.near_cell);
    }

    /// Finds, near the cell at hand, all that are nearer to `particle` than `radius`, m, and perhaps
    /// some that are little further away.
    #[inline(always)]
    pub fn find(&self, particle: &Particle<T, D>, radius: T, found: &mut Found) {
        let mut centre = [0.0; D];
        for a in 0..D {
            centre[a] = self.places[a][particle.place];
        }
        let radius = (radius / self.range).as_f64() as f32 + self.rounding;
        lanes::within(&self.near_cell, centre, radius * radius, found);
    }

    /// The largest value of a gathered quantity that is not negative, near the cell at hand.
    #[inline(always)]
    pub fn largest(&self, layout: &Layout, quantity: Quantity) -> T {
        let place = layout.places[quantity.index()];
        let mut largest = T::zero();
        for &i in self.near_cell.indices() {
            largest = largest.max(self.pages[place / RECORD][i as usize][place % RECORD]);
        }
        largest
    }

    /// Looks up the sub-domain's own particle number `i`, which sees bodies as they are.
    #[inline(always)]
    pub fn look_up(&self, layout: &Layout, i: usize, particle: &mut Particle<T, D>) {
        let i = self.own[i] as usize;
        particle.place = i;
        for &quantity in &layout.present {
            let place = layout.places[quantity.index()];
            particle.values[quantity] = self.pages[place / RECORD][i][place % RECORD];
        }
        for a in 0..D {
            particle.position[a] = self.position[a][i];
        }
        particle.no_slip = Extrapolation::none();
    }

    /// Where a particle is.
    #[inline(always)]
    pub fn position(&self, particle: &Particle<T, D>) -> [f64; 3] {
        let mut place = [0.0; 3];
        for a in 0..D {
            place[a] = particle.position[a].as_f64() + self.origin[a];
        }
        place
    }
}

/// The largest magnitude of any value, in many lanes.
fn largest_magnitude(values: &[f32]) -> f32 {
    let (groups, rest) = values.as_chunks::<16>();
    let mut largest = [0.0f32; 16];
    for group in groups {
        for (largest, x) in largest.iter_mut().zip(group) {
            *largest = largest.max(x.abs());
        }
    }
    rest.iter().chain(&largest).fold(0.0, |largest, x| largest.max(x.abs()))
}
