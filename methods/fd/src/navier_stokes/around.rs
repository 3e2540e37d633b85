//! Fields around a pack of points next to each other along x, and staggered operators on them.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use crate::operator::staggered::{self, StaggeredOrder};
use crate::operator::{Order, central, value};

/// Coefficients of operators that read `K` points to either side of a place half-way between points.
#[derive(Clone, Debug)]
pub(crate) struct Coefficients<T, const D: usize, const K: usize> {
    mean: [T; K],
    derivative: [[T; K]; D],
    second: [[T; K]; D],
    second_here: [T; D],
}

impl<T: Real, const D: usize, const K: usize> Coefficients<T, D, K> {
    /// Of the order `2 K` with these spacings, m.
    pub fn new(spacing: [f64; 3]) -> Self {
        let (staggered, central) = match K {
            1 => (StaggeredOrder::Second, Order::Second),
            _ => (StaggeredOrder::Fourth, Order::Fourth),
        };
        let [mean, derivative] = [staggered::mean(staggered), staggered::derivative(staggered)]
            .map(|all| {
                let values: [f64; K] = std::array::from_fn(|k| value(all[k]));
                values
            });
        let b = central::second_derivative(central);
        let here: f64 = b.iter().map(|&b| -2.0 * value(b)).sum();
        let h = |a: usize| spacing[a];
        Self {
            mean: mean.map(T::of),
            derivative: std::array::from_fn(|a| derivative.map(|c| T::of(c / h(a)))),
            second: std::array::from_fn(|a| {
                std::array::from_fn(|k| T::of(value(b[k]) / (h(a) * h(a))))
            }),
            second_here: std::array::from_fn(|a| T::of(here / (h(a) * h(a)))),
        }
    }
}

/// The fields around a pack of points.
#[derive(Clone, Copy)]
pub(crate) struct At<'a, V: Pack, const F: usize, const D: usize, const K: usize> {
    pub simd: V::Simd,
    pub fields: &'a [&'a [V::Scalar]; F],
    pub strides: [usize; 3],
    pub coefficients: &'a Coefficients<V::Scalar, D, K>,
    /// Where the first point lies.
    pub place: usize,
}

impl<'a, V: Pack, const F: usize, const D: usize, const K: usize> At<'a, V, F, D, K> {
    /// The same fields with other operators.
    #[inline(always)]
    pub fn with<const L: usize>(
        self,
        coefficients: &'a Coefficients<V::Scalar, D, L>,
    ) -> At<'a, V, F, D, L> {
        let Self { simd, fields, strides, place, .. } = self;
        At { simd, fields, strides, coefficients, place }
    }

    /// Field `f` so many points further along axis `a`.
    #[inline(always)]
    pub fn shifted(self, f: usize, a: usize, by: isize) -> V {
        self.load(f, by * self.strides[a] as isize)
    }

    /// Field `f`, of whose points this one lies one half further along axis `b`, `by` points along axis `a`: a mean
    /// along `b`.
    #[inline(always)]
    pub fn mean(self, f: usize, b: usize, a: usize, by: isize) -> V {
        let (along, start) = (self.strides[b] as isize, by * self.strides[a] as isize);
        let mean = self.coefficients.mean;
        let mut sum = (self.load(f, start) + self.load(f, start - along)) * mean[0];
        for k in 1..K {
            let far = k as isize * along;
            let pair = self.load(f, start + far) + self.load(f, start - along - far);
            sum = sum + pair * mean[k];
        }
        sum
    }

    /// `d/dx_a` half a spacing below, from differences of points `2 k + 1` apart.
    #[inline(always)]
    pub fn derivative_below(self, f: usize, a: usize) -> V {
        self.derivative(f, a, 0)
    }

    /// `d/dx_a` half a spacing above.
    #[inline(always)]
    pub fn derivative_above(self, f: usize, a: usize) -> V {
        self.derivative(f, a, 1)
    }

    #[inline(always)]
    fn derivative(self, f: usize, a: usize, from: isize) -> V {
        let weights = self.coefficients.derivative[a];
        let mut sum = (self.shifted(f, a, from) - self.shifted(f, a, from - 1)) * weights[0];
        for k in 1..K {
            let by = k as isize;
            let difference = self.shifted(f, a, from + by) - self.shifted(f, a, from - 1 - by);
            sum = sum + difference * weights[k];
        }
        sum
    }

    /// The coefficient of differences of points `2 k + 1` apart in `d/dx_a`, half-way.
    #[inline(always)]
    pub fn derivative_weight(self, a: usize, k: usize) -> V::Scalar {
        self.coefficients.derivative[a][k]
    }

    /// `d^2/dx_a^2`.
    #[inline(always)]
    pub fn second_derivative(self, f: usize, a: usize) -> V {
        let mut sum = self.load(f, 0) * self.coefficients.second_here[a];
        for k in 0..K {
            let by = k as isize + 1;
            let pair = self.shifted(f, a, by) + self.shifted(f, a, -by);
            sum = sum + pair * self.coefficients.second[a][k];
        }
        sum
    }

    #[inline(always)]
    fn load(self, f: usize, by: isize) -> V {
        let place = (self.place as isize + by) as usize;
        V::load(self.simd, &self.fields[f][place..place + V::LANES])
    }
}
