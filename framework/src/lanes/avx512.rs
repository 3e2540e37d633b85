//! The lane operations in AVX-512.

use std::arch::x86_64::*;

use super::{Buffer, Found, RECORD, Record, SUMS, Selection};

/// Whether this processor has what the functions below need.
#[inline]
pub fn is_available() -> bool {
    is_x86_feature_detected!("avx512f")
        && is_x86_feature_detected!("avx512vl")
        && is_x86_feature_detected!("popcnt")
}

/// Points of a vector.
const LANES: usize = 16;

/// The lanes from `j` on that hold one of `n` points.
#[inline]
fn valid(j: usize, n: usize) -> u16 {
    if n - j < LANES { u16::MAX >> (LANES - (n - j)) } else { u16::MAX }
}

/// # Safety
/// AVX-512 F and VL and POPCNT are available, all slices have `selected.found.searched` elements,
/// and its indices and coordinates have room for as many and one vector more.
#[target_feature(enable = "avx512f,avx512vl,popcnt")]
pub unsafe fn near_box<const D: usize>(
    points: [&[f32]; D],
    lower: [f32; D],
    upper: [f32; D],
    radius_squared: f32,
    selected: &mut Selection<D>,
) {
    let Selection { found, points: coordinates } = selected;
    let (radius, step) = (_mm512_set1_ps(radius_squared), _mm512_set1_epi32(LANES as i32));
    let mut index = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    let mut count = found.count;
    for j in (0..found.searched).step_by(LANES) {
        let valid = valid(j, found.searched);
        let mut distance_squared = _mm512_setzero_ps();
        let mut x = [_mm512_setzero_ps(); D];
        for a in 0..D {
            // SAFETY: the valid lanes lie inside the slice; the others are not read.
            x[a] = unsafe { _mm512_maskz_loadu_ps(valid, points[a].as_ptr().add(j)) };
            let below = _mm512_sub_ps(_mm512_set1_ps(lower[a]), x[a]);
            let above = _mm512_sub_ps(x[a], _mm512_set1_ps(upper[a]));
            let d = _mm512_max_ps(_mm512_max_ps(below, above), _mm512_setzero_ps());
            distance_squared = _mm512_fmadd_ps(d, d, distance_squared);
        }
        let near = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(distance_squared, radius) & valid;
        // SAFETY: count is at most j, and there is room for a vector past the last point.
        unsafe {
            let to = found.indices.as_mut_ptr().add(count);
            _mm512_storeu_si512(to.cast(), _mm512_maskz_compress_epi32(near, index));
            for a in 0..D {
                let to = coordinates[a].as_mut_ptr().add(count);
                _mm512_storeu_ps(to, _mm512_maskz_compress_ps(near, x[a]));
            }
        }
        count += near.count_ones() as usize;
        index = _mm512_add_epi32(index, step);
    }
    found.count = count;
}

/// # Safety
/// AVX-512 F and VL and POPCNT are available, and the indices of `found` have room for as many as
/// are selected and one vector more.
#[target_feature(enable = "avx512f,avx512vl,popcnt")]
pub unsafe fn within<const D: usize>(
    selected: &Selection<D>,
    centre: [f32; D],
    radius_squared: f32,
    found: &mut Found,
) {
    let Selection { found: Found { indices, count: n, .. }, points } = selected;
    let radius = _mm512_set1_ps(radius_squared);
    let mut count = found.count;
    for j in (0..*n).step_by(LANES) {
        let mut distance_squared = _mm512_setzero_ps();
        for a in 0..D {
            // SAFETY: a selection has coordinates for a vector past its last point.
            let x = unsafe { _mm512_loadu_ps(points[a].as_ptr().add(j)) };
            let d = _mm512_sub_ps(x, _mm512_set1_ps(centre[a]));
            distance_squared = _mm512_fmadd_ps(d, d, distance_squared);
        }
        let near = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(distance_squared, radius) & valid(j, *n);
        // SAFETY: as for the coordinates; count is at most j, and there is room for a vector past
        // the last point.
        unsafe {
            let index = _mm512_loadu_si512(indices.as_ptr().add(j).cast());
            let to = found.indices.as_mut_ptr().add(count);
            _mm512_storeu_si512(to.cast(), _mm512_maskz_compress_epi32(near, index));
        }
        count += near.count_ones() as usize;
    }
    found.count = count;
}

/// Turns rows into columns.
#[inline]
#[target_feature(enable = "avx512f")]
fn transpose(r: [__m512d; 8]) -> [__m512d; 8] {
    /// Pairs of 128-bit parts (0, 2) of both, and (1, 3) of both.
    const EVEN: i32 = 0b10_00_10_00;
    const ODD: i32 = 0b11_01_11_01;
    let mut columns = [_mm512_setzero_pd(); 8];
    for odd in 0..2 {
        // Elements s of rows (0, 1), (2, 3) ... side by side, s = odd, odd + 2 ...
        let mut pairs = [_mm512_setzero_pd(); 4];
        for k in 0..4 {
            pairs[k] = if odd == 0 {
                _mm512_unpacklo_pd(r[2 * k], r[2 * k + 1])
            } else {
                _mm512_unpackhi_pd(r[2 * k], r[2 * k + 1])
            };
        }
        let [p, q, t, u] = pairs;
        let (a, b) = (_mm512_shuffle_f64x2::<EVEN>(p, q), _mm512_shuffle_f64x2::<EVEN>(t, u));
        columns[odd] = _mm512_shuffle_f64x2::<EVEN>(a, b);
        columns[odd + 4] = _mm512_shuffle_f64x2::<ODD>(a, b);
        let (a, b) = (_mm512_shuffle_f64x2::<ODD>(p, q), _mm512_shuffle_f64x2::<ODD>(t, u));
        columns[odd + 2] = _mm512_shuffle_f64x2::<EVEN>(a, b);
        columns[odd + 6] = _mm512_shuffle_f64x2::<ODD>(a, b);
    }
    columns
}

/// Turns rows into columns, in each half by itself.
#[inline]
#[target_feature(enable = "avx512f")]
fn transpose_halves(r: [__m512; 8]) -> [__m512; 8] {
    // 128-bit parts 0 and 2 of both in turns, and 1 and 3, in pairs of f32.
    let even = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
    let odd = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    let mut fours = [[_mm512_setzero_ps(); 4]; 2];
    for (half, four) in fours.iter_mut().enumerate() {
        let [a, b, c, d] = [r[4 * half], r[4 * half + 1], r[4 * half + 2], r[4 * half + 3]];
        // Elements (0, 1) and (2, 3) of each part, of two rows side by side.
        let (p, q) = (_mm512_unpacklo_ps(a, b), _mm512_unpacklo_ps(c, d));
        let (t, u) = (_mm512_unpackhi_ps(a, b), _mm512_unpackhi_ps(c, d));
        // Element s of four rows, in every part.
        *four = [
            _mm512_shuffle_ps::<0b01_00_01_00>(p, q),
            _mm512_shuffle_ps::<0b11_10_11_10>(p, q),
            _mm512_shuffle_ps::<0b01_00_01_00>(t, u),
            _mm512_shuffle_ps::<0b11_10_11_10>(t, u),
        ];
    }
    let mut columns = [_mm512_setzero_ps(); 8];
    for s in 0..4 {
        let (first, last) = (_mm512_castps_pd(fours[0][s]), _mm512_castps_pd(fours[1][s]));
        columns[s] = _mm512_castpd_ps(_mm512_permutex2var_pd(first, even, last));
        columns[s + 4] = _mm512_castpd_ps(_mm512_permutex2var_pd(first, odd, last));
    }
    columns
}

/// # Safety
/// AVX-512 F is available, every index is inside `from`, there is a multiple of 8 of them, and
/// every lane of `to` is at least as long as `indices`.
#[target_feature(enable = "avx512f")]
pub unsafe fn gather_f64(from: &[Record<f64>], indices: &[u32], to: &mut [Buffer<f64>; RECORD]) {
    let (chunks, _) = indices.as_chunks::<8>();
    for (c, chunk) in chunks.iter().enumerate() {
        let mut rows = [_mm512_setzero_pd(); 8];
        for k in 0..8 {
            // SAFETY: the index is inside `from`; a record is one whole vector.
            rows[k] = unsafe { _mm512_loadu_pd(from.as_ptr().add(chunk[k] as usize).cast()) };
        }
        let columns = transpose(rows);
        for s in 0..RECORD {
            // SAFETY: 8 c + 8 is at most the number of indices, and the lane is as long.
            unsafe { _mm512_storeu_pd(to[s].as_mut_ptr().add(8 * c), columns[s]) };
        }
    }
}

/// Gathers the first half of the records only.
///
/// # Safety
/// As [`gather_f64`].
#[target_feature(enable = "avx512f")]
pub unsafe fn gather_half_f64(
    from: &[Record<f64>],
    indices: &[u32],
    to: &mut [Buffer<f64>; RECORD],
) {
    // 128-bit parts 0 and 2 of both in turns, and 1 and 3.
    let even = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
    let odd = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
    let (chunks, _) = indices.as_chunks::<8>();
    for (c, chunk) in chunks.iter().enumerate() {
        // Those of points k and k + 4.
        let mut r = [_mm512_setzero_pd(); 4];
        for k in 0..4 {
            // SAFETY: the indices are inside `from`; half a record is half a vector.
            r[k] = unsafe {
                let lower = _mm256_loadu_pd(from.as_ptr().add(chunk[k] as usize).cast());
                let upper = _mm256_loadu_pd(from.as_ptr().add(chunk[k + 4] as usize).cast());
                _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(lower), upper)
            };
        }
        let [a, b] = [_mm512_unpacklo_pd(r[0], r[1]), _mm512_unpacklo_pd(r[2], r[3])];
        let [p, q] = [_mm512_unpackhi_pd(r[0], r[1]), _mm512_unpackhi_pd(r[2], r[3])];
        let columns = [
            _mm512_permutex2var_pd(a, even, b),
            _mm512_permutex2var_pd(p, even, q),
            _mm512_permutex2var_pd(a, odd, b),
            _mm512_permutex2var_pd(p, odd, q),
        ];
        for s in 0..RECORD / 2 {
            // SAFETY: 8 c + 8 is at most the number of indices, and the lane is as long.
            unsafe { _mm512_storeu_pd(to[s].as_mut_ptr().add(8 * c), columns[s]) };
        }
    }
}

/// # Safety
/// As [`gather_f64`], with a multiple of 16 indices.
#[target_feature(enable = "avx512f")]
pub unsafe fn gather_f32(from: &[Record<f32>], indices: &[u32], to: &mut [Buffer<f32>; RECORD]) {
    let (chunks, _) = indices.as_chunks::<16>();
    for (c, chunk) in chunks.iter().enumerate() {
        // Those of points k and k + 8.
        let mut rows = [_mm512_setzero_ps(); 8];
        for k in 0..8 {
            // SAFETY: the indices are inside `from`; a record is half a vector.
            let pair = unsafe {
                let lower = _mm256_loadu_pd(from.as_ptr().add(chunk[k] as usize).cast());
                let upper = _mm256_loadu_pd(from.as_ptr().add(chunk[k + 8] as usize).cast());
                _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(lower), upper)
            };
            rows[k] = _mm512_castpd_ps(pair);
        }
        let columns = transpose_halves(rows);
        for s in 0..RECORD {
            // SAFETY: 16 c + 16 is at most the number of indices, and the lane is as long.
            unsafe { _mm512_storeu_ps(to[s].as_mut_ptr().add(16 * c), columns[s]) };
        }
    }
}

/// The inverse of gathering whole records in order.
///
/// # Safety
/// AVX-512 F is available; all of `from` have at least as many elements as `to`, a multiple of 8.
#[target_feature(enable = "avx512f")]
pub unsafe fn interleave_f64(from: [&[f64]; RECORD], to: &mut [Record<f64>]) {
    for k in (0..to.len()).step_by(8) {
        let mut rows = [_mm512_setzero_pd(); 8];
        for s in 0..RECORD {
            // SAFETY: k + 8 is at most the number of elements.
            rows[s] = unsafe { _mm512_loadu_pd(from[s].as_ptr().add(k)) };
        }
        let records = transpose(rows);
        for (i, record) in records.into_iter().enumerate() {
            // SAFETY: k + 8 is at most the number of records, each one whole vector.
            unsafe { _mm512_storeu_pd(to.as_mut_ptr().add(k + i).cast(), record) };
        }
    }
}

/// As [`interleave_f64`].
///
/// # Safety
/// As [`interleave_f64`], with a multiple of 16 records.
#[target_feature(enable = "avx512f")]
pub unsafe fn interleave_f32(from: [&[f32]; RECORD], to: &mut [Record<f32>]) {
    for k in (0..to.len()).step_by(16) {
        let mut rows = [_mm512_setzero_ps(); 8];
        for s in 0..RECORD {
            // SAFETY: k + 16 is at most the number of elements.
            rows[s] = unsafe { _mm512_loadu_ps(from[s].as_ptr().add(k)) };
        }
        // Each half holds a record: of points k + i and k + 8 + i.
        for (i, pair) in transpose_halves(rows).into_iter().enumerate() {
            let pair = _mm512_castps_pd(pair);
            // SAFETY: k + 16 is at most the number of records, each half a vector.
            unsafe {
                let to = to.as_mut_ptr().add(k + i);
                _mm256_storeu_pd(to.cast(), _mm512_castpd512_pd256(pair));
                _mm256_storeu_pd(to.add(8).cast(), _mm512_extractf64x4_pd::<1>(pair));
            }
        }
    }
}

/// Adds the upper half to the lower until one is left, of two vectors of which `high` is the upper half.
#[inline]
#[target_feature(enable = "avx512f")]
fn add_by_halves_f64(low: __m512d, high: __m512d) -> f64 {
    let eight = _mm512_add_pd(low, high);
    let upper = _mm512_extractf64x4_pd::<1>(eight);
    let four = _mm256_add_pd(_mm512_castpd512_pd256(eight), upper);
    let two = _mm_add_pd(_mm256_castpd256_pd128(four), _mm256_extractf128_pd::<1>(four));
    _mm_cvtsd_f64(_mm_add_sd(two, _mm_unpackhi_pd(two, two)))
}

/// As [`add_by_halves_f64`].
#[inline]
#[target_feature(enable = "avx512f")]
fn add_by_halves_f32(all: __m512) -> f32 {
    let upper = _mm512_extractf64x4_pd::<1>(_mm512_castps_pd(all));
    let eight = _mm256_add_ps(_mm512_castps512_ps256(all), _mm256_castpd_ps(upper));
    let four = _mm_add_ps(_mm256_castps256_ps128(eight), _mm256_extractf128_ps::<1>(eight));
    let two = _mm_add_ps(four, _mm_movehl_ps(four, four));
    _mm_cvtss_f32(_mm_add_ss(two, _mm_shuffle_ps::<1>(two, two)))
}

/// # Safety
/// AVX-512 F is available; `a` and all of `b` have the same length, a multiple of `SUMS`.
#[inline]
#[target_feature(enable = "avx512f")]
pub unsafe fn dots_f64<const N: usize>(a: &[f64], b: [&[f64]; N]) -> [f64; N] {
    let (mut low, mut high) = ([_mm512_setzero_pd(); N], [_mm512_setzero_pd(); N]);
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
        sums[n] = add_by_halves_f64(low[n], high[n]);
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
        sums[n] = add_by_halves_f32(lanes[n]);
    }
    sums
}

/// # Safety
/// As [`dots_f64`].
#[inline]
#[target_feature(enable = "avx512f")]
pub unsafe fn raised_dots_f64<const N: usize>(by: f64, a: &[f64], b: [&[f64]; N]) -> [f64; N] {
    let by = _mm512_set1_pd(by);
    let (mut low, mut high) = ([_mm512_setzero_pd(); N], [_mm512_setzero_pd(); N]);
    for k in (0..a.len()).step_by(SUMS) {
        // SAFETY: k + 16 is at most all lengths.
        unsafe {
            let a = a.as_ptr().add(k);
            let first = _mm512_add_pd(by, _mm512_loadu_pd(a));
            let second = _mm512_add_pd(by, _mm512_loadu_pd(a.add(8)));
            for n in 0..N {
                let b = b[n].as_ptr().add(k);
                low[n] = _mm512_fmadd_pd(first, _mm512_loadu_pd(b), low[n]);
                high[n] = _mm512_fmadd_pd(second, _mm512_loadu_pd(b.add(8)), high[n]);
            }
        }
    }
    let mut sums = [0.0; N];
    for n in 0..N {
        sums[n] = add_by_halves_f64(low[n], high[n]);
    }
    sums
}

/// # Safety
/// As [`dots_f64`].
#[inline]
#[target_feature(enable = "avx512f")]
pub unsafe fn raised_dots_f32<const N: usize>(by: f32, a: &[f32], b: [&[f32]; N]) -> [f32; N] {
    let by = _mm512_set1_ps(by);
    let mut lanes = [_mm512_setzero_ps(); N];
    for k in (0..a.len()).step_by(SUMS) {
        // SAFETY: k + 16 is at most all lengths.
        unsafe {
            let first = _mm512_add_ps(by, _mm512_loadu_ps(a.as_ptr().add(k)));
            for n in 0..N {
                lanes[n] = _mm512_fmadd_ps(first, _mm512_loadu_ps(b[n].as_ptr().add(k)), lanes[n]);
            }
        }
    }
    let mut sums = [0.0; N];
    for n in 0..N {
        sums[n] = add_by_halves_f32(lanes[n]);
    }
    sums
}

/// # Safety
/// AVX-512 F is available; all of `a` and `b` have the same length, a multiple of `SUMS`; `N` is not 0.
#[inline]
#[target_feature(enable = "avx512f")]
pub unsafe fn raised_contraction_f64<const N: usize>(
    by: [f64; N],
    a: [&[f64]; N],
    b: [&[f64]; N],
) -> f64 {
    let (mut low, mut high) = ([_mm512_setzero_pd(); N], [_mm512_setzero_pd(); N]);
    for k in (0..a[0].len()).step_by(SUMS) {
        for n in 0..N {
            // SAFETY: k + 16 is at most all lengths.
            unsafe {
                let (a, b) = (a[n].as_ptr().add(k), b[n].as_ptr().add(k));
                let by = _mm512_set1_pd(by[n]);
                let first = _mm512_add_pd(by, _mm512_loadu_pd(a));
                let second = _mm512_add_pd(by, _mm512_loadu_pd(a.add(8)));
                low[n] = _mm512_fmadd_pd(first, _mm512_loadu_pd(b), low[n]);
                high[n] = _mm512_fmadd_pd(second, _mm512_loadu_pd(b.add(8)), high[n]);
            }
        }
    }
    for n in 1..N {
        low[0] = _mm512_add_pd(low[0], low[n]);
        high[0] = _mm512_add_pd(high[0], high[n]);
    }
    add_by_halves_f64(low[0], high[0])
}

/// # Safety
/// As [`raised_contraction_f64`].
#[inline]
#[target_feature(enable = "avx512f")]
pub unsafe fn raised_contraction_f32<const N: usize>(
    by: [f32; N],
    a: [&[f32]; N],
    b: [&[f32]; N],
) -> f32 {
    let mut lanes = [_mm512_setzero_ps(); N];
    for k in (0..a[0].len()).step_by(SUMS) {
        for n in 0..N {
            // SAFETY: k + 16 is at most all lengths.
            unsafe {
                let (a, b) = (a[n].as_ptr().add(k), b[n].as_ptr().add(k));
                let raised = _mm512_add_ps(_mm512_set1_ps(by[n]), _mm512_loadu_ps(a));
                lanes[n] = _mm512_fmadd_ps(raised, _mm512_loadu_ps(b), lanes[n]);
            }
        }
    }
    for n in 1..N {
        lanes[0] = _mm512_add_ps(lanes[0], lanes[n]);
    }
    add_by_halves_f32(lanes[0])
}
