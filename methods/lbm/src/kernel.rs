//! The collision of packs of sites, wherever their populations are.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use crate::acceleration::Acceleration;
use crate::collision::Collide;
use crate::lattice::Lattice;
use crate::relaxation::Relaxation;

/// What happens at a site once its populations have arrived.
pub(crate) struct Kernel<C> {
    pub collision: C,
    pub relaxation: Relaxation,
    pub acceleration: Acceleration,
}

/// Where packs of populations arrive, and leave from.
pub(crate) trait Slots<V: Pack, const Q: usize> {
    /// The populations that have arrived at pack `i`.
    fn arrived(&self, i: usize) -> [V::Vector; Q];
    /// Leaves those after the collision where they go on from.
    fn leave(&mut self, i: usize, f: [V; Q]);
}

/// Acceleration of packs of sites.
pub(crate) struct Accelerations<'a, V: Pack> {
    pub uniform: [V; 3],
    /// Of each pack, if it varies.
    pub varying: Option<[&'a [V::Vector]; 3]>,
}

impl<C> Kernel<C> {
    /// Collides `count` packs.
    #[inline(always)]
    pub fn collide<L: Lattice<Q>, V: Pack, S: Slots<V, Q>, const Q: usize>(
        &self,
        simd: V::Simd,
        count: usize,
        slots: &mut S,
        accelerations: &Accelerations<'_, V>,
    ) where
        C: Collide<V::Scalar>,
    {
        for i in 0..count {
            let vectors = slots.arrived(i);
            let mut f = [accelerations.uniform[0]; Q];
            for q in 0..Q {
                f[q] = V::of(simd, vectors[q]);
            }
            let mut acceleration = accelerations.uniform;
            if let Some(varying) = accelerations.varying {
                for a in 0..L::DIMS {
                    acceleration[a] = V::of(simd, varying[a][i]);
                }
            }
            let omega = self.relaxation.rate::<L, V, Q>(&f);
            slots.leave(i, self.collision.collide::<L, V, Q>(f, acceleration, omega));
        }
    }

    /// Acceleration of the sites of a row into `row`, if it varies.
    pub fn accelerate<T: Real>(
        &self,
        row: &mut [Vec<T>; 3],
        nx: usize,
        (j, k): (usize, usize),
        time: f64,
    ) {
        if self.acceleration.field.is_none() {
            return;
        }
        for values in row.iter_mut() {
            values.resize(nx, T::zero());
        }
        for x in 0..nx {
            let given = self.acceleration.at([x, j, k], time);
            for (values, given) in row.iter_mut().zip(given) {
                values[x] = T::of(given);
            }
        }
    }

    /// The acceleration that is the same everywhere.
    #[inline(always)]
    pub fn uniform<V: Pack>(&self, simd: V::Simd) -> [V; 3] {
        let [x, y, z] = self.acceleration.uniform;
        [
            V::splat(simd, V::Scalar::of(x)),
            V::splat(simd, V::Scalar::of(y)),
            V::splat(simd, V::Scalar::of(z)),
        ]
    }
}
