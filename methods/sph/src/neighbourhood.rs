//! What a particle sees of its neighbours: gathered once, into lanes that every term runs over.

use finegrain_framework::lanes::Found;
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::{Cell, CellBlock, Run};
use finegrain_framework::{Near, Rate, Real, State, View};

use crate::fields::Fields;
use crate::kernel::Kernel;

/// Lanes are padded to a multiple of this: two full vectors of f64, one of f32.
pub(crate) const LANES: usize = 16;

/// A quantity of neighbours that terms read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Quantity {
    Velocity(usize),
    Volume,
    PressureTerm,
    WallDepth,
    StressTerm(usize),
}

impl Quantity {
    /// Number of different quantities.
    const COUNT: usize = 12;

    const fn index(self) -> usize {
        match self {
            Self::Velocity(a) => a,
            Self::Volume => 3,
            Self::PressureTerm => 4,
            Self::WallDepth => 5,
            Self::StressTerm(k) => 6 + k,
        }
    }
}

/// Where a quantity is stored.
#[derive(Clone, Copy, Debug)]
enum Source<T> {
    State(State<T>),
    Rate(Rate<T>),
}

/// The quantities that a sweep gathers, with their columns.
#[derive(Clone, Debug)]
pub(crate) struct Gathered<T> {
    position: Vec<State<T>>,
    sources: Vec<(Quantity, Source<T>)>,
}

impl<T: Real> Gathered<T> {
    /// The columns of `quantities`, each once.
    pub fn new(fields: &Fields<T>, mut quantities: Vec<Quantity>) -> Self {
        quantities.sort_unstable();
        quantities.dedup();
        let sources = quantities
            .into_iter()
            .filter_map(|quantity| {
                let source = match quantity {
                    Quantity::Velocity(a) => Source::State(fields.velocity[a]),
                    Quantity::Volume => Source::State(fields.volume),
                    Quantity::PressureTerm => Source::State(fields.pressure_term),
                    Quantity::WallDepth => Source::State(fields.wall_depth?),
                    Quantity::StressTerm(k) => Source::Rate(fields.stress_term[k]),
                };
                Some((quantity, source))
            })
            .collect();
        Self { position: fields.position.clone(), sources }
    }

    fn view<'a>(&self, near: &Near<'a, Cells<T>>, source: Source<T>) -> View<'a, T> {
        match source {
            Source::State(column) => near.state(column),
            Source::Rate(column) => near.rate(column),
        }
    }
}

/// Values of a set of particles, one array a quantity.
#[derive(Clone, Debug)]
struct Values<T, const D: usize> {
    position: [Vec<T>; D],
    quantities: [Vec<T>; Quantity::COUNT],
}

impl<T: Real, const D: usize> Default for Values<T, D> {
    fn default() -> Self {
        Self {
            position: std::array::from_fn(|_| Vec::new()),
            quantities: std::array::from_fn(|_| Vec::new()),
        }
    }
}

/// All particles that may interact with those of one cell.
#[derive(Clone, Debug)]
pub(crate) struct Candidates<T, const D: usize> {
    runs: Vec<Run>,
    values: Values<T, D>,
    /// Place of the cell's own first particle among the candidates.
    own: usize,
}

impl<T: Real, const D: usize> Default for Candidates<T, D> {
    fn default() -> Self {
        Self { runs: Vec::new(), values: Values::default(), own: 0 }
    }
}

impl<T: Real, const D: usize> Candidates<T, D> {
    /// Copies the candidates of `cell`, positions as they are seen from it.
    pub fn collect(
        &mut self,
        gathered: &Gathered<T>,
        near: &Near<'_, Cells<T>>,
        block: &CellBlock<'_, T>,
        cell: Cell,
    ) {
        block.candidates(cell, &mut self.runs);
        self.own = 0;
        for run in &self.runs {
            let is_own = run.shift == [0.0; 3]
                && run.span.start <= cell.span.start
                && cell.span.end <= run.span.end;
            if is_own {
                self.own += cell.span.start - run.span.start;
                break;
            }
            self.own += run.span.len();
        }
        for (a, (&column, values)) in
            gathered.position.iter().zip(&mut self.values.position).enumerate()
        {
            let view = near.state(column);
            values.clear();
            for run in &self.runs {
                let shift = T::of(run.shift[a]);
                let seen = view.at(near.reach(run.owner, run.span));
                values.extend(seen.iter().map(|&x| x + shift));
            }
        }
        for &(quantity, source) in &gathered.sources {
            let view = gathered.view(near, source);
            let values = &mut self.values.quantities[quantity.index()];
            values.clear();
            for run in &self.runs {
                values.extend_from_slice(view.at(near.reach(run.owner, run.span)));
            }
        }
    }

    /// The cell's own particle number `i`.
    #[inline(always)]
    pub fn particle(&self, i: usize) -> Particle<T, D> {
        let i = self.own + i;
        let value = |q: Quantity| self.values.quantities[q.index()].get(i).copied();
        Particle {
            position: std::array::from_fn(|a| self.values.position[a][i]),
            velocity: std::array::from_fn(|a| value(Quantity::Velocity(a)).unwrap_or(T::zero())),
            volume: value(Quantity::Volume).unwrap_or(T::zero()),
            pressure_term: value(Quantity::PressureTerm).unwrap_or(T::zero()),
            wall_depth: value(Quantity::WallDepth).unwrap_or(T::zero()),
            stress_term: std::array::from_fn(|k| {
                value(Quantity::StressTerm(k)).unwrap_or(T::zero())
            }),
        }
    }
}

/// The particle whose rates are wanted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Particle<T, const D: usize> {
    pub position: [T; D],
    pub velocity: [T; D],
    pub volume: T,
    pub pressure_term: T,
    pub wall_depth: T,
    pub stress_term: [T; 6],
}

/// The neighbours of one particle, in lanes; the particle itself is one of them. Padded to whole
/// vectors with neighbours of no effect (gradient factor 0).
#[derive(Clone, Debug)]
pub(crate) struct Neighbours<T, const D: usize> {
    found: Found,
    /// Lanes in use, padding included.
    padded: usize,
    /// `x_i - x_j`, a direction each.
    difference: [Vec<T>; D],
    distance_squared: Vec<T>,
    gradient_factor: Vec<T>,
    values: [Vec<T>; Quantity::COUNT],
}

impl<T: Real, const D: usize> Default for Neighbours<T, D> {
    fn default() -> Self {
        Self {
            found: Found::default(),
            padded: 0,
            difference: std::array::from_fn(|_| Vec::new()),
            distance_squared: Vec::new(),
            gradient_factor: Vec::new(),
            values: std::array::from_fn(|_| Vec::new()),
        }
    }
}

impl<T: Real, const D: usize> Neighbours<T, D> {
    /// Gathers the candidates within the kernel's support of `particle`.
    #[inline(always)]
    pub fn gather(
        &mut self,
        gathered: &Gathered<T>,
        candidates: &Candidates<T, D>,
        particle: &Particle<T, D>,
        kernel: &Kernel<T>,
    ) {
        let support = kernel.support_radius();
        let positions = std::array::from_fn(|a| &candidates.values.position[a][..]);
        T::within(positions, particle.position, support * support, &mut self.found);
        let count = self.found.len();
        let padded = count.next_multiple_of(LANES);
        self.padded = padded;
        if self.distance_squared.len() < padded {
            self.grow(padded);
        }
        let distance_squared = &mut self.distance_squared[..padded];
        distance_squared.fill(T::zero());
        for a in 0..D {
            let difference = &mut self.difference[a][..padded];
            T::gather(&candidates.values.position[a], &self.found, difference);
            let x = particle.position[a];
            difference[count..].fill(x);
            for (d, r2) in difference.iter_mut().zip(&mut *distance_squared) {
                *d = x - *d;
                *r2 = d.mul_add(*d, *r2);
            }
        }
        distance_squared[count..].fill(T::infinity());
        kernel.gradient_factor(distance_squared, &mut self.gradient_factor[..padded]);
        // From here on the padding's distance only has to be finite.
        distance_squared[count..].fill(T::zero());
        for &(quantity, _) in &gathered.sources {
            let q = quantity.index();
            let values = &mut self.values[q][..padded];
            T::gather(&candidates.values.quantities[q], &self.found, values);
            values[count..].fill(T::zero());
        }
    }

    #[cold]
    fn grow(&mut self, length: usize) {
        let all = self
            .difference
            .iter_mut()
            .chain([&mut self.distance_squared, &mut self.gradient_factor])
            .chain(&mut self.values);
        for lanes in all {
            lanes.resize(length, T::zero());
        }
    }

    /// Number of neighbours, the particle itself included.
    #[inline(always)]
    pub fn count(&self) -> usize {
        self.found.len()
    }

    /// `x_i - x_j` along direction `a`.
    #[inline(always)]
    pub fn difference(&self, a: usize) -> &[[T; LANES]] {
        self.difference[a][..self.padded].as_chunks().0
    }

    /// `|x_i - x_j|^2`.
    #[inline(always)]
    pub fn distance_squared(&self) -> &[[T; LANES]] {
        self.distance_squared[..self.padded].as_chunks().0
    }

    /// `F`, with `grad_i W_ij = F (x_i - x_j)`.
    #[inline(always)]
    pub fn gradient_factor(&self) -> &[[T; LANES]] {
        self.gradient_factor[..self.padded].as_chunks().0
    }

    /// A gathered quantity of the neighbours.
    #[inline(always)]
    pub fn values(&self, quantity: Quantity) -> &[[T; LANES]] {
        self.values[quantity.index()][..self.padded].as_chunks().0
    }
}
