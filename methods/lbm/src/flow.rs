//! Density, velocity and force of a site, from its populations, and the equilibrium that belongs to
//! them.
//!
//! Populations are stored as what they have beyond the weights, `f_q - w_q`, so that small numbers
//! stay accurate: the density is one plus their sum.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use num_traits::{One, Zero};

use crate::lattice::Lattice;

/// A pack of sites as the collision sees them, in lattice units.
#[derive(Clone, Copy)]
pub(crate) struct Flow<V> {
    /// Density less one.
    pub excess: V,
    /// Density.
    pub density: V,
    /// Velocity; with half of the force, as of the middle of the collision (Guo, Zheng & Shi 2002,
    /// eq. 6b).
    pub velocity: [V; 3],
    /// Acceleration by the body force.
    pub acceleration: [V; 3],
}

impl<V: Pack> Flow<V> {
    /// From the populations before the collision.
    #[inline(always)]
    pub fn new<L: Lattice<Q>, const Q: usize>(f: &[V; Q], acceleration: [V; 3]) -> Self {
        let (excess, momentum) = moments::<L, V, Q>(f);
        let density = excess + V::Scalar::one();
        let per_density = excess.splat_like(V::Scalar::one()) / density;
        let mut velocity = momentum;
        for a in 0..L::DIMS {
            velocity[a] = momentum[a] * per_density + acceleration[a] * V::Scalar::of(0.5);
        }
        Self { excess, density, velocity, acceleration }
    }

    /// What the equilibria of velocity `q` and its opposite have in common, less the weight: half
    /// of their sum (Qian et al. 1992, eq. 3).
    #[inline(always)]
    pub fn even_equilibrium<L: Lattice<Q>, const Q: usize>(&self, q: usize) -> V {
        let along = project(L::VELOCITIES[q], &self.velocity);
        let speed = self.squared_speed::<L, Q>();
        let quadratic = along * along * V::Scalar::of(4.5) + speed * V::Scalar::of(-1.5);
        (self.excess + self.density * quadratic) * V::Scalar::of(L::WEIGHTS[q])
    }

    /// Half of the difference of the equilibria of velocity `q` and its opposite.
    #[inline(always)]
    pub fn odd_equilibrium<L: Lattice<Q>, const Q: usize>(&self, q: usize) -> V {
        let along = project(L::VELOCITIES[q], &self.velocity);
        self.density * along * V::Scalar::of(3.0 * L::WEIGHTS[q])
    }

    /// Even part of the source by which the force acts, before the factor of the relaxation (Guo,
    /// Zheng & Shi 2002, eq. 20).
    #[inline(always)]
    pub fn even_source<L: Lattice<Q>, const Q: usize>(&self, q: usize) -> V {
        let velocity = project(L::VELOCITIES[q], &self.velocity);
        let acceleration = project(L::VELOCITIES[q], &self.acceleration);
        let mut work = self.velocity[0] * self.acceleration[0];
        for a in 1..L::DIMS {
            work = work + self.velocity[a] * self.acceleration[a];
        }
        let sum = velocity * acceleration * V::Scalar::of(9.0) + work * V::Scalar::of(-3.0);
        self.density * sum * V::Scalar::of(L::WEIGHTS[q])
    }

    /// Odd part of the source.
    #[inline(always)]
    pub fn odd_source<L: Lattice<Q>, const Q: usize>(&self, q: usize) -> V {
        let along = project(L::VELOCITIES[q], &self.acceleration);
        self.density * along * V::Scalar::of(3.0 * L::WEIGHTS[q])
    }

    #[inline(always)]
    fn squared_speed<L: Lattice<Q>, const Q: usize>(&self) -> V {
        let mut sum = self.velocity[0] * self.velocity[0];
        for a in 1..L::DIMS {
            sum = sum + self.velocity[a] * self.velocity[a];
        }
        sum
    }
}

/// Sum of the populations, and their momentum.
#[inline(always)]
pub(crate) fn moments<L: Lattice<Q>, V: Pack, const Q: usize>(f: &[V; Q]) -> (V, [V; 3]) {
    let zero = f[0].splat_like(V::Scalar::zero());
    let (mut sum, mut momentum) = (f[0], [zero; 3]);
    for n in 0..Q / 2 {
        let (q, back) = (2 * n + 1, 2 * n + 2);
        sum = sum + (f[q] + f[back]);
        let difference = f[q] - f[back];
        for a in 0..L::DIMS {
            match L::VELOCITIES[q][a] {
                1 => momentum[a] = momentum[a] + difference,
                -1 => momentum[a] = momentum[a] - difference,
                _ => {}
            }
        }
    }
    (sum, momentum)
}

/// `c . v`.
#[inline(always)]
pub(crate) fn project<V: Pack>(c: [i32; 3], v: &[V; 3]) -> V {
    let mut sum = v[0].splat_like(V::Scalar::zero());
    for a in 0..3 {
        match c[a] {
            1 => sum = sum + v[a],
            -1 => sum = sum - v[a],
            _ => {}
        }
    }
    sum
}
