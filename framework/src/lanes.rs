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

    /// Takes indices that were found before, among `points` points: as if found once more.
    ///
    /// # Panics
    /// If there are none, or one is not below `points`.
    #[inline(always)]
    pub fn recall(&mut self, indices: &[u16], points: usize) {
        let mut largest = 0;
        for &index in indices {
            largest = largest.max(index);
        }
        assert!(!indices.is_empty() && usize::from(largest) < points, "indices of other points");
        self.prepare(points);
        self.count = indices.len();
        for (to, &index) in self.indices.iter_mut().zip(indices) {
            *to = u32::from(index);
        }
        self.pad();
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
    let mut is_whole = length.is_multiple_of(SUMS);
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
mod tests;
