//! All particles that may interact with those of one cell: gathered once a cell, into records.

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

/// The quantities that a sweep gathers, with their columns.
///
/// A candidate's values lie next to each other in records of a cache line: its position first,
/// then the quantities in order.
#[derive(Clone, Debug)]
pub(crate) struct Gathered<T> {
    position: Vec<State<T>>,
    wall_depth: Option<State<T>>,
    /// What the places of all records hold.
    pages: Vec<Record<Source<T>>>,
    /// Place of each quantity in the records; `ABSENT` if the sweep does not gather it.
    pub places: [usize; Quantity::COUNT],
    /// The quantities that have a place.
    present: Vec<Quantity>,
    /// Whether the kernel itself is wanted, beside its gradient factor.
    pub has_kernel: bool,
}

/// No place.
pub(crate) const ABSENT: usize = usize::MAX;

impl<T: Real> Gathered<T> {
    /// The columns of `quantities`, each once.
    pub fn new(fields: &Fields<T>, mut quantities: Vec<Quantity>, has_kernel: bool) -> Self {
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
        Self { position, wall_depth, pages, places, present, has_kernel }
    }

    /// The column of the depth in bodies, if there are bodies.
    pub fn wall_depth(&self) -> Option<State<T>> {
        self.wall_depth
    }

    /// Number of records that a candidate has.
    pub fn page_count(&self) -> usize {
        self.pages.len()
    }
}

/// All particles that may interact with those of one cell.
#[derive(Clone, Debug)]
pub(crate) struct Candidates<T, const D: usize> {
    runs: Vec<Run>,
    near_cell: Found,
    /// Coordinates, as they are seen.
    pub position: [Vec<T>; D],
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
            pages: Vec::new(),
            own: 0,
        }
    }
}

impl<T: Real, const D: usize> Candidates<T, D> {
    /// Collects what lies within `range` of the box around the particles of `cell`, positions as
    /// they are seen from it.
    #[inline(always)]
    pub fn collect(
        &mut self,
        gathered: &Gathered<T>,
        near: &Near<'_, Cells<T>>,
        block: &CellBlock<'_, T>,
        cell: Cell,
        range: T,
    ) {
        let position: [View<'_, T>; D] = std::array::from_fn(|a| near.state(gathered.position[a]));
        let own = near.reach(near.id(), cell.span);
        let bounds: [(T, T); D] = std::array::from_fn(|a| {
            let start = (T::infinity(), T::neg_infinity());
            position[a].at(own).iter().fold(start, |(low, high), &x| (low.min(x), high.max(x)))
        });
        // Shifting the box instead of the particles rounds differently: allow for it.
        let range = range * (T::one() + T::epsilon().sqrt());
        block.candidates(cell, &mut self.runs);
        self.position.iter_mut().for_each(Vec::clear);
        self.pages.resize_with(gathered.pages.len(), Vec::new);
        self.pages.iter_mut().for_each(Vec::clear);
        for run in &self.runs {
            let reach = near.reach(run.owner, run.span);
            let shift = run.shift.map(T::of);
            let points: [&[T]; D] = std::array::from_fn(|a| position[a].at(reach));
            let lower = std::array::from_fn(|a| bounds[a].0 - shift[a]);
            let upper = std::array::from_fn(|a| bounds[a].1 - shift[a]);
            T::near_box(points, lower, upper, range * range, &mut self.near_cell);
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
                let (values, shift) = (points[a], shift[a]);
                self.position[a].extend(found.iter().map(|&i| values[i as usize] + shift));
            }
            for (page, sources) in self.pages.iter_mut().zip(&gathered.pages) {
                let values: Record<&[T]> = std::array::from_fn(|s| match sources[s] {
                    Source::Position(_) | Source::Nothing => points[0],
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
    pub fn largest(&self, gathered: &Gathered<T>, quantity: Quantity) -> T {
        let place = gathered.places[quantity.index()];
        let mut largest = T::zero();
        for record in &self.pages[place / RECORD] {
            largest = largest.max(record[place % RECORD]);
        }
        largest
    }

    /// The cell's own particle number `i`.
    #[inline(always)]
    pub fn particle(&self, gathered: &Gathered<T>, i: usize) -> Particle<T, D> {
        let i = self.own + i;
        let mut values = Values::zero();
        for &quantity in &gathered.present {
            let place = gathered.places[quantity.index()];
            values[quantity] = self.pages[place / RECORD][i][place % RECORD];
        }
        let mut position = [T::zero(); D];
        for a in 0..D {
            position[a] = self.position[a][i];
        }
        Particle::new(position, values)
    }
}
