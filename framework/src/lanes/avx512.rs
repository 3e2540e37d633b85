//! The lane operations in AVX-512.

use std::arch::x86_64::*;

use super::{Found, RECORD, Record, search, transpose};

/// Whether this processor has what the functions below need.
#[inline]
pub fn is_available() -> bool {
    is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl")
}

macro_rules! operations {
    (
        $scalar:ty, $lanes:literal, $within:ident,
        $set1:ident, $zero:ident, $load:ident, $sub:ident, $fmadd:ident, $less:ident,
        $iota:expr, $index_set1:ident, $index_add:ident, $compress:ident, $index_store:ident
    ) => {
        /// # Safety
        /// AVX-512 F and VL are available, all slices have `found.searched` elements, and
        /// `found.indices` has room for as many and one vector more.
        #[target_feature(enable = "avx512f,avx512vl")]
        pub unsafe fn $within<const D: usize>(
            points: [&[$scalar]; D],
            centre: [$scalar; D],
            radius_squared: $scalar,
            found: &mut Found,
        ) {
            let whole = found.searched / $lanes * $lanes;
            let radius = $set1(radius_squared);
            let centre_lanes = centre.map(|c| $set1(c));
            let step = $index_set1($lanes);
            let mut index = $iota;
            let mut count = found.count;
            let room = found.indices.as_mut_ptr();
            for j in (0..whole).step_by($lanes) {
                let mut distance_squared = $zero();
                for a in 0..D {
                    // SAFETY: j + lanes is at most the length of the slice.
                    let x = unsafe { $load(points[a].as_ptr().add(j)) };
                    let d = $sub(x, centre_lanes[a]);
                    distance_squared = $fmadd(d, d, distance_squared);
                }
                let near = $less::<_CMP_LT_OQ>(distance_squared, radius);
                // SAFETY: count is at most j, and there is room for a vector past the last point.
                unsafe { $index_store(room.add(count).cast(), $compress(near, index)) };
                count += near.count_ones() as usize;
                index = $index_add(index, step);
            }
            found.count = count;
            search(points, centre, radius_squared, found, whole);
        }
    };
}

operations!(
    f64,
    8,
    within_f64,
    _mm512_set1_pd,
    _mm512_setzero_pd,
    _mm512_loadu_pd,
    _mm512_sub_pd,
    _mm512_fmadd_pd,
    _mm512_cmp_pd_mask,
    _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
    _mm256_set1_epi32,
    _mm256_add_epi32,
    _mm256_maskz_compress_epi32,
    _mm256_storeu_si256
);
operations!(
    f32,
    16,
    within_f32,
    _mm512_set1_ps,
    _mm512_setzero_ps,
    _mm512_loadu_ps,
    _mm512_sub_ps,
    _mm512_fmadd_ps,
    _mm512_cmp_ps_mask,
    _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15),
    _mm512_set1_epi32,
    _mm512_add_epi32,
    _mm512_maskz_compress_epi32,
    _mm512_storeu_si512
);

/// # Safety
/// AVX-512 F is available, every index is inside `from`, and every lane of `to` is at least as
/// long as `indices`.
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
    transpose(from, indices, to, chunks.len() * 8);
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
    transpose(from, indices, to, chunks.len() * 8);
}
