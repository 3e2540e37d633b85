//! All particles that may interact with those of one cell: gathered once a cell, into records.

use std::any::TypeId;

use finegrain_framework::lanes::{Found, RECORD, Record};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::{Cell, CellBlock, Run};
use finegrain_framework::{Near, Real, State, View};

use crate::fields::{Column, Fields};
use crate::neighbourhood::Particle;
use crate::quantity::{Quantity, Values};

/// What a place of the records holds.
#[derive(Clone, Copy, Debug)]
enum Source<T> {
    /// The coordinate in a direction, as it is seen.
    Position(usize),
    Column(Column<T>),
    /// The place is not used.
    Nothing,
}

/// Where the quantities that a sweep gathers lie in the records of a candidate: its position first,
/// then the quantities in order.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// Place of each quantity in the records; `ABSENT` if the sweep does not gather it.
    pub places: [usize; Quantity::COUNT],
    /// The quantities that have a place.
    present: Vec<Quantity>,
    /// Number of records that a candidate has.
    pub page_count: usize,
    /// Whether the kernel itself is wanted, beside its gradient factor.
    pub has_kernel: bool,
}

/// No place.
pub(crate) const ABSENT: usize = usize::MAX;

/// The quantities that a sweep gathers, with their columns.
///
/// A candidate's values lie next to each other in records of a cache line.
#[derive(Clone, Debug)]
pub(crate) struct Gathered<T, P> {
    position: Vec<State<P>>,
    wall_depth: Option<State<T>>,
    /// A column that is there, for places that hold none.
    any: State<T>,
    /// What the places of all records hold.
    pages: Vec<Record<Source<T>>>,
    /// The same for what does not know the columns.
    pub layout: Layout,
}

impl<T: Real, P: Real> Gathered<T, P> {
    /// The columns of `quantities`, each once.
    pub fn new(fields: &Fields<T, P>, mut quantities: Vec<Quantity>, has_kernel: bool) -> Self {
        quantities.sort_unstable();
        quantities.dedup();
        let mut sources: Vec<_> = (0..fields.position.len()).map(Source::Position).collect();
        let mut places = [ABSENT; Quantity::COUNT];
        let mut present = Vec::new();
        for quantity in quantities {
            let Some(column) = fields.column(quantity) else { continue };
            places[quantity.index()] = sources.len();
            sources.push(Source::Column(column));
            present.push(quantity);
        }
        sources.resize(sources.len().next_multiple_of(RECORD), Source::Nothing);
        let pages = sources.as_chunks().0.to_vec();
        let (position, wall_depth) = (fields.position.clone(), fields.wall_depth);
        let layout = Layout { places, present, page_count: pages.len(), has_kernel };
        Self { position, wall_depth, any: fields.density, pages, layout }
    }

    /// The column of the depth in bodies, if there are bodies.
    pub fn wall_depth(&self) -> Option<State<T>> {
        self.wall_depth
    }
}

/// All particles that may interact with those of one cell.
#[derive(Clone, Debug)]
pub(crate) struct Candidates<T, const D: usize> {
    runs: Vec<Run>,
    near_cell: Found,
    /// Coordinates, as they are seen, less those of the origin.
    pub position: [Vec<T>; D],
    /// The centre of the cell's particles where positions are more precise than the rest: what is
    /// rounded then is small. 0 where they are not.
    origin: [f64; D],
    /// Per page, one record a candidate.
    pub pages: Vec<Vec<Record<T>>>,
    /// Place of the cell's own first particle among the candidates.
    own: usize,
}

impl<T: Real, const D: usize> Default for Candidates<T, D> {
    fn default() -> Self {
        Self {
            runs: Vec::new(),
            near_cell: Found::default(),
            position: std::array::from_fn(|_| Vec::new()),
            origin: [0.0; D],
            pages: Vec::new(),
            own: 0,
        }
    }
}

impl<T: Real, const D: usize> Candidates<T, D> {
    /// Collects what lies within `range` of the box around the particles of `cell`, positions as
    /// they are seen from it.
    #[inline(always)]
    pub fn collect<P: Real>(
        &mut self,
        gathered: &Gathered<T, P>,
        near: &Near<'_, Cells<P>>,
        block: &CellBlock<'_, P>,
        cell: Cell,
        range: T,
    ) {
        let position: [View<'_, P>; D] = std::array::from_fn(|a| near.state(gathered.position[a]));
        let own = near.reach(near.id(), cell.span);
        let bounds: [(P, P); D] = std::array::from_fn(|a| {
            let start = (P::infinity(), P::neg_infinity());
            position[a].at(own).iter().fold(start, |(low, high), &x| (low.min(x), high.max(x)))
        });
        let origin = if TypeId::of::<P>() == TypeId::of::<T>() {
            [P::zero(); D]
        } else {
            bounds.map(|(low, high)| P::of(0.5) * (low + high))
        };
        self.origin = origin.map(P::as_f64);
        let range = P::of(range.as_f64());
        // Shifting the box instead of the particles rounds differently: allow for it.
        let range = range * (P::one() + P::epsilon().sqrt());
        block.candidates(cell, &mut self.runs);
        self.position.iter_mut().for_each(Vec::clear);
        self.pages.resize_with(gathered.pages.len(), Vec::new);
        self.pages.iter_mut().for_each(Vec::clear);
        for run in &self.runs {
            let reach = near.reach(run.owner, run.span);
            let shift = run.shift.map(P::of);
            let points: [&[P]; D] = std::array::from_fn(|a| position[a].at(reach));
            let lower = std::array::from_fn(|a| bounds[a].0 - shift[a]);
            let upper = std::array::from_fn(|a| bounds[a].1 - shift[a]);
            P::near_box(points, lower, upper, range * range, &mut self.near_cell);
            let found = self.near_cell.indices();
            let first = self.position[0].len();
            let is_own = run.shift == [0.0; 3]
                && run.span.start <= cell.span.start
                && cell.span.end <= run.span.end;
            if is_own {
                let start = (cell.span.start - run.span.start) as u32;
                self.own = first + found.partition_point(|&i| i < start);
            }
            for a in 0..D {
                let (values, shift, origin) = (points[a], shift[a], origin[a]);
                let seen = found.iter().map(|&i| values[i as usize] + shift - origin);
                self.position[a].extend(seen.map(|x| T::of(x.as_f64())));
            }
            for (page, sources) in self.pages.iter_mut().zip(&gathered.pages) {
                let values: Record<&[T]> = std::array::from_fn(|s| match sources[s] {
                    Source::Position(_) | Source::Nothing => near.state(gathered.any).at(reach),
                    Source::Column(Column::State(column)) => near.state(column).at(reach),
                    Source::Column(Column::Rate(column)) => near.rate(column).at(reach),
                });
                page.resize(first + found.len(), [T::zero(); RECORD]);
                for (record, &i) in page[first..].iter_mut().zip(found) {
                    for s in 0..RECORD {
                        record[s] = values[s][i as usize];
                    }
                }
                for (s, source) in sources.iter().enumerate() {
                    if let Source::Position(a) = source {
                        let seen = &self.position[*a][first..];
                        for (record, &x) in page[first..].iter_mut().zip(seen) {
                            record[s] = x;
                        }
                    }
                }
            }
        }
    }

    /// The largest value of a gathered quantity that is not negative.
    #[inline(always)]
    pub fn largest(&self, layout: &Layout, quantity: Quantity) -> T {
        let place = layout.places[quantity.index()];
        let mut largest = T::zero();
        for record in &self.pages[place / RECORD] {
            largest = largest.max(record[place % RECORD]);
        }
        largest
    }

    /// The cell's own particle number `i`.
    #[inline(always)]
    pub fn particle(&self, layout: &Layout, i: usize) -> Particle<T, D> {
        let i = self.own + i;
        let mut values = Values::zero();
        for &quantity in &layout.present {
            let place = layout.places[quantity.index()];
            values[quantity] = self.pages[place / RECORD][i][place % RECORD];
        }
        let mut position = [T::zero(); D];
        for a in 0..D {
            position[a] = self.position[a][i];
        }
        Particle::new(position, values)
    }

    /// Where a particle is.
    #[inline(always)]
    pub fn place(&self, particle: &Particle<T, D>) -> [f64; 3] {
        let mut place = [0.0; 3];
        for a in 0..D {
            place[a] = particle.position[a].as_f64() + self.origin[a];
        }
        place
    }
}
