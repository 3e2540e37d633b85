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
///
/// What is asked of velocity `q` holds for the first of a pair of opposite velocities, or for rest:
/// even parts are those of both, odd parts change sign.
#[derive(Clone, Copy)]
pub(crate) struct Flow<V, const Q: usize> {
    /// Density less one.
    pub excess: V,
    /// Density.
    pub density: V,
    /// Velocity; with half of the force, as of the middle of the collision (Guo, Zheng & Shi 2002,
    /// eq. 6b).
    pub velocity: [V; 3],
    /// `c . u`.
    velocity_along: [V; Q],
    /// `c . a` of the acceleration by the body force.
    acceleration_along: [V; Q],
    /// `u . u`.
    squared_speed: V,
    /// `u . a`.
    work: V,
}

impl<V: Pack, const Q: usize> Flow<V, Q> {
    /// From the populations before the collision.
    #[inline(always)]
    pub fn new<L: Lattice<Q>>(f: &[V; Q], acceleration: &[V; 3]) -> Self {
        let (excess, momentum) = moments::<L, V, Q>(f);
        let density = excess + V::Scalar::one();
        let per_density = excess.splat_like(V::Scalar::one()) / density;
        let mut velocity = momentum;
        for a in 0..L::DIMS {
            velocity[a] = momentum[a] * per_density + acceleration[a] * V::Scalar::of(0.5);
        }
        Self {
            excess,
            density,
            velocity,
            velocity_along: project::<L, V, Q>(&velocity),
            acceleration_along: project::<L, V, Q>(acceleration),
            squared_speed: product::<L, V, Q>(&velocity, &velocity),
            work: product::<L, V, Q>(&velocity, acceleration),
        }
    }

    /// Half of the sum of the equilibria of velocity `q` and its opposite, less the weight (Qian et
    /// al. 1992, eq. 3).
    #[inline(always)]
    pub fn even_equilibrium<L: Lattice<Q>>(&self, q: usize) -> V {
        let along = self.velocity_along[q];
        let quadratic =
            along * along * V::Scalar::of(4.5) + self.squared_speed * V::Scalar::of(-1.5);
        (self.excess + self.density * quadratic) * V::Scalar::of(L::WEIGHTS[q])
    }

    /// Half of the difference of the equilibria of velocity `q` and its opposite.
    #[inline(always)]
    pub fn odd_equilibrium<L: Lattice<Q>>(&self, q: usize) -> V {
        self.density * self.velocity_along[q] * V::Scalar::of(3.0 * L::WEIGHTS[q])
    }

    /// Even part of the source by which the force acts, before the factor of the relaxation (Guo,
    /// Zheng & Shi 2002, eq. 20).
    #[inline(always)]
    pub fn even_source<L: Lattice<Q>>(&self, q: usize) -> V {
        let along = self.velocity_along[q] * self.acceleration_along[q];
        let sum = along * V::Scalar::of(9.0) + self.work * V::Scalar::of(-3.0);
        self.density * sum * V::Scalar::of(L::WEIGHTS[q])
    }

    /// Odd part of the source.
    #[inline(always)]
    pub fn odd_source<L: Lattice<Q>>(&self, q: usize) -> V {
        self.density * self.acceleration_along[q] * V::Scalar::of(3.0 * L::WEIGHTS[q])
    }
}

/// Sum of the populations, and their momentum.
#[inline(always)]
pub(crate) fn moments<L: Lattice<Q>, V: Pack, const Q: usize>(f: &[V; Q]) -> (V, [V; 3]) {
    let zero = f[0].splat_like(V::Scalar::zero());
    let (mut sum, mut momentum) = (f[0], [zero; 3]);
    for n in 0..Q / 2 {
        sum = sum + (f[2 * n + 1] + f[2 * n + 2]);
    }
    for a in 0..L::DIMS {
        for n in 0..Q / 2 {
            let (q, back) = (2 * n + 1, 2 * n + 2);
            match L::VELOCITIES[q][a] {
                1 => momentum[a] = momentum[a] + (f[q] - f[back]),
                -1 => momentum[a] = momentum[a] - (f[q] - f[back]),
                _ => {}
            }
        }
    }
    (sum, momentum)
}

/// `c . v` of rest and of the first of each pair of velocities.
///
/// Loops over velocities have short bodies where they ask for a velocity's components: the compiler
/// unrolls them then, and the components cost nothing.
#[inline(always)]
fn project<L: Lattice<Q>, V: Pack, const Q: usize>(v: &[V; 3]) -> [V; Q] {
    let mut along = [v[0].splat_like(V::Scalar::zero()); Q];
    for a in 0..L::DIMS {
        for n in 0..Q / 2 {
            let q = 2 * n + 1;
            match L::VELOCITIES[q][a] {
                1 => along[q] = along[q] + v[a],
                -1 => along[q] = along[q] - v[a],
                _ => {}
            }
        }
    }
    along
}

/// `u . v`.
#[inline(always)]
fn product<L: Lattice<Q>, V: Pack, const Q: usize>(u: &[V; 3], v: &[V; 3]) -> V {
    let mut sum = u[0] * v[0];
    for a in 1..L::DIMS {
        sum = sum + u[a] * v[a];
    }
    sum
}
