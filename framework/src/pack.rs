//! Full vectors of scalars, for kernels with too many arrays for the compiler to vectorise a loop
//! over them by itself.
//!
//! A kernel is written once over a [`Pack`] and run for the instruction set that
//! [`crate::instructions::dispatch`] finds. Every operation is exactly rounded and only
//! [`Pack::mul_add`] is fused, so a number comes out with the same bits in whatever place of whatever
//! pack it is computed.

mod bypass;
mod prefetch;

pub(crate) use bypass::{Bypass, Fence, fence};
pub use bypass::{Fill, Targets};
pub use prefetch::prefetch;

use std::ops::{Add, Div, Mul, Neg, Sub};

use pulp::Simd;

use crate::real::Real;

/// One full vector of scalars for one instruction set.
pub trait Pack:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<Self::Scalar, Output = Self>
    + Mul<Self::Scalar, Output = Self>
{
    /// Its elements.
    type Scalar: Real;
    /// The instruction set.
    type Simd: Simd;
    /// Number of elements.
    const LANES: usize;

    /// The same number in all places.
    fn splat(simd: Self::Simd, value: Self::Scalar) -> Self;

    /// The instruction set.
    fn simd(self) -> Self::Simd;

    /// The same number in all places, for the instruction set of `self`.
    #[inline(always)]
    fn splat_like(self, value: Self::Scalar) -> Self {
        Self::splat(self.simd(), value)
    }

    /// `self * by + plus`, rounded once.
    fn mul_add(self, by: Self, plus: Self) -> Self;

    /// The absolute value of each.
    fn abs(self) -> Self;

    /// The square root of each.
    fn sqrt(self) -> Self;

    /// The larger of each two. Where one is not a number, either may come out.
    fn max(self, other: Self) -> Self;

    /// The smaller of each two. Where one is not a number, either may come out.
    fn min(self, other: Self) -> Self;

    /// `from` as whole packs; what is left at its end is dropped.
    fn packs(simd: Self::Simd, from: &[Self::Scalar]) -> &[Self::Vector];

    /// As [`Pack::packs`], to be written.
    fn packs_mut(simd: Self::Simd, to: &mut [Self::Scalar]) -> &mut [Self::Vector];

    /// What memory holds of a pack.
    type Vector: bytemuck::Pod;

    /// A pack from memory.
    fn of(simd: Self::Simd, vector: Self::Vector) -> Self;

    /// What to write to memory.
    fn vector(self) -> Self::Vector;

    /// The first elements of `from`.
    ///
    /// # Panics
    /// If there are fewer than [`Pack::LANES`].
    #[inline(always)]
    fn load(simd: Self::Simd, from: &[Self::Scalar]) -> Self {
        Self::of(simd, Self::packs(simd, from)[0])
    }

    /// Writes the first elements of `to`.
    ///
    /// # Panics
    /// If there are fewer than [`Pack::LANES`].
    #[inline(always)]
    fn store(self, to: &mut [Self::Scalar]) {
        Self::packs_mut(self.simd(), to)[0] = self.vector();
    }
}

/// Most elements that a pack of any scalar has on any instruction set.
pub const MOST_LANES: usize = 16;

/// A scalar that packs are made of.
pub trait Packed: Sized {
    /// Its packs for an instruction set.
    type Pack<S: Simd>: Pack<Scalar = Self, Simd = S>;
}

macro_rules! packed {
    (
        $scalar:ident, $pack:ident, $vector:ident, $lanes:ident, $splat:ident,
        $packs:ident, $packs_mut:ident, $add:ident, $sub:ident, $mul:ident, $div:ident, $neg:ident,
        $mul_add:ident, $abs:ident, $sqrt:ident, $max:ident, $min:ident
    ) => {
        #[doc = concat!("A pack of `", stringify!($scalar), "`.")]
        #[derive(Clone, Copy)]
        pub struct $pack<S: Simd> {
            simd: S,
            vector: S::$vector,
        }

        impl Packed for $scalar {
            type Pack<S: Simd> = $pack<S>;
        }

        impl<S: Simd> Pack for $pack<S> {
            type Scalar = $scalar;
            type Simd = S;
            type Vector = S::$vector;
            const LANES: usize = S::$lanes;

            #[inline(always)]
            fn splat(simd: S, value: $scalar) -> Self {
                Self { simd, vector: simd.$splat(value) }
            }

            #[inline(always)]
            fn simd(self) -> S {
                self.simd
            }

            #[inline(always)]
            fn mul_add(self, by: Self, plus: Self) -> Self {
                let vector = self.simd.$mul_add(self.vector, by.vector, plus.vector);
                Self { simd: self.simd, vector }
            }

            #[inline(always)]
            fn abs(self) -> Self {
                Self { simd: self.simd, vector: self.simd.$abs(self.vector) }
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                Self { simd: self.simd, vector: self.simd.$sqrt(self.vector) }
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                Self { simd: self.simd, vector: self.simd.$max(self.vector, other.vector) }
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                Self { simd: self.simd, vector: self.simd.$min(self.vector, other.vector) }
            }

            #[inline(always)]
            fn packs(_: S, from: &[$scalar]) -> &[S::$vector] {
                S::$packs(from).0
            }

            #[inline(always)]
            fn packs_mut(_: S, to: &mut [$scalar]) -> &mut [S::$vector] {
                S::$packs_mut(to).0
            }

            #[inline(always)]
            fn of(simd: S, vector: S::$vector) -> Self {
                Self { simd, vector }
            }

            #[inline(always)]
            fn vector(self) -> S::$vector {
                self.vector
            }
        }

        packed!(@ $pack, Add, add, $add);
        packed!(@ $pack, Sub, sub, $sub);
        packed!(@ $pack, Mul, mul, $mul);
        packed!(@ $pack, Div, div, $div);

        impl<S: Simd> Neg for $pack<S> {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                Self { simd: self.simd, vector: self.simd.$neg(self.vector) }
            }
        }

        impl<S: Simd> Add<$scalar> for $pack<S> {
            type Output = Self;

            #[inline(always)]
            fn add(self, value: $scalar) -> Self {
                self + Self::splat(self.simd, value)
            }
        }

        impl<S: Simd> Mul<$scalar> for $pack<S> {
            type Output = Self;

            #[inline(always)]
            fn mul(self, value: $scalar) -> Self {
                self * Self::splat(self.simd, value)
            }
        }
    };
    (@ $pack:ident, $trait:ident, $operator:ident, $operation:ident) => {
        impl<S: Simd> $trait for $pack<S> {
            type Output = Self;

            #[inline(always)]
            fn $operator(self, other: Self) -> Self {
                Self { simd: self.simd, vector: self.simd.$operation(self.vector, other.vector) }
            }
        }
    };
}

packed!(
    f32,
    PackF32,
    f32s,
    F32_LANES,
    splat_f32s,
    as_simd_f32s,
    as_mut_simd_f32s,
    add_f32s,
    sub_f32s,
    mul_f32s,
    div_f32s,
    neg_f32s,
    mul_add_f32s,
    abs_f32s,
    sqrt_f32s,
    max_f32s,
    min_f32s
);
packed!(
    f64,
    PackF64,
    f64s,
    F64_LANES,
    splat_f64s,
    as_simd_f64s,
    as_mut_simd_f64s,
    add_f64s,
    sub_f64s,
    mul_f64s,
    div_f64s,
    neg_f64s,
    mul_add_f64s,
    abs_f64s,
    sqrt_f64s,
    max_f64s,
    min_f64s
);

#[cfg(test)]
mod tests {
    use super::*;

    /// `y = sqrt(|q - x|) - max(q, x)` with `q = (2 x + y) / (1 - x y)`, twice with one rounding for both
    /// operations, over whole packs.
    struct Task<'a, T> {
        x: &'a [T],
        y: &'a mut [T],
    }

    impl<T: Real> pulp::WithSimd for Task<'_, T> {
        type Output = usize;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> usize {
            let lanes = <T::Pack<S> as Pack>::LANES;
            assert!(lanes <= MOST_LANES && MOST_LANES.is_multiple_of(lanes));
            let x = T::Pack::<S>::packs(simd, self.x);
            for (y, &x) in T::Pack::<S>::packs_mut(simd, self.y).iter_mut().zip(x) {
                let (a, b) = (T::Pack::<S>::of(simd, x), T::Pack::<S>::of(simd, *y));
                let one = a.splat_like(T::one());
                let quotient = a.mul_add(a.splat_like(T::of(2.0)), b) / (-a).mul_add(b, one);
                let (greater, less) = (quotient.max(a), quotient.min(a));
                *y = ((greater - less).abs().sqrt() - greater).vector();
            }
            lanes
        }
    }

    fn same_bits_on_every_instruction_set<T: Real>() {
        let x: Vec<T> = (0..1003).map(|i| T::of(f64::from(i) / 777.0 - 0.5)).collect();
        let y: Vec<T> = x.iter().map(|x| x.sin() * T::of(0.7)).collect();
        let mut expected = y.clone();
        for (y, &x) in expected.iter_mut().zip(&x) {
            let quotient = x.mul_add(T::of(2.0), *y) / (-x).mul_add(*y, T::one());
            *y = (quotient - x).abs().sqrt() - quotient.max(x);
        }
        let mut now = y.clone();
        let lanes = crate::instructions::dispatch(Task { x: &x, y: &mut now });
        let whole = x.len() / lanes * lanes;
        assert_eq!(now[..whole], expected[..whole]);
        assert_eq!(now[whole..], y[whole..]);
        let mut scalar = y.clone();
        Task { x: &x, y: &mut scalar }.with_simd_scalar();
        assert_eq!(scalar, expected);
    }

    impl<T: Real> Task<'_, T> {
        fn with_simd_scalar(self) {
            pulp::WithSimd::with_simd(self, pulp::Scalar);
        }
    }

    #[test]
    fn numbers_have_the_same_bits_in_every_pack() {
        same_bits_on_every_instruction_set::<f32>();
        same_bits_on_every_instruction_set::<f64>();
    }
}
