//! The scalar type of a computation: `f32` or `f64`.

use std::fmt::{Debug, Display, LowerExp};
use std::iter::Sum;

use bytemuck::Pod;
use num_traits::{Float, FromPrimitive, NumAssign};

/// A floating-point scalar that fields are stored in and methods compute with.
///
/// Implemented for `f32` and `f64`, and for nothing else. Besides the arithmetic of
/// [`num_traits::Float`] it promises plain bytes (columns are checkpointed as they lie in memory)
/// and an exponential that compiles to full-width lanes.
pub trait Real:
    crate::columns::Element
    + crate::lanes::Lanes
    + crate::pack::Packed
    + Float
    + FromPrimitive
    + NumAssign
    + Sum
    + Pod
    + Default
    + Debug
    + Display
    + LowerExp
    + Send
    + Sync
    + 'static
{
    /// The scalar nearest to `value`: exact for `f64`, rounded to nearest for `f32`.
    fn of(value: f64) -> Self;

    /// This scalar as `f64`: always exact.
    fn as_f64(self) -> f64;

    /// The exponential `e^self`, for loops over lanes.
    ///
    /// Unlike [`Float::exp`], which calls the C library one number at a time, this is a straight
    /// run of multiply-adds, integer shifts and selections, so a loop over a slice becomes
    /// full-width SIMD. Every operation in it is exactly specified, so it gives the same bits
    /// whichever instruction set it is compiled for; where there is no fused multiply-add in
    /// hardware, it is slow.
    ///
    /// Valid for every argument:
    /// * while the result is a normal number, at most the next number above or below the C
    ///   library's, so an error of about 1 unit in the last place;
    /// * 0 where `e^self` would be subnormal: below -708.39 in `f64`, -87.33 in `f32`, and at
    ///   minus infinity;
    /// * infinity above the largest finite result (709.78 and 88.72);
    /// * NaN for the NaN that arithmetic produces.
    ///
    /// Method: with the integer `k` nearest to `x / ln 2`, `e^x = 2^k e^r` where
    /// `r = x - k ln 2` lies in `[-ln 2 / 2, ln 2 / 2]` (Muller et al. 2018, Handbook of
    /// Floating-Point Arithmetic, ch. 10); `e^r` is the polynomial `1 + r + c_2 r^2 + ...` of
    /// least largest relative error on that interval (Remez exchange, computed for this file).
    fn exp_lane(self) -> Self;
}

/// Implements [`Real`] for one IEEE 754 format.
macro_rules! impl_real {
    (
        $real:ident,
        ln_2_rest: $ln_2_rest:literal,
        least: $least:literal,
        greatest: $greatest:literal,
        coefficients: $coefficients:expr,
    ) => {
        impl Real for $real {
            #[inline(always)]
            fn of(value: f64) -> Self {
                value as Self
            }

            #[inline(always)]
            fn as_f64(self) -> f64 {
                self.into()
            }

            #[inline(always)]
            fn exp_lane(self) -> Self {
                use std::$real::consts::{LN_2, LOG2_E};

                /// Bits below the exponent field.
                const FRACTION_BITS: u32 = <$real>::MANTISSA_DIGITS - 1;
                /// 3/2 of 2^FRACTION_BITS: numbers near it are whole, so adding it rounds to the
                /// nearest integer and leaves that integer in the low bits.
                const ROUNDER: $real = 1.5 * (1_u64 << FRACTION_BITS) as $real;

                let shifted = self.mul_add(LOG2_E, ROUNDER);
                let k = shifted - ROUNDER;
                // k LN_2 is subtracted without rounding the product; then what LN_2 lacks.
                let r = k.mul_add(-$ln_2_rest, k.mul_add(-LN_2, self));
                let polynomial = $coefficients
                    .into_iter()
                    .rev()
                    .reduce(|sum: $real, coefficient| sum.mul_add(r, coefficient))
                    .unwrap_or_default();
                // Times 2^k: add k to the exponent field; what else `shifted` holds falls off.
                let power = shifted.to_bits() << FRACTION_BITS;
                let exponential = <$real>::from_bits(polynomial.to_bits().wrapping_add(power));

                if self < $least {
                    0.0
                } else if self > $greatest {
                    <$real>::INFINITY
                } else {
                    exponential
                }
            }
        }
    };
}

impl_real!(
    f32,
    // What ln 2 has beyond its rounding to f32.
    ln_2_rest: -1.904_654_3e-9,
    // ln 2^-126: below it the result is subnormal.
    least: -87.336_54,
    // ln of the greatest finite number.
    greatest: 88.722_83,
    // Largest relative error 3.1e-9.
    coefficients: [
        1.0,
        1.0,
        0.499_999_93,
        0.166_665_2,
        0.041_668_39,
        0.008_368_71,
        0.001_381_461_3,
    ],
);

impl_real!(
    f64,
    // What ln 2 has beyond its rounding to f64.
    ln_2_rest: 2.319_046_813_846_299_6e-17,
    // ln 2^-1022: below it the result is subnormal.
    least: -708.396_418_532_264_1,
    // ln of the greatest finite number.
    greatest: 709.782_712_893_384,
    // Largest relative error 3.6e-18.
    coefficients: [
        1.0,
        1.0,
        0.500_000_000_000_001_1,
        0.166_666_666_666_664_13,
        0.041_666_666_666_530_27,
        0.008_333_333_333_494_333,
        0.001_388_888_894_359_770_3,
        0.000_198_412_695_067_807,
        2.480_149_313_617_980_8e-5,
        2.755_758_626_543_375_4e-6,
        2.763_023_392_262_159_4e-7,
        2.500_007_262_041_140_5e-8,
    ],
);

#[cfg(test)]
mod tests {
    use super::*;

    /// Evenly spaced arguments, both ends included.
    fn arguments(from: f64, to: f64, count: u32) -> impl Iterator<Item = f64> {
        (0..=count).map(move |i| from + (to - from) * f64::from(i) / f64::from(count))
    }

    /// Largest difference from the C library's exponential, in units in the last place.
    fn largest_error_f64(from: f64, to: f64) -> f64 {
        arguments(from, to, 1_000_000)
            .map(|x| (x.exp_lane().to_bits().abs_diff(x.exp().to_bits())) as f64)
            .fold(0.0, f64::max)
    }

    /// Largest difference from the exponential in f64, in f32 units in the last place.
    fn largest_error_f32(from: f64, to: f64) -> f64 {
        arguments(from, to, 1_000_000)
            .map(|x| {
                let x = x as f32;
                let exact = x.as_f64().exp();
                let nearest = exact as f32;
                let unit = f32::from_bits(nearest.to_bits() + 1).as_f64() - nearest.as_f64();
                (x.exp_lane().as_f64() - exact).abs() / unit
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn exponential_is_within_one_unit_over_the_kernels_range() {
        assert!(largest_error_f64(-10.8, 0.0) <= 1.0);
        assert!(largest_error_f32(-10.8, 0.0) < 1.0);
    }

    #[test]
    fn exponential_is_within_one_unit_over_the_whole_range() {
        assert!(largest_error_f64(-708.39, 709.78) <= 1.0);
        assert!(largest_error_f32(-87.33, 88.72) < 1.0);
    }

    #[test]
    fn exponential_at_special_arguments() {
        assert_eq!(0.0_f64.exp_lane(), 1.0);
        assert_eq!((-0.0_f64).exp_lane(), 1.0);
        for x in [-708.4, -745.0, -1e6, -1e300, f64::MIN, f64::NEG_INFINITY] {
            assert_eq!(x.exp_lane(), 0.0, "{x}");
        }
        for x in [709.79, 1e6, 1e300, f64::MAX, f64::INFINITY] {
            assert_eq!(x.exp_lane(), f64::INFINITY, "{x}");
        }
        for x in [-708.396_418_532_264, 709.782_712_893_383_9] {
            assert!(x.exp_lane().is_normal(), "{x}");
        }
        assert!(f64::NAN.exp_lane().is_nan());

        assert_eq!(0.0_f32.exp_lane(), 1.0);
        for x in [-87.34, -104.0, -1e30, f32::MIN, f32::NEG_INFINITY] {
            assert_eq!(x.exp_lane(), 0.0, "{x}");
        }
        for x in [88.73, 1e30, f32::MAX, f32::INFINITY] {
            assert_eq!(x.exp_lane(), f32::INFINITY, "{x}");
        }
        for x in [-87.336_53, 88.722_82] {
            assert!(x.exp_lane().is_normal(), "{x}");
        }
        assert!(f32::NAN.exp_lane().is_nan());
    }

    /// Exponentials of `x` into `exponentials`, as a task for [`crate::instructions::dispatch`].
    struct Exponentials<'a, T> {
        x: &'a [T],
        exponentials: &'a mut [T],
    }

    impl<T: Real> pulp::WithSimd for Exponentials<'_, T> {
        type Output = ();

        #[inline(always)]
        fn with_simd<S: pulp::Simd>(self, _: S) {
            for (exponential, x) in self.exponentials.iter_mut().zip(self.x) {
                *exponential = x.exp_lane();
            }
        }
    }

    fn assert_same_bits_in_every_instruction_set<T: Real>(x: &[T]) {
        let baseline: Vec<T> = x.iter().map(|x| x.exp_lane()).collect();
        let mut exponentials = vec![T::zero(); x.len()];
        crate::instructions::dispatch(Exponentials { x, exponentials: &mut exponentials });
        assert_eq!(baseline, exponentials);
    }

    #[test]
    fn exponential_has_the_same_bits_in_every_instruction_set() {
        let x: Vec<f64> = arguments(-720.0, 720.0, 100_003).collect();
        assert_same_bits_in_every_instruction_set(&x);
        let x: Vec<f32> = arguments(-90.0, 90.0, 100_003).map(f32::of).collect();
        assert_same_bits_in_every_instruction_set(&x);
    }

    #[test]
    fn conversion_rounds_to_nearest() {
        assert_eq!(f32::of(0.1), 0.1_f32);
        assert_eq!(f64::of(0.1), 0.1);
        assert_eq!(0.1_f32.as_f64(), f64::from(0.1_f32));
    }
}
