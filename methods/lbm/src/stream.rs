//! The step: every site pulls the populations that arrive at it and collides them, in one pass over
//! memory from one set of columns to the other.
//!
//! A row is its runs, packs of sites next to one another, and its single sites, which are gathered
//! into packs first, with what comes out of bodies put in its place. Both go through the same
//! collision, which is compiled once for both.

use std::marker::PhantomData;
use std::sync::Arc;

use finegrain_framework::pack::{Bypass, MOST_LANES, Pack, Target, prefetch};
use finegrain_framework::space::Grid;
use finegrain_framework::space::grid::RowsMut;
use finegrain_framework::{
    ColumnId, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real, State, View,
};

use crate::around::{Around, wrap};
use crate::collision::Collide;
use crate::kernel::{Accelerations, Kernel, Slots};
use crate::lattice::Lattice;
use crate::opening::{Edge, Openings};
use crate::sites::{Single, Sites};

/// Streams and collides.
pub(crate) struct Stream<T, L, C, const Q: usize> {
    pub now: [State<T>; Q],
    pub next: [Rate<T>; Q],
    pub lattice: PhantomData<L>,
    pub kernel: Kernel<C>,
    pub sites: Arc<Sites<T>>,
    pub openings: Openings,
    /// The velocities as a slice.
    pub velocities: &'static [[i32; 3]],
}

/// Working memory of one worker.
pub(crate) struct Scratch<T> {
    /// Acceleration of every site of a row, if it varies.
    pub acceleration: [Vec<T>; 3],
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self { acceleration: [const { Vec::new() }; 3] }
    }
}

/// Packs between the one that is collided and the one that memory is asked for.
const AHEAD: usize = 6;

/// Single sites as one group of packs.
pub(crate) type Group<T> = [T; MOST_LANES];

/// What is collided in one go.
pub(crate) enum Part<'a> {
    /// From one place of the row to another.
    Run([usize; 2]),
    /// At most [`MOST_LANES`] of them.
    Singles(&'a [Single]),
}

/// Populations pulled from one set of columns into another.
struct TwoGrids<'a, V: Pack, const Q: usize> {
    from: [&'a [V::Vector]; Q],
    to: [Target<'a, V::Vector>; Q],
}

impl<V: Pack, const Q: usize> Slots<V, Q> for TwoGrids<'_, V, Q> {
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
        for q in 0..Q {
            self.to[q].write(i, f[q].vector());
        }
    }
}

impl<T: Real, L: Lattice<Q>, C: Collide<T>, const Q: usize> Stream<T, L, C, Q> {
    #[inline(always)]
    fn run<V: Pack<Scalar = T>>(
        &self,
        simd: V::Simd,
        near: &Near<'_, Grid>,
        next: &mut [RowsMut<'_, T>; Q],
        scratch: &mut Scratch<T>,
        bypass: Option<Bypass<'_>>,
        time: f64,
    ) {
        let [nx, ny, _] = near.domain().shape();
        let views: [View<'_, T>; Q] = self.now.map(|column| near.state(column));
        let uniform = self.kernel.uniform::<V>(simd);
        let varies = self.kernel.acceleration.field.is_some();
        let mut gathered = Gathered::new();
        let mut after: [Group<T>; Q] = [[T::zero(); MOST_LANES]; Q];
        for (j, k) in near.sub_domain().rows() {
            let number = k * ny + j;
            let (runs, singles) = (self.sites.runs(number), self.sites.singles(number));
            if runs.is_empty() && singles.is_empty() {
                continue;
            }
            self.kernel.accelerate(&mut scratch.acceleration, nx, (j, k), time);
            let around = Around::new(near, &views, self.velocities, (j, k));
            let mut from: [&[T]; Q] = [&[]; Q];
            for q in 0..Q {
                from[q] = around.source(q);
            }
            let mut to = next.each_mut().map(|rows| rows.row(j, k));
            let parts = runs.iter().flat_map(|run| run.parts::<T>(nx)).map(Part::Run);
            for part in parts.chain(singles.chunks(MOST_LANES).map(Part::Singles)) {
                let (mut slots, varying, count) = match part {
                    Part::Run([start, end]) => {
                        let mut sources: [&[V::Vector]; Q] = [&[]; Q];
                        for (q, wrapped) in gathered.f.iter_mut().enumerate() {
                            let run = shifted(from[q], start, end, L::VELOCITIES[q][0], wrapped);
                            sources[q] = V::packs(simd, run);
                        }
                        let to = to.each_mut().map(|row| {
                            Target::new(V::packs_mut(simd, &mut row[start..end]), bypass)
                        });
                        let varying = varies.then(|| {
                            scratch.acceleration.each_ref().map(|a| V::packs(simd, &a[start..end]))
                        });
                        (TwoGrids { from: sources, to }, varying, (end - start) / V::LANES)
                    }
                    Part::Singles(group) => {
                        gathered.gather::<L>(group, &from, &scratch.acceleration, varies);
                        for (place, single) in group.iter().enumerate() {
                            for link in self.sites.links(single) {
                                gathered.f[usize::from(link.q)][place] =
                                    around.returned(link, single.x as usize);
                            }
                        }
                        self.complete(group, &around, &mut gathered, (j, k), time);
                        let from = gathered.f.each_ref().map(|f| V::packs(simd, f));
                        let to = after.each_mut().map(|f| Target::new(V::packs_mut(simd, f), None));
                        let varying = varies
                            .then(|| gathered.acceleration.each_ref().map(|a| V::packs(simd, a)));
                        let count = group.len().div_ceil(V::LANES);
                        (TwoGrids { from, to }, varying, count)
                    }
                };
                let accelerations = Accelerations { uniform, varying };
                self.kernel.collide::<L, V, _, Q>(simd, count, &mut slots, &accelerations);
                if let Part::Singles(group) = part {
                    for q in 0..Q {
                        for (place, single) in group.iter().enumerate() {
                            to[q][single.x as usize] = after[q][place];
                        }
                    }
                }
            }
        }
    }

    /// Replaces the populations of those among single sites that lie on the plane of an opening.
    fn complete(
        &self,
        singles: &[Single],
        around: &Around<'_, '_, T>,
        gathered: &mut Gathered<T, Q>,
        (j, k): (usize, usize),
        time: f64,
    ) {
        for (place, single) in singles.iter().enumerate() {
            let Some(number) = single.opening() else { continue };
            let x = single.x as usize;
            let earlier = |n: i32| {
                let opening = &self.openings.all[number];
                let mut to = [0; 3];
                to[opening.axis()] = n * opening.inward();
                std::array::from_fn(|q| around.at(q, x, to))
            };
            let acceleration = self.kernel.acceleration.at([x, j, k], time);
            let edge = Edge { site: [x, j, k], time, acceleration };
            let mut f = gathered.f.map(|f| f[place]);
            self.openings.complete::<L, T, Q>(number, &mut f, &edge, &earlier);
            for q in 0..Q {
                gathered.f[q][place] = f[q];
            }
        }
    }
}

/// What streams along a row, with a velocity of `c` along it, to its sites from `start` to `end`; by way
/// of `wrapped` if that is around an end of the row, which only a line does.
#[inline(always)]
fn shifted<'a, T: Real>(
    row: &'a [T],
    start: usize,
    end: usize,
    c: i32,
    wrapped: &'a mut Group<T>,
) -> &'a [T] {
    let (first, last) =
        (start.wrapping_add_signed(-c as isize), end.wrapping_add_signed(-c as isize));
    if let Some(inside) = row.get(first..last) {
        return inside;
    }
    let count = end - start;
    if c > 0 {
        wrapped[0] = row[row.len() - 1];
        wrapped[1..count].copy_from_slice(&row[..last]);
    } else {
        wrapped[..count - 1].copy_from_slice(&row[first..]);
        wrapped[count - 1] = row[0];
    }
    &wrapped[..count]
}

/// What arrives at single sites, and accelerates them.
pub(crate) struct Gathered<T, const Q: usize> {
    pub f: [Group<T>; Q],
    pub acceleration: [Group<T>; 3],
}

impl<T: Real, const Q: usize> Gathered<T, Q> {
    /// Of no sites.
    pub fn new() -> Self {
        let none = [T::zero(); MOST_LANES];
        Self { f: [none; Q], acceleration: [none; 3] }
    }

    /// Of at most [`MOST_LANES`] sites; what comes out of bodies is still missing.
    #[inline(always)]
    fn gather<L: Lattice<Q>>(
        &mut self,
        singles: &[Single],
        from: &[&[T]; Q],
        accelerations: &[Vec<T>; 3],
        varies: bool,
    ) {
        for q in 0..Q {
            let (row, shift) = (from[q], L::VELOCITIES[q][0]);
            for (f, single) in self.f[q].iter_mut().zip(singles) {
                *f = row[wrap(single.x as i32 - shift, row.len())];
            }
        }
        if varies {
            for (a, row) in self.acceleration.iter_mut().zip(accelerations) {
                for (a, single) in a.iter_mut().zip(singles) {
                    *a = row[single.x as usize];
                }
            }
        }
    }
}

/// A tile's share, to be compiled for every instruction set.
struct Task<'s, 'n, T, L, C, const Q: usize> {
    stream: &'s Stream<T, L, C, Q>,
    near: &'s Near<'n, Grid>,
    next: &'s mut [RowsMut<'n, T>; Q],
    scratch: &'s mut Scratch<T>,
    bypass: Option<Bypass<'s>>,
    time: f64,
}

impl<T: Real, L: Lattice<Q>, C: Collide<T>, const Q: usize> pulp::WithSimd
    for Task<'_, '_, T, L, C, Q>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { stream, near, next, scratch, bypass, time } = self;
        stream.run::<T::Pack<S>>(simd, near, next, scratch, bypass, time);
    }
}

impl<T: Real, L: Lattice<Q>, C: Collide<T>, const Q: usize> RateStage<Grid> for Stream<T, L, C, Q> {
    type Scratch = Scratch<T>;

    fn name(&self) -> &str {
        "lbm stream and collide"
    }

    fn writes(&self) -> Vec<ColumnId> {
        self.next.iter().map(|rate| rate.id()).collect()
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        scratch: &mut Scratch<T>,
        moment: &Moment,
    ) -> Result<(), Fault> {
        let mut next = self.next.map(|rate| rates.rows(rate));
        // Populations are stored after the collision of their step.
        let time = moment.time + moment.dt;
        let bypass = rates.bypass();
        let task = Task { stream: self, near, next: &mut next, scratch, bypass, time };
        pulp::Arch::new().dispatch(task);
        Ok(())
    }
}
