//! The stage that computes a term on the rows of a tile.

use finegrain_framework::instructions;
use finegrain_framework::pack::{MOST_LANES, Pack};
use finegrain_framework::space::Grid;
use finegrain_framework::space::grid::RowsMut;
use finegrain_framework::{
    ColumnId, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real, State,
};

use super::around::{At, Coefficients};
use super::equation::Term;
use super::patch::{Beyond, Extent, Patch};

/// What a field of a term is.
#[derive(Clone, Copy)]
pub(crate) enum Source<T> {
    /// A state.
    State(State<T>),
    /// What an earlier stage wrote.
    Rate(Rate<T>),
    /// A rate and, over the time step, the state that changes with it.
    Both(Rate<T>, State<T>),
}

/// A field of a term, and what lies beyond its ends.
#[derive(Clone, Copy)]
pub(crate) struct Field<T> {
    pub source: Source<T>,
    pub beyond: [Beyond; 3],
}

/// The points with one place along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Layer {
    pub axis: usize,
    pub place: usize,
}

/// Computes a term `E` of `F` fields in `D` directions, with operators of order `2 K`.
pub(crate) struct Stencil<T: Real, E, const F: usize, const D: usize, const K: usize> {
    pub term: E,
    pub fields: [Field<T>; F],
    pub out: Vec<Rate<T>>,
    /// Whether it is added to what the columns hold.
    pub adds: bool,
    /// For each column that is written, where it is 0.
    pub zero: Vec<Option<Layer>>,
    pub coefficients: Coefficients<T, D, K>,
}

/// Working memory of one worker.
pub(crate) struct Scratch<T> {
    patches: Vec<Patch<T>>,
    row: Vec<T>,
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self { patches: Vec::new(), row: Vec::new() }
    }
}

impl<T: Real, E: Term<T, F, D, K>, const F: usize, const D: usize, const K: usize> RateStage<Grid>
    for Stencil<T, E, F, D, K>
{
    type Scratch = Scratch<T>;

    fn name(&self) -> &str {
        E::NAME
    }

    fn writes(&self) -> Vec<ColumnId> {
        self.out.iter().map(|out| out.id()).collect()
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        scratch: &mut Scratch<T>,
        moment: &Moment,
    ) -> Result<(), Fault> {
        let extent = self.extent(near);
        scratch.patches.resize_with(F, Patch::default);
        scratch.row.resize(extent.strides()[1], T::zero());
        for (patch, field) in scratch.patches.iter_mut().zip(&self.fields) {
            let fill = |patch: &mut Patch<T>, sum: &[_]| patch.fill(&extent, &field.beyond, sum);
            match field.source {
                Source::State(u) => fill(patch, &[(near.rows(u), T::one())]),
                Source::Rate(u) => fill(patch, &[(near.rate_rows(u), T::one())]),
                Source::Both(rate, state) => {
                    let per_step = T::of(1.0 / moment.dt);
                    fill(patch, &[(near.rate_rows(rate), T::one()), (near.rows(state), per_step)]);
                }
            }
        }
        let Scratch { patches, row } = scratch;
        for i in 0..E::OUT {
            let mut out = rates.rows(self.out[i]);
            let fields = std::array::from_fn(|f| patches[f].values());
            let work = Work { extent, fields, row, out: &mut out };
            instructions::dispatch(Task { stencil: self, i, work });
        }
        Ok(())
    }
}

impl<T: Real, E: Term<T, F, D, K>, const F: usize, const D: usize, const K: usize>
    Stencil<T, E, F, D, K>
{
    fn extent(&self, near: &Near<'_, Grid>) -> Extent {
        let mut rows = near.sub_domain().rows();
        let first = rows.next().unwrap_or_default();
        let last = rows.last().unwrap_or(first);
        let reach = (2 * K - 1).max(2);
        Extent {
            shape: near.domain().shape(),
            first: [first.0, first.1],
            count: [last.0 - first.0 + 1, last.1 - first.1 + 1],
            reach: [reach, if D == 3 { reach } else { 0 }],
        }
    }

    #[inline(always)]
    fn run<V: Pack<Scalar = T>>(&self, simd: V::Simd, i: usize, work: Work<'_, '_, T, F>) {
        let Work { extent, fields, row, out } = work;
        let [nx, ny, nz] = extent.shape;
        let mut near_end = [T::zero(); MOST_LANES];
        for k in 0..extent.count[1] {
            for j in 0..extent.count[0] {
                let place = extent.place(j, k);
                let [y, z] = [extent.first[0] + j, extent.first[1] + k];
                let row_start = At {
                    simd,
                    fields: &fields,
                    strides: extent.strides(),
                    coefficients: &self.coefficients,
                    place,
                };
                let is_near_end =
                    self.term.is_near_end(i, 1, y, ny) || self.term.is_near_end(i, 2, z, nz);
                for x in (0..nx).step_by(V::LANES) {
                    let at = At { place: place + x, ..row_start };
                    let value = if is_near_end {
                        self.term.value_near_end::<V>(i, at)
                    } else {
                        self.term.value::<V>(i, at)
                    };
                    value.store(&mut row[x..x + V::LANES]);
                }
                for x in 0..nx {
                    if !is_near_end && self.term.is_near_end(i, 0, x, nx) {
                        let first = x - x % V::LANES;
                        let at = At { place: place + first, ..row_start };
                        self.term.value_near_end::<V>(i, at).store(&mut near_end);
                        row[x] = near_end[x - first];
                    }
                }
                match self.zero[i] {
                    Some(Layer { axis: 0, place }) => row[place] = T::zero(),
                    Some(Layer { axis, place }) if [0, y, z][axis] == place => {
                        row[..nx].fill(T::zero());
                    }
                    _ => {}
                }
                let out = out.row(y, z);
                if self.adds {
                    out.iter_mut().zip(&row[..nx]).for_each(|(out, &value)| *out += value);
                } else {
                    out.copy_from_slice(&row[..nx]);
                }
            }
        }
    }
}

/// A tile's share.
struct Work<'s, 'n, T, const F: usize> {
    extent: Extent,
    fields: [&'s [T]; F],
    row: &'s mut [T],
    out: &'s mut RowsMut<'n, T>,
}

/// To be compiled for every instruction set.
struct Task<'s, 'n, T: Real, E, const F: usize, const D: usize, const K: usize> {
    stencil: &'s Stencil<T, E, F, D, K>,
    i: usize,
    work: Work<'s, 'n, T, F>,
}

impl<T: Real, E: Term<T, F, D, K>, const F: usize, const D: usize, const K: usize> pulp::WithSimd
    for Task<'_, '_, T, E, F, D, K>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        self.stencil.run::<T::Pack<S>>(simd, self.i, self.work);
    }
}
