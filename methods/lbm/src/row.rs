//! What is done with a row of sites, wherever its populations are.

use std::sync::Arc;

use finegrain_framework::Real;
use finegrain_framework::pack::MOST_LANES;

use crate::acceleration::Acceleration;
use crate::around::wrap;
use crate::kernel::{Collider, Slots, Varying};
use crate::lattice::Lattice;
use crate::opening::{Edge, Openings};
use crate::sites::{Single, Sites, line};

/// One group of sites in packs.
pub(crate) type Group<T> = [T; MOST_LANES];

/// What happens at sites.
pub(crate) struct Local<T, const Q: usize> {
    pub collider: Box<dyn Collider<T, Q>>,
    pub acceleration: Acceleration,
    pub sites: Arc<Sites<T>>,
    pub openings: Openings,
    /// The velocities as a slice.
    pub velocities: &'static [[i32; 3]],
}

/// Working memory of one worker.
pub(crate) struct Scratch<T> {
    /// Acceleration of every site of a row, if it varies.
    acceleration: [Vec<T>; 3],
}

impl<T> Default for Scratch<T> {
    fn default() -> Self {
        Self { acceleration: [const { Vec::new() }; 3] }
    }
}

impl<T: Real> Scratch<T> {
    /// Acceleration of the sites of a row from `start` to `end`.
    pub fn varying(&self, start: usize, end: usize) -> Varying<'_, T> {
        let varies = !self.acceleration[0].is_empty();
        varies.then(|| self.acceleration.each_ref().map(|a| &a[start..end]))
    }
}

impl<T: Real, const Q: usize> Local<T, Q> {
    /// Computes the acceleration of the sites of a row, if it varies.
    pub fn accelerate(&self, scratch: &mut Scratch<T>, nx: usize, at: (usize, usize), time: f64) {
        if self.acceleration.field.is_none() {
            return;
        }
        let row = &mut scratch.acceleration;
        for values in row.iter_mut() {
            values.resize(nx, T::zero());
        }
        for x in 0..nx {
            let given = self.acceleration.at([x, at.0, at.1], time);
            for (values, given) in row.iter_mut().zip(given) {
                values[x] = T::of(given);
            }
        }
    }

    /// Replaces populations of sites that lie on the plane of an opening; `earlier` are those after
    /// the collision of the step before, so many sites further inside from a site.
    pub fn complete<L: Lattice<Q>>(
        &self,
        singles: &[Single],
        arrived: &mut [Group<T>; Q],
        (j, k): (usize, usize),
        time: f64,
        earlier: &dyn Fn(usize, [i32; 3]) -> [T; Q],
    ) {
        for (place, single) in singles.iter().enumerate() {
            let Some(number) = single.opening() else { continue };
            let x = single.x as usize;
            let inside = |n: i32| {
                let opening = &self.openings.all[number];
                let mut to = [0; 3];
                to[opening.axis()] = n * opening.inward();
                earlier(x, to)
            };
            let acceleration = self.acceleration.at([x, j, k], time);
            let edge = Edge { site: [x, j, k], time, acceleration };
            let mut f = arrived.each_ref().map(|f| f[place]);
            self.openings.complete::<L, T, Q>(number, &mut f, &edge, &inside);
            for q in 0..Q {
                arrived[q][place] = f[q];
            }
        }
    }

    /// Collides a group of sites, `arrived` at them, in place; where they are, each population is then under
    /// the number of the opposite one.
    pub fn collide(&self, singles: &[Single], arrived: &mut [Group<T>; Q], scratch: &Scratch<T>) {
        let count = singles.len().next_multiple_of(line::<T>());
        let mut acceleration: [Group<T>; 3] = [[T::zero(); MOST_LANES]; 3];
        let varies = !scratch.acceleration[0].is_empty();
        if varies {
            for (a, row) in acceleration.iter_mut().zip(&scratch.acceleration) {
                for (a, single) in a.iter_mut().zip(singles) {
                    *a = row[single.x as usize];
                }
            }
        }
        let varying = varies.then(|| acceleration.each_ref().map(|a| &a[..count]));
        let mut rows = arrived.each_mut().map(|f| &mut f[..count]);
        self.collider.exchange(Slots::of_group(&mut rows), varying);
    }
}

/// Copies what lies in a row from place `first` on, which is in the row or just before it, around its ends.
pub(crate) fn copy_around<T: Copy>(row: &[T], first: isize, into: &mut [T]) {
    let mut place = wrap(first as i32, row.len());
    for value in into {
        *value = row[place];
        place = if place + 1 == row.len() { 0 } else { place + 1 };
    }
}

/// No rows: to be filled in.
#[inline(always)]
pub(crate) fn none<'a, T, const Q: usize>() -> [&'a mut [T]; Q] {
    std::array::from_fn(|_| <&mut [T]>::default())
}
