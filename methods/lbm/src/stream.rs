//! The step with two sets of columns: every site pulls the populations that arrive at it and collides
//! them, in one pass over memory from one set to the other.
//!
//! A row is its runs, packs of sites next to one another, and its single sites, which are gathered
//! into packs first, with what comes out of bodies put in its place.

use std::marker::PhantomData;

use finegrain_framework::pack::MOST_LANES;
use finegrain_framework::space::Grid;
use finegrain_framework::{
    ColumnId, Fault, Handle, Moment, Near, Rate, RateStage, Rates, Real, State, View,
};

use crate::around::{Around, wrap};
use crate::kernel::Stretch;
use crate::lattice::{Lattice, opposite};
use crate::physics::Streaming;
use crate::row::{Group, Local, Scratch, copy_around};

/// Streams and collides.
pub(crate) struct Stream<T, L, const Q: usize> {
    pub lattice: PhantomData<L>,
    pub now: [State<T>; Q],
    pub next: [Rate<T>; Q],
    pub local: Local<T, Q>,
}

impl<T: Real, L: Lattice<Q>, const Q: usize> RateStage<Grid> for Stream<T, L, Q> {
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
        let Local { collider, sites, velocities, .. } = &self.local;
        let [nx, ny, _] = near.domain().shape();
        // Populations are stored after the collision of their step.
        let time = moment.time + moment.dt;
        let views: [View<'_, T>; Q] = self.now.map(|column| near.state(column));
        let mut next = rates.rows_of(self.next);
        let mut group: [Group<T>; Q] = [[T::zero(); MOST_LANES]; Q];
        for (j, k) in near.sub_domain().rows() {
            let number = k * ny + j;
            let (runs, singles) = (sites.runs(number), sites.singles(number));
            if runs.is_empty() && singles.is_empty() {
                continue;
            }
            self.local.accelerate(scratch, nx, (j, k), time);
            let around = Around::new(near, &views, velocities, Streaming::TwoGrids, (j, k));
            let mut from: [&[T]; Q] = [&[]; Q];
            for q in 0..Q {
                from[q] = around.source(q);
            }
            for [start, end] in runs.iter().flat_map(|run| run.parts::<T>(nx)) {
                let mut sources: [&[T]; Q] = [&[]; Q];
                for (q, wrapped) in group.iter_mut().enumerate() {
                    let first = start as isize - L::VELOCITIES[q][0] as isize;
                    let range = first as usize..(first + (end - start) as isize) as usize;
                    sources[q] = from[q].get(range).unwrap_or_else(|| {
                        copy_around(from[q], first, &mut wrapped[..end - start]);
                        &wrapped[..end - start]
                    });
                }
                let to = Stretch { rows: &mut next, row: (j, k), x: start..end };
                collider.pull(&sources, to, scratch.varying(start, end));
            }
            if singles.is_empty() {
                continue;
            }
            let mut to = next.row(j, k);
            for singles in singles.chunks(MOST_LANES) {
                for (q, arrived) in group.iter_mut().enumerate() {
                    for (f, single) in arrived.iter_mut().zip(singles) {
                        *f = from[q][wrap(single.x as i32 - L::VELOCITIES[q][0], nx)];
                    }
                }
                for (place, single) in singles.iter().enumerate() {
                    for link in sites.links(single) {
                        let returned = around.returned(link, single.x as usize);
                        group[usize::from(link.q)][place] = returned;
                    }
                }
                let earlier = |x, to| std::array::from_fn(|q| around.at(q, x, to));
                self.local.complete::<L>(singles, &mut group, (j, k), time, &earlier);
                self.local.collide(singles, &mut group, scratch);
                for (q, to) in to.iter_mut().enumerate() {
                    for (f, single) in group[opposite(q)].iter().zip(singles) {
                        to[single.x as usize] = *f;
                    }
                }
            }
        }
        Ok(())
    }
}
