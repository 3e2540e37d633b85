//! The step: every site pulls the populations that arrive at it and collides them, in one pass over
//! memory from one set of columns to the other.
//!
//! A row is its runs, packs of sites next to one another, and its single sites, which are gathered
//! into packs first, with what comes out of bodies put in its place. Both go through the same
//! collision.

use std::marker::PhantomData;
use std::sync::Arc;

use finegrain_framework::pack::{MOST_LANES, Pack};
use finegrain_framework::space::Grid;
use finegrain_framework::space::grid::RowsMut;
use finegrain_framework::{
    ColumnId, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real, State, View,
};

use crate::acceleration::Acceleration;
use crate::around::{Around, wrap};
use crate::collision::Collide;
use crate::lattice::Lattice;
use crate::opening::{Edge, Openings};
use crate::relaxation::Relaxation;
use crate::sites::{Run, Single, Sites};

/// Streams and collides.
pub(crate) struct Stream<T, L, C, const Q: usize> {
    pub now: [State<T>; Q],
    pub next: [Rate<T>; Q],
    pub lattice: PhantomData<L>,
    pub collision: C,
    pub relaxation: Relaxation,
    pub acceleration: Acceleration,
    pub sites: Arc<Sites<T>>,
    pub openings: Openings,
    /// The velocities as a slice.
    pub velocities: &'static [[i32; 3]],
}

/// Working memory of one worker.
pub(crate) struct Scratch<T> {
    /// Acceleration of every site of a row.
    acceleration: [Vec<T>; 3],
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self { acceleration: [const { Vec::new() }; 3] }
    }
}

/// Single sites as one group of packs.
type Group<T> = [T; MOST_LANES];

impl<T: Real, L: Lattice<Q>, C: Collide<T>, const Q: usize> Stream<T, L, C, Q> {
    #[inline(always)]
    fn run<V: Pack<Scalar = T>>(
        &self,
        simd: V::Simd,
        near: &Near<'_, Grid>,
        next: &mut [RowsMut<'_, T>; Q],
        scratch: &mut Scratch<T>,
        time: f64,
    ) {
        let [nx, ny, _] = near.domain().shape();
        let views: [View<'_, T>; Q] = self.now.map(|column| near.state(column));
        let is_uniform = self.acceleration.field.is_none();
        for (a, row) in scratch.acceleration.iter_mut().enumerate() {
            row.clear();
            row.resize(nx, T::of(self.acceleration.uniform[a]));
        }
        for (j, k) in near.sub_domain().rows() {
            let number = k * ny + j;
            let (runs, singles) = (self.sites.runs(number), self.sites.singles(number));
            if runs.is_empty() && singles.is_empty() {
                continue;
            }
            if !is_uniform {
                for x in 0..nx {
                    let given = self.acceleration.at([x, j, k], time);
                    for a in 0..L::DIMS {
                        scratch.acceleration[a][x] = T::of(given[a]);
                    }
                }
            }
            let around = Around::new(near, &views, self.velocities, (j, k));
            let mut from: [&[T]; Q] = [&[]; Q];
            for q in 0..Q {
                from[q] = around.source(q);
            }
            let mut to = next.each_mut().map(|rows| rows.row(j, k));
            for &run in runs {
                self.run_of_sites::<V>(simd, run, &from, &mut to, &scratch.acceleration);
            }
            for group in singles.chunks(MOST_LANES) {
                let mut gathered =
                    Gathered::new(group, &self.sites, &around, &from, &scratch.acceleration);
                self.complete(group, &around, &mut gathered, (j, k), time);
                self.single_sites::<V>(simd, group, &mut gathered, &mut to);
            }
        }
    }

    /// Sites that pull from the fluid only.
    #[inline(always)]
    fn run_of_sites<V: Pack<Scalar = T>>(
        &self,
        simd: V::Simd,
        run: Run,
        from: &[&[T]; Q],
        to: &mut [&mut [T]; Q],
        acceleration: &[Vec<T>; 3],
    ) {
        let (start, end) = (run.start as usize, run.end as usize);
        // The last pack overlaps the one before: the same numbers are computed from what has not
        // been touched. A loop, so that the collision is compiled once for both.
        let parts = [[start, end], [end - V::LANES, end]];
        let is_whole = (end - start).is_multiple_of(V::LANES);
        for &part in &parts[..if is_whole { 1 } else { 2 }] {
            self.packs::<V>(simd, part, from, to, acceleration);
        }
    }

    /// As many whole packs as fit between two places of a row.
    #[inline(always)]
    fn packs<V: Pack<Scalar = T>>(
        &self,
        simd: V::Simd,
        [start, end]: [usize; 2],
        from: &[&[T]; Q],
        to: &mut [&mut [T]; Q],
        acceleration: &[Vec<T>; 3],
    ) {
        let count = (end - start) / V::LANES;
        let mut sources: [&[V::Vector]; Q] = [&[]; Q];
        for q in 0..Q {
            // Never out of the row: runs keep away from its ends.
            let shift = L::VELOCITIES[q][0];
            let first = (start as i32 - shift) as usize;
            let last = (end as i32 - shift) as usize;
            sources[q] = &V::packs(simd, &from[q][first..last])[..count];
        }
        let targets =
            to.each_mut().map(|row| &mut V::packs_mut(simd, &mut row[start..end])[..count]);
        let mut forces: [&[V::Vector]; 3] = [&[]; 3];
        for a in 0..3 {
            forces[a] = &V::packs(simd, &acceleration[a][start..end])[..count];
        }
        let zero = V::splat(simd, T::zero());
        for i in 0..count {
            let mut f = [zero; Q];
            for q in 0..Q {
                f[q] = V::of(simd, sources[q][i]);
            }
            let mut force = [zero; 3];
            for a in 0..L::DIMS {
                force[a] = V::of(simd, forces[a][i]);
            }
            let omega = self.relaxation.rate::<L, V, Q>(&f);
            let after = self.collision.collide::<L, V, Q>(f, force, omega);
            for q in 0..Q {
                targets[q][i] = after[q].vector();
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
            let acceleration = gathered.acceleration.map(|a| a[place].as_f64());
            let edge = Edge { site: [x, j, k], time, acceleration };
            let mut f = gathered.f.map(|f| f[place]);
            let opening = &self.openings.all[number];
            let earlier = |n: i32| {
                let mut to = [0; 3];
                to[opening.axis()] = n * opening.inward();
                std::array::from_fn(|q| around.at(q, x, to))
            };
            self.openings.complete::<L, T, Q>(number, &mut f, &edge, earlier);
            for q in 0..Q {
                gathered.f[q][place] = f[q];
            }
        }
    }

    /// Collides at most [`MOST_LANES`] single sites.
    #[inline(always)]
    fn single_sites<V: Pack<Scalar = T>>(
        &self,
        simd: V::Simd,
        singles: &[Single],
        gathered: &mut Gathered<T, Q>,
        to: &mut [&mut [T]; Q],
    ) {
        let Gathered { f, acceleration } = gathered;
        for first in (0..singles.len()).step_by(V::LANES) {
            let mut pack = [V::splat(simd, T::zero()); Q];
            for q in 0..Q {
                pack[q] = V::load(simd, &f[q][first..]);
            }
            let mut force = [V::splat(simd, T::zero()); 3];
            for a in 0..L::DIMS {
                force[a] = V::load(simd, &acceleration[a][first..]);
            }
            let omega = self.relaxation.rate::<L, V, Q>(&pack);
            let after = self.collision.collide::<L, V, Q>(pack, force, omega);
            for q in 0..Q {
                after[q].store(&mut f[q][first..]);
            }
        }
        for (place, single) in singles.iter().enumerate() {
            for q in 0..Q {
                to[q][single.x as usize] = f[q][place];
            }
        }
    }
}

/// What arrives at single sites, and accelerates them.
struct Gathered<T, const Q: usize> {
    f: [Group<T>; Q],
    acceleration: [Group<T>; 3],
}

impl<T: Real, const Q: usize> Gathered<T, Q> {
    /// Of at most [`MOST_LANES`] sites, with what comes out of bodies in its place.
    #[inline(always)]
    fn new(
        singles: &[Single],
        sites: &Sites<T>,
        around: &Around<'_, '_, T>,
        from: &[&[T]; Q],
        accelerations: &[Vec<T>; 3],
    ) -> Self {
        let mut f: [Group<T>; Q] = [[T::zero(); MOST_LANES]; Q];
        let mut acceleration: [Group<T>; 3] = [[T::zero(); MOST_LANES]; 3];
        for (place, single) in singles.iter().enumerate() {
            let x = single.x as usize;
            for q in 0..Q {
                f[q][place] = from[q][wrap(x as i32 - around.velocity(q)[0], from[q].len())];
            }
            for link in sites.links(single) {
                f[usize::from(link.q)][place] = around.returned(link, x);
            }
            for a in 0..3 {
                acceleration[a][place] = accelerations[a][x];
            }
        }
        Self { f, acceleration }
    }
}

/// A tile's share, to be compiled for every instruction set.
struct Task<'s, 'n, T, L, C, const Q: usize> {
    stream: &'s Stream<T, L, C, Q>,
    near: &'s Near<'n, Grid>,
    next: &'s mut [RowsMut<'n, T>; Q],
    scratch: &'s mut Scratch<T>,
    time: f64,
}

impl<T: Real, L: Lattice<Q>, C: Collide<T>, const Q: usize> pulp::WithSimd
    for Task<'_, '_, T, L, C, Q>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let Self { stream, near, next, scratch, time } = self;
        stream.run::<T::Pack<S>>(simd, near, next, scratch, time);
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
        pulp::Arch::new().dispatch(Task { stream: self, near, next: &mut next, scratch, time });
        Ok(())
    }
}
