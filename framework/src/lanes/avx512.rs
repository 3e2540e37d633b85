//! The lane operations in AVX-512.

use std::arch::x86_64::*;

use super::{Found, search};

/// Whether this processor has what the functions below need.
#[inline]
pub fn is_available() -> bool {
    is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512vl")
}

macro_rules! operations {
    (
        $scalar:ty, $lanes:literal, $within:ident, $gather:ident,
        $set1:ident, $zero:ident, $load:ident, $sub:ident, $fmadd:ident, $less:ident, $store:ident,
        $iota:expr, $index_set1:ident, $index_add:ident, $compress:ident, $index_store:ident,
        $index_load:ident, $take:ident, $scale:literal
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

        /// # Safety
        /// AVX-512 F and VL are available, every index is inside `from`, and `to` is as long as
        /// `indices`.
        #[target_feature(enable = "avx512f,avx512vl")]
        pub unsafe fn $gather(from: &[$scalar], indices: &[u32], to: &mut [$scalar]) {
            let whole = indices.len() / $lanes * $lanes;
            for k in (0..whole).step_by($lanes) {
                // SAFETY: k + lanes is at most the length of both slices; the indices, below
                // 2^31 elements' worth of memory, are inside `from`.
                unsafe {
                    let index = $index_load(indices.as_ptr().add(k).cast());
                    $store(to.as_mut_ptr().add(k), $take::<$scale>(index, from.as_ptr().cast()));
                }
            }
            for k in whole..indices.len() {
                to[k] = from[indices[k] as usize];
            }
        }
    };
}

operations!(
    f64,
    8,
    within_f64,
    gather_f64,
    _mm512_set1_pd,
    _mm512_setzero_pd,
    _mm512_loadu_pd,
    _mm512_sub_pd,
    _mm512_fmadd_pd,
    _mm512_cmp_pd_mask,
    _mm512_storeu_pd,
    _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7),
    _mm256_set1_epi32,
    _mm256_add_epi32,
    _mm256_maskz_compress_epi32,
    _mm256_storeu_si256,
    _mm256_loadu_si256,
    _mm512_i32gather_pd,
    8
);
operations!(
    f32,
    16,
    within_f32,
    gather_f32,
    _mm512_set1_ps,
    _mm512_setzero_ps,
    _mm512_loadu_ps,
    _mm512_sub_ps,
    _mm512_fmadd_ps,
    _mm512_cmp_ps_mask,
    _mm512_storeu_ps,
    _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15),
    _mm512_set1_epi32,
    _mm512_add_epi32,
    _mm512_maskz_compress_epi32,
    _mm512_storeu_si512,
    _mm512_loadu_si512,
    _mm512_i32gather_ps,
    4
);
