//! What this machine can do at most: move memory, and compute.

use std::hint::black_box;
use std::io;

use finegrain_framework::{Real, Team};

use super::samples::best_seconds;

/// Bytes a second that so many workers together read from one place and write to another, of arrays that
/// take `bytes` in all.
///
/// # Errors
/// If the system refuses threads.
pub fn copy_bandwidth(bytes: usize, workers: usize) -> io::Result<f64> {
    let mut team = Team::new(workers)?;
    let words = (bytes / (2 * size_of::<u64>() * workers)).max(1024);
    // Short arrays are copied many times, so that the clock's resolution does not matter.
    let times = ((1 << 22) / words).max(1);
    let mut arrays: Vec<[Vec<u64>; 2]> =
        (0..workers).map(|_| [vec![1; words], vec![2; words]]).collect();
    let best = best_seconds(20, || {
        team.for_each_chunk(&mut arrays, 1, |_, pairs| {
            for [from, to] in pairs {
                for _ in 0..times {
                    to.copy_from_slice(black_box(from));
                    black_box(&*to);
                }
            }
        });
    });
    Ok((2 * size_of::<u64>() * words * workers * times) as f64 / best)
}

/// Floating-point operations a second of one worker that multiplies and adds in registers, by the widest
/// instructions there are; a multiply-add is two.
pub fn multiply_adds<T: Real>() -> f64 {
    if size_of::<T>() == size_of::<f32>() { multiply_adds_f32() } else { multiply_adds_f64() }
}

macro_rules! multiply_adds {
    ($name:ident, $scalar:ty, $splat:ident, $multiply_add:ident, $sum:ident, $lanes:ident) => {
        fn $name() -> f64 {
            /// As many sums as keep all units busy while each waits for itself.
            const SUMS: usize = 12;
            const ROUNDS: usize = 1 << 16;

            struct Task($scalar);
            impl pulp::WithSimd for Task {
                type Output = ($scalar, usize);

                #[inline(always)]
                fn with_simd<S: pulp::Simd>(self, simd: S) -> Self::Output {
                    let factor = simd.$splat(self.0);
                    let mut sums = [factor; SUMS];
                    for _ in 0..ROUNDS {
                        for sum in &mut sums {
                            *sum = simd.$multiply_add(*sum, factor, factor);
                        }
                    }
                    (sums.into_iter().map(|sum| simd.$sum(sum)).sum(), S::$lanes)
                }
            }
            let mut lanes = 0;
            let best = best_seconds(50, || {
                lanes = black_box(pulp::Arch::new().dispatch(Task(black_box(0.5)))).1;
            });
            (2 * lanes * SUMS * ROUNDS) as f64 / best
        }
    };
}
multiply_adds!(multiply_adds_f64, f64, splat_f64s, mul_add_e_f64s, reduce_sum_f64s, F64_LANES);
multiply_adds!(multiply_adds_f32, f32, splat_f32s, mul_add_e_f32s, reduce_sum_f32s, F32_LANES);
