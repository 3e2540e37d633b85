//! Fields around a pack of points, as equations see them.

use finegrain_framework::pack::Pack;

use crate::line::Row;
use crate::operator::{Order, central, value};

/// Coefficients of central differences along every axis, for packs.
pub(crate) struct Weights<V, const R: usize> {
    /// Number of axes.
    pub axes: usize,
    first: [[V; R]; 3],
    second: [[V; R]; 3],
    /// Of the point itself in the second derivative.
    here: [V; 3],
    per_spacing: [V; 3],
}

impl<V: Pack, const R: usize> Weights<V, R> {
    #[inline(always)]
    pub fn new(simd: V::Simd, axes: usize, coefficients: &Coefficients<V::Scalar, R>) -> Self {
        let mut weights = Self {
            axes,
            first: [[V::splat(simd, coefficients.first[0][0]); R]; 3],
            second: [[V::splat(simd, coefficients.second[0][0]); R]; 3],
            here: [V::splat(simd, coefficients.here[0]); 3],
            per_spacing: [V::splat(simd, coefficients.per_spacing[0]); 3],
        };
        for a in 0..3 {
            for k in 0..R {
                weights.first[a][k] = V::splat(simd, coefficients.first[a][k]);
                weights.second[a][k] = V::splat(simd, coefficients.second[a][k]);
            }
            weights.here[a] = V::splat(simd, coefficients.here[a]);
            weights.per_spacing[a] = V::splat(simd, coefficients.per_spacing[a]);
        }
        weights
    }
}

/// The same for single points.
#[derive(Clone, Debug)]
pub(crate) struct Coefficients<T, const R: usize> {
    first: [[T; R]; 3],
    second: [[T; R]; 3],
    here: [T; 3],
    per_spacing: [T; 3],
}

impl<T: finegrain_framework::Real, const R: usize> Coefficients<T, R> {
    pub fn new(order: Order, spacing: [f64; 3]) -> Self {
        let (a, b) = (central::first_derivative(order), central::second_derivative(order));
        let here: f64 = b.iter().map(|&b| -2.0 * value(b)).sum();
        Self {
            first: spacing.map(|h| std::array::from_fn(|k| T::of(value(a[k]) / h))),
            second: spacing.map(|h| std::array::from_fn(|k| T::of(value(b[k]) / (h * h)))),
            here: spacing.map(|h| T::of(here / (h * h))),
            per_spacing: spacing.map(|h| T::of(1.0 / h)),
        }
    }
}

/// Coefficients that hold for a whole pack, next to a boundary.
#[derive(Clone, Copy)]
pub(crate) struct Closed<'a, V: Pack> {
    pub row: &'a Row<V::Scalar>,
    /// What is given on the boundary.
    pub data: &'a [V::Vector],
}

/// One field around packs in a row: for each axis and each of `K` shifts along it, the middle one none,
/// the packs there. What is not to be read is empty.
#[derive(Clone, Copy)]
pub(crate) struct Around<'a, V: Pack, const K: usize> {
    pub simd: V::Simd,
    pub lines: [[&'a [V::Vector]; K]; 3],
    pub closed: [Option<Closed<'a, V>>; 3],
}

/// One field around a pack of points next to each other along x.
///
/// What can be asked for lies on the axes through the points: [`At::shifted`], and derivatives along an
/// axis, which know what is different next to a boundary.
#[derive(Clone, Copy)]
pub struct At<'a, V: Pack, const R: usize, const K: usize> {
    around: &'a Around<'a, V, K>,
    weights: &'a Weights<V, R>,
    axes: usize,
    pack: usize,
}

impl<'a, V: Pack, const R: usize, const K: usize> At<'a, V, R, K> {
    #[inline(always)]
    pub(crate) fn new(
        around: &'a Around<'a, V, K>,
        weights: &'a Weights<V, R>,
        axes: usize,
        pack: usize,
    ) -> Self {
        Self { around, weights, axes, pack }
    }

    /// Number of axes.
    #[inline(always)]
    pub fn axes(self) -> usize {
        self.axes
    }

    /// The field here.
    #[inline(always)]
    pub fn here(self) -> V {
        self.shifted(0, 0)
    }

    /// The field so many points further along an axis.
    #[inline(always)]
    pub fn shifted(self, axis: usize, by: isize) -> V {
        // Along every axis the middle is here, and the row along x always has it.
        let line = if by == 0 { &self.around.lines[0] } else { &self.around.lines[axis] };
        let place = (K / 2) as isize + by;
        V::of(self.around.simd, line[place as usize][self.pack])
    }

    /// One over the distance of the points along an axis.
    #[inline(always)]
    pub fn per_spacing(self, axis: usize) -> V {
        self.weights.per_spacing[axis]
    }

    /// The first derivative along an axis.
    #[inline(always)]
    pub fn first_derivative(self, axis: usize) -> V {
        if let Some(closed) = self.near_closed_end(axis) {
            return self.closed(axis, closed, &closed.row.first, closed.row.first_data);
        }
        let weights = &self.weights.first[axis];
        let mut sum = (self.shifted(axis, 1) - self.shifted(axis, -1)) * weights[0];
        for k in 1..R {
            let by = k as isize + 1;
            let difference = self.shifted(axis, by) - self.shifted(axis, -by);
            sum = difference.mul_add(weights[k], sum);
        }
        sum
    }

    /// The second derivative along an axis.
    #[inline(always)]
    pub fn second_derivative(self, axis: usize) -> V {
        if let Some(closed) = self.near_closed_end(axis) {
            return self.closed(axis, closed, &closed.row.second, closed.row.second_data);
        }
        let weights = &self.weights.second[axis];
        let mut sum = self.here() * self.weights.here[axis];
        for k in 0..R {
            let by = k as isize + 1;
            let both = self.shifted(axis, by) + self.shifted(axis, -by);
            sum = both.mul_add(weights[k], sum);
        }
        sum
    }

    /// Lines of no more than the points that central differences read have none, which is known when they are
    /// compiled: what follows reads places that are not, and would keep all the others out of registers.
    #[inline(always)]
    fn near_closed_end(self, axis: usize) -> Option<Closed<'a, V>> {
        if K > 2 * R + 1 { self.around.closed[axis] } else { None }
    }

    #[inline(always)]
    fn closed(
        self,
        axis: usize,
        closed: Closed<'_, V>,
        coefficients: &[V::Scalar],
        data: V::Scalar,
    ) -> V {
        let mut sum = V::of(self.around.simd, closed.data[self.pack]) * data;
        for (by, &c) in (closed.row.from..).zip(coefficients) {
            sum = sum + self.shifted(axis, by) * c;
        }
        sum
    }
}

/// The Laplacian: the sum of the second derivatives.
#[inline(always)]
pub fn laplacian<V: Pack, const R: usize, const K: usize>(u: At<'_, V, R, K>) -> V {
    let mut sum = u.second_derivative(0);
    if u.axes() > 1 {
        sum = sum + u.second_derivative(1);
    }
    if u.axes() > 2 {
        sum = sum + u.second_derivative(2);
    }
    sum
}
