//! Lanes that need more than the compiler finds by itself: selecting the points within a radius,
//! and gathering their values into contiguous blocks.
//!
//! One of the few modules with `unsafe`, so that methods need none: the instruction set is chosen
//! at run time and every call is safe. All instruction sets give the same bits.

#[cfg(target_arch = "x86_64")]
mod avx512;
mod buffer;

use bytemuck::Pod;

pub use buffer::Buffer;

/// Name of the instruction set that lanes are computed with on this processor. Runs on one kind of
/// processor agree bit for bit; across kinds that is meant, and tested where it can be, but not
/// promised.
pub fn instruction_set() -> &'static str {
    #[cfg(target_arch = "x86_64")]
    {
        if avx512::is_available() {
            return "x86-64 with AVX-512";
        }
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            return "x86-64 with AVX2";
        }
    }
    std::env::consts::ARCH
}

/// Points that [`near_box`] has selected, with their coordinates, for [`within`] to search.
#[derive(Clone, Debug)]
pub struct Selection<const D: usize> {
    found: Found,
    /// Coordinates of the points found, and room to write whole lanes beyond.
    points: [Buffer<f32>; D],
}

impl<const D: usize> Default for Selection<D> {
    fn default() -> Self {
        Self { found: Found::default(), points: std::array::from_fn(|_| Buffer::default()) }
    }
}

impl<const D: usize> Selection<D> {
    /// Indices of the points, ascending, into the slices they were selected from.
    pub fn indices(&self) -> &[u32] {
        self.found.indices()
    }

    /// Makes room for a selection among `points` points.
    fn prepare(&mut self, points: usize) {
        self.found.prepare(points);
        for coordinates in &mut self.points {
            if coordinates.len() < points + SUMS {
                coordinates.resize(points + SUMS);
            }
        }
    }
}

/// Points that [`within`] has found, by index into the slices that its selection was made
/// from.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The first `count` are found; beyond them there is room to write whole lanes.
    indices: Buffer<u32>,
    count: usize,
    /// Length of the slices that indices are into: every found index is below it.
    searched: usize,
}

impl Found {
    /// Number of points found.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether none was found.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Their indices, ascending.
    pub fn indices(&self) -> &[u32] {
        &self.indices[..self.count]
    }

    /// Number of points found, rounded up to whole groups of [`SUMS`]: as many values as
    /// [`Lanes::gather`] writes. What is beyond [`Found::len`] repeats the first point.
    pub fn padded(&self) -> usize {
        self.count.next_multiple_of(SUMS)
    }

    /// Fills the last group up with the first point found.
    #[inline]
    fn pad(&mut self) {
        let padded = self.padded();
        let first = self.indices[0];
        self.indices[self.count..padded].fill(first);
    }

    /// Makes room for a search among `points` points.
    fn prepare(&mut self, points: usize) {
        assert!(i32::try_from(points).is_ok(), "more points than an i32 counts");
        if self.indices.len() < points + SUMS {
            self.indices.resize(points + SUMS);
        }
        self.count = 0;
        self.searched = points;
    }
}

/// Selects the points nearer to the box from `lower` to `upper` than the root of `radius_squared`;
/// those inside it have distance 0.
///
/// Searches are made in `f32`, in which twice as many points fit a vector: callers that need to know
/// more precisely who is near search a little further.
///
/// # Panics
/// If the coordinate slices differ in length.
#[inline]
pub fn near_box<const D: usize>(
    points: [&[f32]; D],
    lower: [f32; D],
    upper: [f32; D],
    radius_squared: f32,
    selected: &mut Selection<D>,
) {
    let n = points.first().map_or(0, |x| x.len());
    assert!(points.iter().all(|x| x.len() == n), "coordinates of different lengths");
    selected.prepare(n);
    #[cfg(target_arch = "x86_64")]
    if avx512::is_available() {
        // SAFETY: the instruction set is there; the slices have length n, indices and coordinates of
        // the selection room for n and one vector more (`prepare`).
        return unsafe { avx512::near_box(points, lower, upper, radius_squared, selected) };
    }
    for j in 0..n {
        let mut distance_squared = 0.0;
        let count = selected.found.count;
        selected.found.indices[count] = j as u32;
        for a in 0..D {
            let x = points[a][j];
            selected.points[a][count] = x;
            let d = (lower[a] - x).max(x - upper[a]).max(0.0);
            distance_squared = d.mul_add(d, distance_squared);
        }
        selected.found.count += usize::from(distance_squared < radius_squared);
    }
}

/// Finds, of the points selected, those nearer to `centre` than the root of `radius_squared`.
#[inline]
pub fn within<const D: usize>(
    selected: &Selection<D>,
    centre: [f32; D],
    radius_squared: f32,
    found: &mut Found,
) {
    let n = selected.found.count;
    found.prepare(n);
    found.searched = selected.found.searched;
    #[cfg(target_arch = "x86_64")]
    if avx512::is_available() {
        // SAFETY: the instruction set is there; the indices found have room for as many as are
        // selected and one vector more (`prepare`).
        unsafe { avx512::within(selected, centre, radius_squared, found) };
        return found.pad();
    }
    for j in 0..n {
        let mut distance_squared = 0.0;
        for a in 0..D {
            let d = selected.points[a][j] - centre[a];
            distance_squared = d.mul_add(d, distance_squared);
        }
        found.indices[found.count] = selected.found.indices[j];
        found.count += usize::from(distance_squared < radius_squared);
    }
    found.pad();
}

/// Lane operations on a scalar type.
pub trait Lanes: Pod {
    /// `sum_i a_i b_i` for each of several `b`, over whole groups of [`SUMS`] elements, in as many
    /// partial sums that are then added by halves.
    ///
    /// # Panics
    /// If the lengths differ or are no multiple of [`SUMS`].
    fn dots<const N: usize>(a: &[Self], b: [&[Self]; N]) -> [Self; N];

    /// `sum_i (by + a_i) b_i` for each of several `b`, summed as [`Lanes::dots`] does.
    ///
    /// # Panics
    /// As [`Lanes::dots`].
    fn raised_dots<const N: usize>(by: Self, a: &[Self], b: [&[Self]; N]) -> [Self; N];

    /// `sum_n sum_i (by_n + a_ni) b_ni`: the partial sums of every `n` as in [`Lanes::dots`], then those of
    /// all `n` together; 0 if `N` is.
    ///
    /// # Panics
    /// As [`Lanes::dots`].
    fn raised_contraction<const N: usize>(by: [Self; N], a: [&[Self]; N], b: [&[Self]; N]) -> Self;

    /// Writes element `s` of the found points' records to the first [`Found::padded`] places of
    /// `to[s]`: from an array of structures, where a point's values share a cache line, to lanes. What
    /// it does with the elements from number `used` on is not promised.
    ///
    /// # Panics
    /// If there are fewer records than points to select from, or `to` has no room.
    fn gather(from: &[Record<Self>], found: &Found, used: usize, to: &mut [Buffer<Self>; RECORD]);

    /// Writes records whose elements `s` are those of `from[s]`: from lanes to an array of structures.
    ///
    /// # Panics
    /// If one of the lanes is shorter than `to`.
    fn interleave(from: [&[Self]; RECORD], to: &mut [Record<Self>]);
}

/// Partial sums of [`Lanes::dots`]: two full vectors of f64, one of f32.
pub const SUMS: usize = 16;

/// Values of a point that are gathered together.
pub const RECORD: usize = 8;

/// Values of one point, next to each other in memory.
pub type Record<T> = [T; RECORD];

macro_rules! lanes {
    (
        $scalar:ty,
        $gather:ident,
        $gather_half:ident,
        $interleave:ident,
        $dots:ident,
        $raised_dots:ident,
        $raised_contraction:ident,
    ) => {
        impl Lanes for $scalar {
            #[inline(always)]
            fn dots<const N: usize>(a: &[Self], b: [&[Self]; N]) -> [Self; N] {
                assert_whole_groups(a.len(), b);
                #[cfg(target_arch = "x86_64")]
                if avx512::is_available() {
                    // SAFETY: the instruction set is there; all are whole groups, equally many.
                    return unsafe { avx512::$dots(a, b) };
                }
                b.map(|b| {
                    let mut sums = [0.0 as $scalar; SUMS];
                    for (a, b) in a.as_chunks::<SUMS>().0.iter().zip(b.as_chunks::<SUMS>().0) {
                        for l in 0..SUMS {
                            sums[l] = a[l].mul_add(b[l], sums[l]);
                        }
                    }
                    add_by_halves(sums)
                })
            }

            #[inline(always)]
            fn raised_dots<const N: usize>(by: Self, a: &[Self], b: [&[Self]; N]) -> [Self; N] {
                assert_whole_groups(a.len(), b);
                #[cfg(target_arch = "x86_64")]
                if avx512::is_available() {
                    // SAFETY: the instruction set is there; all are whole groups, equally many.
                    return unsafe { avx512::$raised_dots(by, a, b) };
                }
                b.map(|b| {
                    let mut sums = [0.0 as $scalar; SUMS];
                    add_raised(&mut sums, by, a, b);
                    add_by_halves(sums)
                })
            }

            #[inline(always)]
            fn raised_contraction<const N: usize>(
                by: [Self; N],
                a: [&[Self]; N],
                b: [&[Self]; N],
            ) -> Self {
                let Some(first) = a.first() else { return 0.0 };
                assert_whole_groups(first.len(), a);
                assert_whole_groups(first.len(), b);
                #[cfg(target_arch = "x86_64")]
                if avx512::is_available() {
                    // SAFETY: the instruction set is there; all are whole groups, equally many, and
                    // there is a first.
                    return unsafe { avx512::$raised_contraction(by, a, b) };
                }
                let mut total = [0.0 as $scalar; SUMS];
                for n in 0..N {
                    let mut sums = [0.0 as $scalar; SUMS];
                    add_raised(&mut sums, by[n], a[n], b[n]);
                    for l in 0..SUMS {
                        total[l] = if n == 0 { sums[l] } else { total[l] + sums[l] };
                    }
                }
                add_by_halves(total)
            }

            #[inline]
            fn gather(
                from: &[Record<Self>],
                found: &Found,
                used: usize,
                to: &mut [Buffer<Self>; RECORD],
            ) {
                assert!(from.len() >= found.searched, "fewer records than points");
                let padded = found.padded();
                assert!(to.iter().all(|t| t.len() >= padded), "no room for what was found");
                let indices = &found.indices[..padded];
                #[cfg(target_arch = "x86_64")]
                if avx512::is_available() {
                    // SAFETY: the instruction set is there; every found index is below
                    // `searched` and so inside `from`, those of the padding too; there are whole
                    // groups of them and `to` has room.
                    return unsafe {
                        if used <= RECORD / 2 {
                            avx512::$gather_half(from, indices, to);
                        } else {
                            avx512::$gather(from, indices, to);
                        }
                    };
                }
                for (k, &i) in indices.iter().enumerate() {
                    for s in 0..used {
                        to[s][k] = from[i as usize][s];
                    }
                }
            }

            #[inline]
            fn interleave(from: [&[Self]; RECORD], to: &mut [Record<Self>]) {
                let n = to.len();
                let from = from.map(|lane| &lane[..n]);
                let mut whole = 0;
                #[cfg(target_arch = "x86_64")]
                if avx512::is_available() {
                    whole = n - n % SUMS;
                    // SAFETY: the instruction set is there; the lanes are as long as `to`, of which
                    // these are whole groups.
                    unsafe { avx512::$interleave(from, &mut to[..whole]) };
                }
                for k in whole..n {
                    for s in 0..RECORD {
                        to[k][s] = from[s][k];
                    }
                }
            }
        }
    };
}
lanes!(
    f64,
    gather_f64,
    gather_half_f64,
    interleave_f64,
    dots_f64,
    raised_dots_f64,
    raised_contraction_f64,
);
lanes!(
    f32,
    gather_f32,
    gather_f32,
    interleave_f32,
    dots_f32,
    raised_dots_f32,
    raised_contraction_f32,
);

#[inline(always)]
fn assert_whole_groups<T, const N: usize>(length: usize, lanes: [&[T]; N]) {
    let mut is_whole = length % SUMS == 0;
    for lanes in lanes {
        is_whole &= lanes.len() == length;
    }
    assert!(is_whole, "not whole groups of one length");
}

/// Adds `(by + a_i) b_i` to the partial sums.
#[inline(always)]
fn add_raised<T: num_traits::Float>(sums: &mut [T; SUMS], by: T, a: &[T], b: &[T]) {
    for (a, b) in a.as_chunks::<SUMS>().0.iter().zip(b.as_chunks::<SUMS>().0) {
        for l in 0..SUMS {
            sums[l] = (by + a[l]).mul_add(b[l], sums[l]);
        }
    }
}

/// Adds the upper half to the lower until one is left.
#[inline(always)]
fn add_by_halves<T: num_traits::Float>(mut sums: [T; SUMS]) -> T {
    let mut half = SUMS / 2;
    while half > 0 {
        for l in 0..half {
            sums[l] = sums[l] + sums[l + half];
        }
        half /= 2;
    }
    sums[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::real::Real;

    /// Points on a spiral, so that every distance differs.
    fn points<T: Real>(n: usize) -> [Vec<T>; 3] {
        let along = |f: fn(f64) -> f64| {
            (0..n).map(|i| T::of(f(i as f64 * 0.7) * (0.1 + i as f64 / n as f64))).collect()
        };
        [along(f64::sin), along(f64::cos), along(|t| (0.3 * t).sin())]
    }

    /// All points there are.
    fn all<const D: usize>(points: [&[f32]; D]) -> Selection<D> {
        let mut selected = Selection::default();
        near_box(points, [f32::NEG_INFINITY; D], [f32::INFINITY; D], 1.0, &mut selected);
        selected
    }

    #[test]
    fn within_agrees_with_the_definition() {
        let mut found = Found::default();
        for n in [0, 1, 7, 8, 9, 15, 16, 17, 100, 1031] {
            let [x, y, z] = points::<f32>(n);
            let centre = [0.1, -0.2, 0.05];
            within(&all([&x, &y, &z]), centre, 0.4, &mut found);
            let is_near = |&j: &usize| {
                let [dx, dy, dz] = [x[j] - centre[0], y[j] - centre[1], z[j] - centre[2]];
                dz.mul_add(dz, dy.mul_add(dy, dx * dx)) < 0.4
            };
            let expected: Vec<u32> = (0..n).filter(is_near).map(|j| j as u32).collect();
            assert_eq!(found.indices(), expected, "{n} points");
        }
    }

    fn gather_agrees_with_the_definition<T: Real>() {
        let mut found = Found::default();
        for n in [0, 1, 7, 8, 9, 15, 16, 17, 100, 1031] {
            let [x, y, _] = points::<f32>(n);
            within(&all([&x, &y]), [0.1, -0.2], 0.4, &mut found);
            let records: Vec<Record<T>> = y
                .iter()
                .map(|&y| std::array::from_fn(|s| T::of(f64::from(y) + s as f64)))
                .collect();
            let mut gathered: [Buffer<T>; RECORD] = Default::default();
            for lane in &mut gathered {
                lane.resize(found.padded() + 3);
                lane.fill(T::nan());
            }
            T::gather(&records, &found, 3, &mut gathered);
            let few = gathered.clone();
            T::gather(&records, &found, RECORD, &mut gathered);
            assert!(
                few[..3]
                    .iter()
                    .zip(&gathered)
                    .all(|(few, all)| { few[..found.padded()] == all[..found.padded()] })
            );
            for (s, lane) in gathered.iter().enumerate() {
                for (k, &j) in found.indices().iter().enumerate() {
                    assert_eq!(lane[k], records[j as usize][s]);
                }
                let padding = found.len()..found.padded();
                assert!(lane[padding].iter().all(|&g| g == lane[0]));
                assert!(lane[found.padded()..].iter().all(|g| g.is_nan()));
            }
        }
    }

    fn interleave_agrees_with_the_definition<T: Real>() {
        for n in [0, 1, 7, 16, 37, 64] {
            let value = |s: usize, k: usize| T::of((100 * k + s) as f64);
            let lanes: [Vec<T>; RECORD] =
                std::array::from_fn(|s| (0..n + s).map(|k| value(s, k)).collect());
            let mut records = vec![[T::nan(); RECORD]; n];
            T::interleave(std::array::from_fn(|s| &lanes[s][..]), &mut records);
            for (k, record) in records.iter().enumerate() {
                assert_eq!(*record, std::array::from_fn(|s| value(s, k)));
            }
        }
    }

    #[test]
    fn interleave_in_f64_and_f32() {
        interleave_agrees_with_the_definition::<f64>();
        interleave_agrees_with_the_definition::<f32>();
    }

    #[test]
    fn gather_in_f64_and_f32() {
        gather_agrees_with_the_definition::<f64>();
        gather_agrees_with_the_definition::<f32>();
    }

    fn dots_agree_with_the_definition<T: Real>() {
        for groups in [0, 1, 2, 11] {
            let [x, y, _] = points::<T>(groups * SUMS);
            let mut sums = [T::zero(); SUMS];
            for (i, (&x, &y)) in x.iter().zip(&y).enumerate() {
                sums[i % SUMS] = x.mul_add(y, sums[i % SUMS]);
            }
            let minus: Vec<T> = y.iter().map(|&y| -y).collect();
            let expected = add_by_halves(sums);
            assert_eq!(T::dots(&x, [&y, &minus]), [expected, -expected]);
            let by = T::of(0.3);
            let raised: Vec<T> = x.iter().map(|&x| by + x).collect();
            let expected = T::dots(&raised, [&y, &x]);
            assert_eq!(T::raised_dots(by, &x, [&y, &x]), expected);
            assert_eq!(T::raised_contraction([by], [&x], [&y]), expected[0]);
            let sum = T::raised_contraction([by, T::zero()], [&x, &y], [&y, &y]);
            let parts = expected[0] + T::dots(&y, [&y])[0];
            assert!((sum - parts).abs() <= T::of(20.0) * T::epsilon() * parts.abs());
            assert!(groups == 0 || sum != expected[0]);
        }
    }

    #[test]
    fn dots_in_f64_and_f32() {
        dots_agree_with_the_definition::<f64>();
        dots_agree_with_the_definition::<f32>();
    }

    #[test]
    fn a_point_that_is_nowhere_is_not_found() {
        let mut found = Found::default();
        let selected = all([&[0.0, f32::NAN, 0.5, 1.0]]);
        within(&selected, [0.0], 0.5, &mut found);
        assert_eq!(found.indices(), [0, 2]);
    }

    #[test]
    fn near_box_is_within_of_the_nearest_point_of_the_box() {
        let [x, y, z] = points::<f32>(500);
        let (lower, upper) = ([-0.2, 0.1, 0.0], [0.3, 0.4, 0.05]);
        let mut selected = Selection::default();
        near_box([&x, &y, &z], lower, upper, 0.09, &mut selected);
        let expected: Vec<u32> = (0..500)
            .filter(|&j| {
                let at = [x[j], y[j], z[j]];
                let d2: f32 =
                    (0..3).map(|a| (at[a] - at[a].clamp(lower[a], upper[a])).powi(2)).sum();
                d2 < 0.09
            })
            .map(|j| j as u32)
            .collect();
        assert!(!expected.is_empty() && expected.len() < 500);
        assert_eq!(selected.indices(), expected);
        // What is found among them is named as they are.
        let (centre, near) = ([0.2, 0.2, 0.0], 0.05);
        let mut found = Found::default();
        within(&selected, centre, near, &mut found);
        let is_near = |&&j: &&u32| {
            let at = [x[j as usize], y[j as usize], z[j as usize]];
            (0..3).map(|a| (at[a] - centre[a]).powi(2)).sum::<f32>() < near
        };
        let nearest: Vec<u32> = expected.iter().filter(is_near).copied().collect();
        assert!(!nearest.is_empty() && nearest.len() < expected.len());
        assert_eq!(found.indices(), nearest);
    }

    #[test]
    #[should_panic(expected = "fewer records")]
    fn records_of_fewer_points_are_refused() {
        let mut found = Found::default();
        within(&all([&[0.0; 20]]), [0.0], 1.0, &mut found);
        let mut room = Default::default();
        f64::gather(&[[1.0; RECORD]; 19], &found, RECORD, &mut room);
    }

    #[test]
    #[should_panic(expected = "no room")]
    fn room_for_fewer_points_is_refused() {
        let mut found = Found::default();
        within(&all([&[0.0; 20]]), [0.0], 1.0, &mut found);
        let mut room: [Buffer<f64>; RECORD] = Default::default();
        room.iter_mut().enumerate().for_each(|(s, lane)| lane.resize(32 - usize::from(s == 5)));
        f64::gather(&[[1.0; RECORD]; 20], &found, RECORD, &mut room);
    }
}
