//! What a particle sees of its neighbours: gathered once, into lanes that every term runs over.

use std::ops::Index;

use finegrain_framework::lanes::{Found, RECORD, Record};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::{Cell, CellBlock, Run};
use finegrain_framework::{Near, Real, State, View};

use crate::fields::{Column, Fields};
use crate::kernel::Kernel;
use crate::kernel::adaptive::Kernels;
use crate::quantity::{Quantity, Values};
use crate::wall::Extrapolation;

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
    places: [usize; Quantity::COUNT],
    /// The quantities that have a place.
    present: Vec<Quantity>,
    /// Whether the kernel itself is wanted, beside its gradient factor.
    has_kernel: bool,
}

const ABSENT: usize = usize::MAX;

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

    /// What the places of a candidate's records hold.
    fn pages(&self) -> &[Record<Source<T>>] {
        &self.pages
    }
}

/// All particles that may interact with those of one cell.
#[derive(Clone, Debug)]
pub(crate) struct Candidates<T, const D: usize> {
    runs: Vec<Run>,
    near_cell: Found,
    position: [Vec<T>; D],
    /// Per page, one record a candidate.
    pages: Vec<Vec<Record<T>>>,
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
        self.pages.resize_with(gathered.pages().len(), Vec::new);
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
            for (page, sources) in self.pages.iter_mut().zip(gathered.pages()) {
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
        Particle { position, values, no_slip: Extrapolation::none() }
    }
}

/// The particle whose rates are wanted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Particle<T, const D: usize> {
    pub position: [T; D],
    values: Values<T>,
    /// How it sees the velocities of wall particles.
    pub no_slip: Extrapolation<T>,
}

impl<T: Real, const D: usize> Particle<T, D> {
    /// Whether it is part of a body.
    #[inline(always)]
    pub fn is_wall(&self) -> bool {
        self[Quantity::WallDepth] > T::zero()
    }
}

impl<T: Real, const D: usize> Index<Quantity> for Particle<T, D> {
    type Output = T;

    /// A gathered quantity of its own.
    #[inline(always)]
    fn index(&self, quantity: Quantity) -> &T {
        &self.values[quantity]
    }
}

/// The neighbours of one particle, in lanes; the particle itself is one of them. Padded to whole
/// vectors with neighbours of no effect (kernel and gradient factor 0).
#[derive(Clone, Debug)]
pub(crate) struct Neighbours<T, const D: usize> {
    found: Found,
    /// Lanes in use, padding included.
    padded: usize,
    distance_squared: Vec<T>,
    gradient_factor: Vec<T>,
    /// Empty unless every particle has its own smoothing length.
    gradient_factor_of_others: Vec<T>,
    /// Empty if no term wants it.
    kernel: Vec<T>,
    /// Per page of the candidates' records, a lane for each place. In the first, positions have
    /// been replaced by `x_i - x_j`.
    pages: Vec<[Vec<T>; RECORD]>,
    places: [usize; Quantity::COUNT],
}

impl<T: Real, const D: usize> Default for Neighbours<T, D> {
    fn default() -> Self {
        Self {
            found: Found::default(),
            padded: 0,
            distance_squared: Vec::new(),
            gradient_factor: Vec::new(),
            gradient_factor_of_others: Vec::new(),
            kernel: Vec::new(),
            pages: Vec::new(),
            places: [ABSENT; Quantity::COUNT],
        }
    }
}

impl<T: Real, const D: usize> Neighbours<T, D> {
    /// Gathers the candidates that interact with `particle`, with the kernel's values for them.
    /// `longest` is the longest smoothing length of any candidate, where they have their own.
    #[inline(always)]
    pub fn gather(
        &mut self,
        gathered: &Gathered<T>,
        candidates: &Candidates<T, D>,
        particle: &Particle<T, D>,
        kernels: &Kernels<T, D>,
        longest: T,
    ) {
        // One place where the kernel is evaluated: it is compiled for every smoothing function.
        let (kernel, radius) = match kernels {
            Kernels::Uniform(kernel) => (*kernel, kernel.support_radius()),
            Kernels::Adaptive(kernel) => {
                let own = particle[Quantity::SmoothingLength];
                (kernel.at(own), kernel.support() * own.max(longest))
            }
        };
        self.find(gathered, candidates, particle, radius);
        self.evaluate(&kernel);
        if let Kernels::Adaptive(kernel) = kernels {
            let (count, padded) = (self.found.len(), self.padded);
            let place = self.places[Quantity::SmoothingLength.index()];
            let smoothing_length = &self.pages[place / RECORD][place % RECORD][..padded];
            let factor = &mut self.gradient_factor_of_others[..padded];
            kernel.gradient_factor(&self.distance_squared[..padded], smoothing_length, factor);
            factor[count..].fill(T::zero());
        }
    }

    /// Gathers the candidates nearer to `particle` than `radius`.
    #[inline(always)]
    pub fn find(
        &mut self,
        gathered: &Gathered<T>,
        candidates: &Candidates<T, D>,
        particle: &Particle<T, D>,
        radius: T,
    ) {
        // On a lattice many pairs are exactly the support apart, and rounding would decide, for
        // each of the two by itself, whether they interact: leave them all out.
        let support = radius * (T::one() - T::epsilon().sqrt());
        let positions = std::array::from_fn(|a| &candidates.position[a][..]);
        T::within(positions, particle.position, support * support, &mut self.found);
        let padded = self.found.padded();
        self.padded = padded;
        if self.distance_squared.len() < padded || self.pages.len() != gathered.pages().len() {
            self.grow(padded, gathered);
        }
        for (page, records) in self.pages.iter_mut().zip(&candidates.pages) {
            T::gather(records, &self.found, page);
        }
        let distance_squared = &mut self.distance_squared[..padded];
        distance_squared.fill(T::zero());
        for a in 0..D {
            let x = particle.position[a];
            let difference = &mut self.pages[0][a][..padded];
            for (d, r2) in difference.iter_mut().zip(&mut *distance_squared) {
                *d = x - *d;
                *r2 = d.mul_add(*d, *r2);
            }
        }
    }

    /// The kernel's values for what was found.
    #[inline(always)]
    pub fn evaluate(&mut self, kernel: &Kernel<T>) {
        let (count, padded) = (self.found.len(), self.padded);
        let distance_squared = &self.distance_squared[..padded];
        let gradient_factor = &mut self.gradient_factor[..padded];
        if !self.kernel.is_empty() {
            let values = &mut self.kernel[..padded];
            kernel.evaluate(distance_squared, values, gradient_factor);
            values[count..].fill(T::zero());
        } else {
            kernel.gradient_factor(distance_squared, gradient_factor);
        }
        // The padding repeats a neighbour: it must have no effect.
        gradient_factor[count..].fill(T::zero());
    }

    #[cold]
    fn grow(&mut self, length: usize, gathered: &Gathered<T>) {
        self.places = gathered.places;
        let has_own_lengths = self.places[Quantity::SmoothingLength.index()] != ABSENT;
        self.pages.resize_with(gathered.pages().len(), || std::array::from_fn(|_| Vec::new()));
        let all = self
            .pages
            .iter_mut()
            .flatten()
            .chain([&mut self.distance_squared, &mut self.gradient_factor])
            .chain(gathered.has_kernel.then_some(&mut self.kernel))
            .chain(has_own_lengths.then_some(&mut self.gradient_factor_of_others));
        for lanes in all {
            lanes.resize(length.max(lanes.len()), T::zero());
        }
    }

    /// `x_i - x_j` along direction `a`.
    #[inline(always)]
    pub fn difference(&self, a: usize) -> &[T] {
        &self.pages[0][a][..self.padded]
    }

    /// `sum_j weight_j (x_i - x_j)`.
    #[inline(always)]
    pub fn sum_differences(&self, weight: &[T]) -> [T; D] {
        let mut differences = [weight; D];
        for a in 0..D {
            differences[a] = self.difference(a);
        }
        T::dots(weight, differences)
    }

    /// `|x_i - x_j|^2`.
    #[inline(always)]
    pub fn distance_squared(&self) -> &[T] {
        &self.distance_squared[..self.padded]
    }

    /// `F`, with `grad_i W_ij = F (x_i - x_j)`.
    #[inline(always)]
    pub fn gradient_factor(&self) -> &[T] {
        &self.gradient_factor[..self.padded]
    }

    /// `F` with the neighbours' smoothing lengths, where they have their own.
    #[inline(always)]
    pub fn gradient_factor_of_others(&self) -> &[T] {
        &self.gradient_factor_of_others[..self.padded]
    }

    /// Writes `(v_i - v_j) . (x_i - x_j)`, below 0 for particles that approach.
    #[inline(always)]
    pub fn velocity_jump(&self, i: &Particle<T, D>, jump: &mut [T]) {
        jump.fill(T::zero());
        for a in 0..D {
            let own = i[Quantity::Velocity(a)];
            let (v, dx) = (self.values(Quantity::Velocity(a)), self.difference(a));
            for ((jump, &v), &dx) in jump.iter_mut().zip(v).zip(dx) {
                *jump = (own - v).mul_add(dx, *jump);
            }
        }
    }

    /// `W_ij`; only for terms that say that they use it.
    #[inline(always)]
    pub fn kernel(&self) -> &[T] {
        &self.kernel[..self.padded]
    }

    /// Depth of the neighbours below the surface of a body, if there are bodies.
    #[inline(always)]
    pub fn wall_depth(&self) -> Option<&[T]> {
        (self.places[Quantity::WallDepth.index()] != ABSENT)
            .then(|| self.values(Quantity::WallDepth))
    }

    /// Writes `W_ij` for neighbours in the fluid, and 0 for those in bodies.
    #[inline(always)]
    pub fn kernel_in_fluid(&self, weight: &mut [T]) {
        weight.copy_from_slice(self.kernel());
        self.leave_out_bodies(weight);
    }

    /// Sets the weights of neighbours in bodies to 0.
    #[inline(always)]
    pub fn leave_out_bodies(&self, weight: &mut [T]) {
        for (weight, &depth) in weight.iter_mut().zip(self.wall_depth().into_iter().flatten()) {
            *weight = if depth > T::zero() { T::zero() } else { *weight };
        }
    }

    /// A gathered quantity of the neighbours.
    #[inline(always)]
    pub fn values(&self, quantity: Quantity) -> &[T] {
        let place = self.places[quantity.index()];
        &self.pages[place / RECORD][place % RECORD][..self.padded]
    }
}
