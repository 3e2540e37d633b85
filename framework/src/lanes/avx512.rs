//! The lane operations in AVX-512.

use std::arch::x86_64::*;

use super::{Found, RECORD, Record, SUMS, add_by_halves};

/// Whether this processor has what the functions below need.
#[inline]
pub fn is_available() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("popcnt")
}

/// Defines a search for the points whose displacement, summed in squares over all directions, is
/// shorter than a radius. The names of the operations are those of the calling module.
macro_rules! search {
    ($name:ident, ($($parameter:ident),*), |$x:ident, $a:ident| $displacement:expr) => {
        /// # Safety
        /// AVX-512 F and VL and POPCNT are available, all slices have `found.searched` elements,
        /// and `found.indices` has room for as many and one vector more.
        #[target_feature(enable = "avx512f,avx512vl,popcnt")]
        pub unsafe fn $name<const D: usize>(
            points: [&[Scalar]; D],
            $($parameter: [Scalar; D],)*
            radius_squared: Scalar,
            found: &mut Found,
        ) {
            const LANES: usize = Mask::BITS as usize;
            let radius = set1(radius_squared);
            let step = index_set1(LANES as i32);
            let mut index = iota();
            let mut count = found.count;
            let room = found.indices.as_mut_ptr();
            let whole = found.searched / LANES * LANES;
            for j in (0..whole).step_by(LANES) {
                let mut distance_squared = zero();
                for $a in 0..D {
                    // SAFETY: j + lanes is at most the length of the slice.
                    let $x = unsafe { load(points[$a].as_ptr().add(j)) };
                    let d = $displacement;
                    distance_squared = fmadd(d, d, distance_squared);
                }
                let near = less::<_CMP_LT_OQ>(distance_squared, radius);
                // SAFETY: count is at most j, and there is room for a vector past the last point.
                unsafe { index_store(room.add(count).cast(), compress(near, index)) };
                count += near.count_ones() as usize;
                index = index_add(index, step);
            }
            let rest = found.searched - whole;
            if rest > 0 {
                let valid = Mask::MAX >> (LANES - rest);
                let mut distance_squared = zero();
                for $a in 0..D {
                    // SAFETY: the valid lanes lie inside the slice; the others are not read.
                    let $x = unsafe { load_some(valid, points[$a].as_ptr().add(whole)) };
                    let d = $displacement;
                    distance_squared = fmadd(d, d, distance_squared);
                }
                let near = less::<_CMP_LT_OQ>(distance_squared, radius) & valid;
                // SAFETY: as above.
                unsafe { index_store(room.add(count).cast(), compress(near, index)) };
                count += near.count_ones() as usize;
            }
            found.count = count;
        }
    };
}

/// The searches for one scalar type, in terms of that type's operations.
macro_rules! searches {
    ($within:ident, $near_box:ident) => {
        search!($within, (centre), |x, a| sub(x, set1(centre[a])));
        search!($near_box, (lower, upper), |x, a| {
            max(max(sub(set1(lower[a]), x), sub(x, set1(upper[a]))), zero())
        });
    };
}

mod double {
    use std::arch::x86_64::{
        __m256i, _CMP_LT_OQ, _mm256_add_epi32 as index_add,
        _mm256_maskz_compress_epi32 as compress, _mm256_set1_epi32 as index_set1,
        _mm256_setr_epi32, _mm256_storeu_si256 as index_store, _mm512_cmp_pd_mask as less,
        _mm512_fmadd_pd as fmadd, _mm512_loadu_pd as load, _mm512_maskz_loadu_pd as load_some,
        _mm512_max_pd as max, _mm512_set1_pd as set1, _mm512_setzero_pd as zero,
        _mm512_sub_pd as sub,
    };

    use super::Found;

    type Scalar = f64;
    type Mask = u8;

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn iota() -> __m256i {
        _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7)
    }

    searches!(within_f64, near_box_f64);
}

mod single {
    use std::arch::x86_64::{
        __m512i, _CMP_LT_OQ, _mm512_add_epi32 as index_add, _mm512_cmp_ps_mask as less,
        _mm512_fmadd_ps as fmadd, _mm512_loadu_ps as load, _mm512_maskz_compress_epi32 as compress,
        _mm512_maskz_loadu_ps as load_some, _mm512_max_ps as max, _mm512_set1_epi32 as index_set1,
        _mm512_set1_ps as set1, _mm512_setr_epi32, _mm512_setzero_ps as zero,
        _mm512_storeu_si512 as index_store, _mm512_sub_ps as sub,
    };

    use super::Found;

    type Scalar = f32;
    type Mask = u16;

    #[inline]
    #[target_feature(enable = "avx512f")]
    fn iota() -> __m512i {
        _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15)
    }

    searches!(within_f32, near_box_f32);
}

pub use double::{near_box_f64, within_f64};
pub use single::{near_box_f32, within_f32};

/// # Safety
/// AVX-512 F is available, every index is inside `from`, there is a multiple of 8 of them, and
/// every lane of `to` is at least as long as `indices`.
#[target_feature(enable = "avx512f")]
pub unsafe fn gather_f64(from: &[Record<f64>], indices: &[u32], to: &mut [Vec<f64>; RECORD]) {
    /// Pairs of 128-bit parts (0, 2) of both, and (1, 3) of both.
    const EVEN: i32 = 0b10_00_10_00;
    const ODD: i32 = 0b11_01_11_01;
    let (chunks, _) = indices.as_chunks::<8>();
    for (c, chunk) in chunks.iter().enumerate() {
        // SAFETY: the indices are inside `from`; a record is one whole vector.
        let r = chunk.map(|i| unsafe { _mm512_loadu_pd(from.as_ptr().add(i as usize).cast()) });
        for odd in 0..2 {
            // Elements s of records (0, 1), (2, 3) ... side by side, s = odd, odd + 2 ...
            let pair = |k: usize| {
                if odd == 0 {
                    _mm512_unpacklo_pd(r[k], r[k + 1])
                } else {
                    _mm512_unpackhi_pd(r[k], r[k + 1])
                }
            };
            let [p, q, t, u] = [pair(0), pair(2), pair(4), pair(6)];
            let (a, b) = (_mm512_shuffle_f64x2::<EVEN>(p, q), _mm512_shuffle_f64x2::<EVEN>(t, u));
            let (c0, c4) = (_mm512_shuffle_f64x2::<EVEN>(a, b), _mm512_shuffle_f64x2::<ODD>(a, b));
            let (a, b) = (_mm512_shuffle_f64x2::<ODD>(p, q), _mm512_shuffle_f64x2::<ODD>(t, u));
            let (c2, c6) = (_mm512_shuffle_f64x2::<EVEN>(a, b), _mm512_shuffle_f64x2::<ODD>(a, b));
            for (s, lane) in [(0, c0), (2, c2), (4, c4), (6, c6)] {
                // SAFETY: 8 c + 8 is at most the number of indices, and the lane is as long.
                unsafe { _mm512_storeu_pd(to[s + odd].as_mut_ptr().add(8 * c), lane) };
            }
        }
    }
}

/// # Safety
/// As [`gather_f64`].
#[target_feature(enable = "avx512f")]
pub unsafe fn gather_f32(from: &[Record<f32>], indices: &[u32], to: &mut [Vec<f32>; RECORD]) {
    let (chunks, _) = indices.as_chunks::<8>();
    for (c, chunk) in chunks.iter().enumerate() {
        // SAFETY: the indices are inside `from`; a record is one whole 256-bit vector.
        let r = chunk.map(|i| unsafe { _mm256_loadu_ps(from.as_ptr().add(i as usize).cast()) });
        // Elements (0, 1) and (2, 3) of each half, of two records side by side.
        let low = |k: usize| _mm256_unpacklo_ps(r[k], r[k + 1]);
        let high = |k: usize| _mm256_unpackhi_ps(r[k], r[k + 1]);
        // Element s of four records, in the lower half, and s + 4 in the upper.
        let four = |k: usize| {
            let [p, q, t, u] = [low(k), low(k + 2), high(k), high(k + 2)];
            [
                _mm256_shuffle_ps::<0b01_00_01_00>(p, q),
                _mm256_shuffle_ps::<0b11_10_11_10>(p, q),
                _mm256_shuffle_ps::<0b01_00_01_00>(t, u),
                _mm256_shuffle_ps::<0b11_10_11_10>(t, u),
            ]
        };
        let (first, last) = (four(0), four(4));
        for s in 0..4 {
            let lower = _mm256_permute2f128_ps::<0x20>(first[s], last[s]);
            let upper = _mm256_permute2f128_ps::<0x31>(first[s], last[s]);
            // SAFETY: 8 c + 8 is at most the number of indices, and the lanes are as long.
            unsafe {
                _mm256_storeu_ps(to[s].as_mut_ptr().add(8 * c), lower);
                _mm256_storeu_ps(to[s + 4].as_mut_ptr().add(8 * c), upper);
            }
        }
    }
}

/// # Safety
/// AVX-512 F is available; `a` and all of `b` have the same length, a multiple of `SUMS`.
#[inline]
#[target_feature(enable = "avx512f")]
pub unsafe fn dots_f64<const N: usize>(a: &[f64], b: [&[f64]; N]) -> [f64; N] {
    let mut low = [_mm512_setzero_pd(); N];
    let mut high = [_mm512_setzero_pd(); N];
    for k in (0..a.len()).step_by(SUMS) {
        // SAFETY: k + 16 is at most all lengths.
        unsafe {
            let a = a.as_ptr().add(k);
            let (first, second) = (_mm512_loadu_pd(a), _mm512_loadu_pd(a.add(8)));
            for n in 0..N {
                let b = b[n].as_ptr().add(k);
                low[n] = _mm512_fmadd_pd(first, _mm512_loadu_pd(b), low[n]);
                high[n] = _mm512_fmadd_pd(second, _mm512_loadu_pd(b.add(8)), high[n]);
            }
        }
    }
    let mut sums = [0.0; N];
    for n in 0..N {
        let eight = _mm512_add_pd(low[n], high[n]);
        let upper = _mm512_extractf64x4_pd::<1>(eight);
        let four = _mm256_add_pd(_mm512_castpd512_pd256(eight), upper);
        let two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd::<1>(four));
        sums[n] = _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)));
    }
    sums
}

/// # Safety
/// As [`dots_f64`].
#[inline]
#[target_feature(enable = "avx512f")]
pub unsafe fn dots_f32<const N: usize>(a: &[f32], b: [&[f32]; N]) -> [f32; N] {
    let mut lanes = [_mm512_setzero_ps(); N];
    for k in (0..a.len()).step_by(SUMS) {
        // SAFETY: k + 16 is at most all lengths.
        unsafe {
            let first = _mm512_loadu_ps(a.as_ptr().add(k));
            for n in 0..N {
                lanes[n] = _mm512_fmadd_ps(first, _mm512_loadu_ps(b[n].as_ptr().add(k)), lanes[n]);
            }
        }
    }
    let mut sums = [0.0; N];
    for n in 0..N {
        let mut stored = [0.0; SUMS];
        // SAFETY: `stored` holds 16 elements.
        unsafe { _mm512_storeu_ps(stored.as_mut_ptr(), lanes[n]) };
        sums[n] = add_by_halves(stored);
    }
    sums
}
