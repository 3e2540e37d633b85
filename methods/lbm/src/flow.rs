//! Density, velocity and force of a site, from its populations, and the equilibrium that belongs to
//! them.
//!
//! Populations are stored as what they have beyond the weights, `f_q - w_q`, so that small numbers
//! stay accurate: the density is one plus their sum.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use num_traits::{One, Zero};

use crate::lattice::{Lattice, SOUND_SPEED_SQUARED};

/// A pack of sites as the collision sees them, in lattice units.
///
/// What is asked of velocity `q` holds for the first of a pair of opposite velocities, or for rest:
/// even parts are those of both, odd parts change sign.
#[derive(Clone, Copy)]
pub(crate) struct Flow<V, const Q: usize> {
    /// Density less one.
    excess: V,
    /// Density.
    density: V,
    /// `c . u`, with the velocity of the middle of the collision: it has half of the force (Guo, Zheng
    /// & Shi 2002, eq. 6b).
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

/// Density less one, and momentum over density: the velocity before the collision, with nothing of the
/// force of the step.
#[inline(always)]
pub(crate) fn velocity<L: Lattice<Q>, V: Pack, const Q: usize>(f: &[V; Q]) -> (V, [V; 3]) {
    let (excess, mut velocity) = moments::<L, V, Q>(f);
    let one = excess.splat_like(V::Scalar::one());
    let per_density = one / (excess + one);
    for a in 0..L::DIMS {
        velocity[a] = velocity[a] * per_density;
    }
    (excess, velocity)
}

/// The velocity after the collision, with the whole force of the step.
#[inline(always)]
pub(crate) fn accelerated<L: Lattice<Q>, V: Pack, const Q: usize>(
    velocity: &[V; 3],
    acceleration: &[V; 3],
) -> [V; 3] {
    let mut after = *velocity;
    for a in 0..L::DIMS {
        after[a] = velocity[a] + acceleration[a];
    }
    after
}

/// Stress beyond equilibrium of populations before the collision, `sum (c_a c_b - delta_ab / 3) f -
/// rho v_a v_b`, for `a` up to `b`. With `v` as from [`velocity`] it is free of the force up to the
/// square of the acceleration.
#[inline(always)]
pub(crate) fn stress<L: Lattice<Q>, V: Pack, const Q: usize>(
    f: &[V; Q],
    excess: V,
    v: &[V; 3],
) -> [[V; 3]; 3] {
    let mut stress = [[excess.splat_like(V::Scalar::zero()); 3]; 3];
    for q in 0..Q {
        let c = L::VELOCITIES[q];
        for a in 0..L::DIMS {
            let diagonal = f64::from(c[a] * c[a]) - SOUND_SPEED_SQUARED;
            stress[a][a] = stress[a][a] + f[q] * V::Scalar::of(diagonal);
            for b in a + 1..L::DIMS {
                match c[a] * c[b] {
                    1 => stress[a][b] = stress[a][b] + f[q],
                    -1 => stress[a][b] = stress[a][b] - f[q],
                    _ => {}
                }
            }
        }
    }
    let density = excess + V::Scalar::one();
    for a in 0..L::DIMS {
        for b in a..L::DIMS {
            stress[a][b] = stress[a][b] - density * v[a] * v[b];
        }
    }
    stress
}

/// The stress without its trace, all of it below the diagonal, too.
#[inline(always)]
pub(crate) fn deviator<L: Lattice<Q>, V: Pack, const Q: usize>(
    mut stress: [[V; 3]; 3],
) -> [[V; 3]; 3] {
    let mut trace = stress[0][0];
    for a in 1..L::DIMS {
        trace = trace + stress[a][a];
    }
    for a in 0..L::DIMS {
        stress[a][a] = stress[a][a] - trace * V::Scalar::of(1.0 / L::DIMS as f64);
        for b in 0..a {
            stress[a][b] = stress[b][a];
        }
    }
    stress
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
