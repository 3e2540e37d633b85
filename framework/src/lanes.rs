//! Lanes that need more than the compiler finds by itself: selecting the points within a radius,
//! and gathering their values into contiguous blocks.
//!
//! One of the few modules with `unsafe`, so that methods need none: the instruction set is chosen
//! at run time and every call is safe. All instruction sets give the same bits.

#[cfg(target_arch = "x86_64")]
mod avx512;

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

/// Points that [`Lanes::within`] has found, by index into the slices it searched.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The first `count` are found; beyond them there is room to write whole lanes.
    indices: Vec<u32>,
    count: usize,
    /// Length of the slices searched: every found index is below it.
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
            self.indices.resize(points + SUMS, 0);
        }
        self.count = 0;
        self.searched = points;
    }
}

/// Lane operations on a scalar type.
pub trait Lanes: Copy + Sized {
    /// Finds the points nearer to `centre` than the root of `radius_squared`.
    ///
    /// # Panics
    /// If the coordinate slices differ in length.
    fn within<const D: usize>(
        points: [&[Self]; D],
        centre: [Self; D],
        radius_squared: Self,
        found: &mut Found,
    );

    /// Finds the points nearer to the box from `lower` to `upper` than the root of
    /// `radius_squared`; those inside it have distance 0.
    ///
    /// # Panics
    /// If the coordinate slices differ in length.
    fn near_box<const D: usize>(
        points: [&[Self]; D],
        lower: [Self; D],
        upper: [Self; D],
        radius_squared: Self,
        found: &mut Found,
    );

    /// `sum_i a_i b_i` for each of several `b`, over whole groups of [`SUMS`] elements, in as many
    /// partial sums that are then added by halves.
    ///
    /// # Panics
    /// If the lengths differ or are no multiple of [`SUMS`].
    fn dots<const N: usize>(a: &[Self], b: [&[Self]; N]) -> [Self; N];

    /// Writes element `s` of the found points' records to the first [`Found::padded`] places of
    /// `to[s]`: from an array of structures, where a point's values share a cache line, to lanes.
    ///
    /// # Panics
    /// If there are fewer records than points were searched, or `to` has no room.
    fn gather(from: &[Record<Self>], found: &Found, to: &mut [Vec<Self>; RECORD]);
}

/// Partial sums of [`Lanes::dots`]: two full vectors of f64, one of f32.
pub const SUMS: usize = 16;

/// Values of a point that are gathered together.
pub const RECORD: usize = 8;

/// Values of one point, next to each other in memory.
pub type Record<T> = [T; RECORD];

macro_rules! lanes {
    ($scalar:ty, $within:ident, $near_box:ident, $gather:ident, $dots:ident) => {
        impl Lanes for $scalar {
            #[inline]
            fn within<const D: usize>(
                points: [&[Self]; D],
                centre: [Self; D],
                radius_squared: Self,
                found: &mut Found,
            ) {
                let n = points.first().map_or(0, |x| x.len());
                assert!(points.iter().all(|x| x.len() == n), "coordinates of different lengths");
                found.prepare(n);
                #[cfg(target_arch = "x86_64")]
                if avx512::is_available() {
                    // SAFETY: the instruction set is there; the slices have length n and the
                    // indices room for n and one vector more (`prepare`).
                    unsafe { avx512::$within(points, centre, radius_squared, found) };
                    return found.pad();
                }
                search(points, radius_squared, found, |a, x| x - centre[a]);
                found.pad();
            }

            #[inline]
            fn near_box<const D: usize>(
                points: [&[Self]; D],
                lower: [Self; D],
                upper: [Self; D],
                radius_squared: Self,
                found: &mut Found,
            ) {
                let n = points.first().map_or(0, |x| x.len());
                assert!(points.iter().all(|x| x.len() == n), "coordinates of different lengths");
                found.prepare(n);
                #[cfg(target_arch = "x86_64")]
                if avx512::is_available() {
                    // SAFETY: as in `within`.
                    unsafe { avx512::$near_box(points, lower, upper, radius_squared, found) };
                    return found.pad();
                }
                search(points, radius_squared, found, |a, x| {
                    (lower[a] - x).max(x - upper[a]).max(0.0)
                });
                found.pad();
            }

            #[inline(always)]
            fn dots<const N: usize>(a: &[Self], b: [&[Self]; N]) -> [Self; N] {
                let mut is_whole = a.len() % SUMS == 0;
                for b in b {
                    is_whole &= b.len() == a.len();
                }
                assert!(is_whole, "not whole groups of one length");
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

            #[inline]
            fn gather(from: &[Record<Self>], found: &Found, to: &mut [Vec<Self>; RECORD]) {
                assert!(from.len() >= found.searched, "fewer records than points searched");
                let padded = found.padded();
                assert!(to.iter().all(|t| t.len() >= padded), "no room for what was found");
                let indices = &found.indices[..padded];
                #[cfg(target_arch = "x86_64")]
                if avx512::is_available() {
                    // SAFETY: the instruction set is there; every found index is below
                    // `searched` and so inside `from`, those of the padding too; there are whole
                    // groups of them and `to` has room.
                    return unsafe { avx512::$gather(from, indices, to) };
                }
                transpose(from, indices, to);
            }
        }
    };
}
lanes!(f64, within_f64, near_box_f64, gather_f64, dots_f64);
lanes!(f32, within_f32, near_box_f32, gather_f32, dots_f32);

/// Searches one point at a time, without branches.
#[inline]
fn search<T: num_traits::Float, const D: usize>(
    points: [&[T]; D],
    radius_squared: T,
    found: &mut Found,
    displacement: impl Fn(usize, T) -> T,
) {
    for j in 0..found.searched {
        let mut distance_squared = T::zero();
        for a in 0..D {
            let d = displacement(a, points[a][j]);
            distance_squared = d.mul_add(d, distance_squared);
        }
        found.indices[found.count] = j as u32;
        found.count += usize::from(distance_squared < radius_squared);
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

/// Writes the records at `indices` to their lanes, one at a time.
#[inline]
fn transpose<T: Copy>(from: &[Record<T>], indices: &[u32], to: &mut [Vec<T>; RECORD]) {
    for (k, &i) in indices.iter().enumerate() {
        for (lane, &value) in to.iter_mut().zip(&from[i as usize]) {
            lane[k] = value;
        }
    }
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

    fn agrees_with_the_definition<T: Real>() {
        let mut found = Found::default();
        for n in [0, 1, 7, 8, 9, 15, 16, 17, 100, 1031] {
            let [x, y, z] = points::<T>(n);
            let centre = [T::of(0.1), T::of(-0.2), T::of(0.05)];
            let radius_squared = T::of(0.4);
            T::within([&x, &y, &z], centre, radius_squared, &mut found);
            let expected: Vec<u32> = (0..n)
                .filter(|&j| {
                    let [dx, dy, dz] = [x[j] - centre[0], y[j] - centre[1], z[j] - centre[2]];
                    dz.mul_add(dz, dy.mul_add(dy, dx * dx)) < radius_squared
                })
                .map(|j| j as u32)
                .collect();
            assert_eq!(found.indices(), expected, "{n} points");
            let records: Vec<Record<T>> =
                y.iter().map(|&y| std::array::from_fn(|s| y + T::of(s as f64))).collect();
            let mut gathered = std::array::from_fn(|_| vec![T::nan(); found.padded() + 3]);
            T::gather(&records, &found, &mut gathered);
            for (s, lane) in gathered.iter().enumerate() {
                for (k, &j) in expected.iter().enumerate() {
                    assert_eq!(lane[k], records[j as usize][s]);
                }
                let padding = found.len()..found.padded();
                assert!(lane[padding].iter().all(|&g| g == lane[0]));
                assert!(lane[found.padded()..].iter().all(|g| g.is_nan()));
            }
        }
    }

    #[test]
    fn f64_agrees_with_the_definition() {
        agrees_with_the_definition::<f64>();
    }

    #[test]
    fn f32_agrees_with_the_definition() {
        agrees_with_the_definition::<f32>();
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
        f64::within([&[0.0, f64::NAN, 1.0]], [0.0], 0.5, &mut found);
        assert_eq!(found.indices(), [0]);
    }

    #[test]
    fn near_box_is_within_of_the_nearest_point_of_the_box() {
        let [x, y, z] = points::<f64>(500);
        let (lower, upper) = ([-0.2, 0.1, 0.0], [0.3, 0.4, 0.05]);
        let mut found = Found::default();
        f64::near_box([&x, &y, &z], lower, upper, 0.09, &mut found);
        let expected: Vec<u32> = (0..500)
            .filter(|&j| {
                let at = [x[j], y[j], z[j]];
                let d2: f64 =
                    (0..3).map(|a| (at[a] - at[a].clamp(lower[a], upper[a])).powi(2)).sum();
                d2 < 0.09
            })
            .map(|j| j as u32)
            .collect();
        assert!(!expected.is_empty() && expected.len() < 500);
        assert_eq!(found.indices(), expected);
    }

    #[test]
    #[should_panic(expected = "fewer records")]
    fn records_of_fewer_points_are_refused() {
        let mut found = Found::default();
        f64::within([&[0.0; 20]], [0.0], 1.0, &mut found);
        let mut room = std::array::from_fn(|_| vec![0.0; 20]);
        f64::gather(&[[1.0; RECORD]; 19], &found, &mut room);
    }

    #[test]
    #[should_panic(expected = "no room")]
    fn room_for_fewer_points_is_refused() {
        let mut found = Found::default();
        f64::within([&[0.0; 20]], [0.0], 1.0, &mut found);
        let mut room = std::array::from_fn(|s| vec![0.0; if s == 5 { 31 } else { 32 }]);
        f64::gather(&[[1.0; RECORD]; 20], &found, &mut room);
    }
}
