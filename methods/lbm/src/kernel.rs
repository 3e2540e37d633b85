//! The collision of packs of sites: all that is compiled for every collision and instruction set.

use std::marker::PhantomData;

use std::ops::Range;

use finegrain_framework::pack::{Fill, MOST_LANES, Pack, Targets, prefetch};
use finegrain_framework::space::grid::RowsOfMut;
use finegrain_framework::{Real, instructions};

use crate::collision::Collide;
use crate::lattice::Lattice;
use crate::relaxation::Relaxation;
use crate::row::none;
use crate::sites::line;

/// Packs between the one that is collided and the one that memory is asked for.
const AHEAD: usize = 6;

/// Acceleration of each site, in each direction, if it varies.
pub(crate) type Varying<'a, T> = Option<[&'a [T]; 3]>;

/// Slots of sites next to one another, in rows of every velocity.
pub(crate) struct Slots<'a, 'b, T, const Q: usize> {
    pub rows: &'b mut [&'a mut [T]; Q],
    pub sites: Range<usize>,
    /// How far ahead of a site the slots of each velocity are, around the end of the row: 0 or 1.
    pub ahead: &'static [usize; Q],
}

impl<'a, 'b, T, const Q: usize> Slots<'a, 'b, T, Q> {
    /// Of all the sites of a group.
    pub fn of_group(rows: &'b mut [&'a mut [T]; Q]) -> Self {
        Self { sites: 0..rows[0].len(), rows, ahead: &[0; Q] }
    }
}

/// Collides sites next to one another, as many as make whole packs.
pub(crate) trait Collider<T, const Q: usize>: Send + Sync {
    /// From the populations that arrive to those that leave, elsewhere in memory.
    fn pull(&self, from: &[&[T]; Q], to: Stretch<'_, '_, T, Q>, acceleration: Varying<'_, T>);

    /// In place, where what leaves takes the place of what arrived from there: that of the opposite
    /// velocity.
    fn exchange(&self, slots: Slots<'_, '_, T, Q>, acceleration: Varying<'_, T>);
}

/// The collision of a lattice.
pub(crate) struct Kernel<L, C> {
    pub lattice: PhantomData<L>,
    pub collision: C,
    pub relaxation: Relaxation,
    /// Acceleration where it does not vary, in lattice units.
    pub uniform: [f64; 3],
}

impl<T: Real, L: Lattice<Q>, C: Collide<T>, const Q: usize> Collider<T, Q> for Kernel<L, C> {
    fn pull(&self, from: &[&[T]; Q], to: Stretch<'_, '_, T, Q>, acceleration: Varying<'_, T>) {
        let memory = Apart { from, to };
        instructions::dispatch(Task { kernel: self, memory, acceleration });
    }

    fn exchange(&self, slots: Slots<'_, '_, T, Q>, acceleration: Varying<'_, T>) {
        instructions::dispatch(Task { kernel: self, memory: slots, acceleration });
    }
}

/// Where populations arrive, and leave from.
trait Memory<T: Real, const Q: usize> {
    /// Lends it in packs.
    fn lend<V: Pack<Scalar = T>>(self, simd: V::Simd, task: impl Pass<V, Q>);
}

/// What is done with all packs of populations, piece by piece.
trait Pass<V: Pack, const Q: usize> {
    fn over(&mut self, packs: &mut impl Packs<V, Q>);
}

/// Packs of populations that arrive, and leave.
trait Packs<V: Pack, const Q: usize> {
    /// Number of packs.
    fn count(&self) -> usize;
    /// The populations that have arrived at pack `i`.
    fn arrived(&self, i: usize) -> [V::Vector; Q];
    /// Leaves those after the collision where they go on from.
    fn leave(&mut self, i: usize, f: [V; Q]);
}

/// A part of a row.
pub(crate) struct Stretch<'a, 'n, T, const Q: usize> {
    pub rows: &'a mut RowsOfMut<'n, T, Q>,
    /// Its number in its plane, and that of the plane.
    pub row: (usize, usize),
    pub x: Range<usize>,
}

/// Two sets of columns.
struct Apart<'a, 'b, 'n, T, const Q: usize> {
    from: &'b [&'a [T]; Q],
    to: Stretch<'b, 'n, T, Q>,
}

impl<T: Real, const Q: usize> Memory<T, Q> for Apart<'_, '_, '_, T, Q> {
    #[inline(always)]
    fn lend<V: Pack<Scalar = T>>(self, simd: V::Simd, task: impl Pass<V, Q>) {
        let mut from: [&[V::Vector]; Q] = [&[]; Q];
        for q in 0..Q {
            from[q] = V::packs(simd, self.from[q]);
        }
        let Stretch { rows, row, x } = self.to;
        rows.fill::<V>(simd, row, x, From::<V, _, Q> { from, task });
    }
}

/// A task, and where it finds what arrives.
struct From<'a, V: Pack, P, const Q: usize> {
    from: [&'a [V::Vector]; Q],
    task: P,
}

impl<V: Pack, P: Pass<V, Q>, const Q: usize> Fill<V::Vector, Q> for From<'_, V, P, Q> {
    #[inline(always)]
    fn fill(mut self, to: &mut Targets<'_, V::Vector, Q>) {
        self.task.over(&mut ApartPacks::<V, Q> { from: self.from, to });
    }
}

struct ApartPacks<'a, 'b, V: Pack, const Q: usize> {
    from: [&'a [V::Vector]; Q],
    to: &'a mut Targets<'b, V::Vector, Q>,
}

impl<V: Pack, const Q: usize> Packs<V, Q> for ApartPacks<'_, '_, V, Q> {
    #[inline(always)]
    fn count(&self) -> usize {
        self.from[0].len()
    }

    #[inline(always)]
    fn arrived(&self, i: usize) -> [V::Vector; Q] {
        let mut f = [self.from[0][i]; Q];
        for q in 0..Q {
            prefetch(self.from[q], i + AHEAD);
            f[q] = self.from[q][i];
        }
        f
    }

    #[inline(always)]
    fn leave(&mut self, i: usize, f: [V; Q]) {
        let mut vectors = [f[0].vector(); Q];
        for q in 0..Q {
            vectors[q] = f[q].vector();
        }
        self.to.write(i, vectors);
    }
}

/// One set of columns.
impl<T: Real, const Q: usize> Memory<T, Q> for Slots<'_, '_, T, Q> {
    #[inline(always)]
    fn lend<V: Pack<Scalar = T>>(self, simd: V::Simd, mut task: impl Pass<V, Q>) {
        let Self { rows, sites: Range { start, end }, ahead } = self;
        let n = rows[0].len();
        // The slots ahead of the last line of a row are not next to one another: they are lent as copies, after
        // all others, since they are in the cache then.
        let last = if end == n { n - line::<T>() } else { end };
        let mut copies = [[T::zero(); MOST_LANES]; Q];
        for (first, count) in [(start, last - start), (last, end - last)] {
            if count == 0 {
                continue;
            }
            let goes_around = |q: usize| first + ahead[q] + count > n;
            let mut slots = none::<T, Q>();
            for (q, (copy, row)) in copies.iter_mut().zip(&mut *rows).enumerate() {
                slots[q] = if goes_around(q) {
                    take_line(row, copy);
                    &mut copy[..count]
                } else {
                    &mut row[first + ahead[q]..][..count]
                };
            }
            // All as long as the first, as the compiler sees: no index is checked then.
            let count = V::packs_mut(simd, slots[0]).len();
            let mut packs = none::<V::Vector, Q>();
            for (packs, slots) in packs.iter_mut().zip(slots) {
                *packs = &mut V::packs_mut(simd, slots)[..count];
            }
            task.over(&mut InPlacePacks::<V, Q> { slots: packs });
            for (q, (copy, row)) in copies.iter().zip(&mut *rows).enumerate() {
                if goes_around(q) {
                    give_line(copy, row);
                }
            }
        }
    }
}

/// Copies a line of slots that ends around the end of a row.
#[inline(always)]
fn take_line<T: Copy>(row: &[T], into: &mut [T; MOST_LANES]) {
    // Known when this is compiled, so that a copy is a few instructions.
    let most = line::<T>() - 1;
    into[..most].copy_from_slice(&row[row.len() - most..][..most]);
    into[most] = row[0];
}

/// Copies it back.
#[inline(always)]
fn give_line<T: Copy>(from: &[T; MOST_LANES], row: &mut [T]) {
    let (n, most) = (row.len(), line::<T>() - 1);
    row[n - most..][..most].copy_from_slice(&from[..most]);
    row[0] = from[most];
}

struct InPlacePacks<'a, V: Pack, const Q: usize> {
    slots: [&'a mut [V::Vector]; Q],
}

impl<V: Pack, const Q: usize> Packs<V, Q> for InPlacePacks<'_, V, Q> {
    #[inline(always)]
    fn count(&self) -> usize {
        self.slots[0].len()
    }

    #[inline(always)]
    fn arrived(&self, i: usize) -> [V::Vector; Q] {
        let mut f = [self.slots[0][i]; Q];
        for q in 0..Q {
            prefetch(self.slots[q], i + AHEAD);
            f[q] = self.slots[q][i];
        }
        f
    }

    #[inline(always)]
    fn leave(&mut self, i: usize, f: [V; Q]) {
        self.slots[0][i] = f[0].vector();
        for n in 0..Q / 2 {
            let (q, back) = (2 * n + 1, 2 * n + 2);
            self.slots[q][i] = f[back].vector();
            self.slots[back][i] = f[q].vector();
        }
    }
}

/// A collision, to be compiled for every instruction set.
struct Task<'a, T, L, C, M, const Q: usize> {
    kernel: &'a Kernel<L, C>,
    memory: M,
    acceleration: Varying<'a, T>,
}

impl<T: Real, L: Lattice<Q>, C: Collide<T>, M: Memory<T, Q>, const Q: usize> pulp::WithSimd
    for Task<'_, T, L, C, M, Q>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { kernel, memory, acceleration } = self;
        memory.lend::<T::Pack<S>>(simd, Collisions { simd, kernel, acceleration, before: 0 });
    }
}

/// The same for the instruction set that was found.
struct Collisions<'a, S, T, L, C> {
    simd: S,
    kernel: &'a Kernel<L, C>,
    acceleration: Varying<'a, T>,
    /// Packs of pieces before.
    before: usize,
}

impl<V: Pack, L: Lattice<Q>, C: Collide<V::Scalar>, const Q: usize> Pass<V, Q>
    for Collisions<'_, V::Simd, V::Scalar, L, C>
{
    #[inline(always)]
    fn over(&mut self, packs: &mut impl Packs<V, Q>) {
        let Self { simd, kernel, acceleration, before } = *self;
        let [x, y, z] = kernel.uniform.map(V::Scalar::of);
        let uniform = [V::splat(simd, x), V::splat(simd, y), V::splat(simd, z)];
        for i in 0..packs.count() {
            let vectors = packs.arrived(i);
            let mut f = [uniform[0]; Q];
            for q in 0..Q {
                f[q] = V::of(simd, vectors[q]);
            }
            let mut here = uniform;
            if let Some(varying) = acceleration {
                for a in 0..L::DIMS {
                    here[a] = V::of(simd, V::packs(simd, varying[a])[before + i]);
                }
            }
            let omega = kernel.relaxation.rate::<L, V, Q>(&f);
            packs.leave(i, kernel.collision.collide::<L, V, Q>(f, here, omega));
        }
        self.before += packs.count();
    }
}
