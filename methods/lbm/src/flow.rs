//! Density, velocity and stress of a site, from its populations.
//!
//! Populations are stored as what they have beyond the weights, `f_q - w_q`, so that small numbers
//! stay accurate: the density is one plus their sum.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use num_traits::{One, Zero};

use crate::lattice::{self, Lattice, SOUND_SPEED_SQUARED};

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
/// rho v_a v_b`, where `excess` is their sum. With `v` as from [`velocity`] it is free of the force up to the
/// square of the acceleration.
#[inline(always)]
pub(crate) fn stress<L: Lattice<Q>, V: Pack, const Q: usize>(
    f: &[V; Q],
    excess: V,
    v: &[V; 3],
) -> [[V; 3]; 3] {
    let mut stress = [[excess.splat_like(V::Scalar::zero()); 3]; 3];
    let mut even = *f;
    for n in 0..Q / 2 {
        even[2 * n + 1] = f[2 * n + 1] + f[2 * n + 2];
    }
    stress[0][0] = second::<L, V, Q, 0, 0>(&even);
    stress[0][1] = second::<L, V, Q, 0, 1>(&even);
    stress[1][1] = second::<L, V, Q, 1, 1>(&even);
    if L::DIMS == 3 {
        stress[0][2] = second::<L, V, Q, 0, 2>(&even);
        stress[1][2] = second::<L, V, Q, 1, 2>(&even);
        stress[2][2] = second::<L, V, Q, 2, 2>(&even);
    }
    let minus_density = -excess + -V::Scalar::one();
    let pressure = excess * V::Scalar::of(SOUND_SPEED_SQUARED);
    for a in 0..L::DIMS {
        let minus_momentum = minus_density * v[a];
        for b in a..L::DIMS {
            stress[a][b] = minus_momentum.mul_add(v[b], stress[a][b]);
        }
        stress[a][a] = stress[a][a] - pressure;
    }
    for a in 0..L::DIMS {
        for b in 0..a {
            stress[a][b] = stress[b][a];
        }
    }
    stress
}

/// `sum c_A c_B f`, from what pairs of opposite populations sum up to, which is with the first of each.
///
/// Directions are known to the compiler, here and elsewhere, so that a loop over velocities has a short
/// body: it is unrolled then, and what it asks of velocities costs nothing.
#[inline(always)]
fn second<L: Lattice<Q>, V: Pack, const Q: usize, const A: usize, const B: usize>(
    even: &[V; Q],
) -> V {
    let mut sum = even[0].splat_like(V::Scalar::zero());
    for n in 0..Q / 2 {
        let q = 2 * n + 1;
        match L::VELOCITIES[q][A] * L::VELOCITIES[q][B] {
            1 => sum = sum + even[q],
            -1 => sum = sum - even[q],
            _ => {}
        }
    }
    sum
}

/// The stress without its trace.
#[inline(always)]
pub(crate) fn deviator<L: Lattice<Q>, V: Pack, const Q: usize>(
    mut stress: [[V; 3]; 3],
) -> [[V; 3]; 3] {
    let mut trace = stress[0][0];
    for a in 1..L::DIMS {
        trace = trace + stress[a][a];
    }
    let mean = trace * V::Scalar::of(1.0 / L::DIMS as f64);
    for a in 0..L::DIMS {
        stress[a][a] = stress[a][a] - mean;
    }
    stress
}

/// The stress times a number.
#[inline(always)]
pub(crate) fn scaled<L: Lattice<Q>, V: Pack, const Q: usize>(
    mut stress: [[V; 3]; 3],
    by: V,
) -> [[V; 3]; 3] {
    for a in 0..L::DIMS {
        for b in 0..L::DIMS {
            stress[a][b] = stress[a][b] * by;
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

/// A vector times the weights of velocities of squared length 1, 2 and 3.
#[inline(always)]
pub(crate) fn weighted<L: Lattice<Q>, V: Pack, const Q: usize, const N: usize>(
    v: &[V; N],
) -> [[V; N]; 3] {
    let weights = const {
        [lattice::weight::<L, Q>(1), lattice::weight::<L, Q>(2), lattice::weight::<L, Q>(3)]
    };
    let mut all = [*v; 3];
    for l in 0..3 {
        for a in 0..N {
            all[l][a] = v[a] * V::Scalar::of(weights[l]);
        }
    }
    all
}

/// `c . v` of the first of a pair of velocities, the first component of which that is not zero is one.
#[inline(always)]
pub(crate) fn along<V: Pack>(c: [i32; 3], v: &[V; 3]) -> V {
    let part = |sum: V, a: usize| match c[a] {
        1 => sum + v[a],
        -1 => sum - v[a],
        _ => sum,
    };
    match c {
        [1, _, _] => part(part(v[0], 1), 2),
        [_, 1, _] => part(v[1], 2),
        _ => v[2],
    }
}

/// `u . v`.
#[inline(always)]
pub(crate) fn product<L: Lattice<Q>, V: Pack, const Q: usize>(u: &[V; 3], v: &[V; 3]) -> V {
    let mut sum = u[0] * v[0];
    for a in 1..L::DIMS {
        sum = sum + u[a] * v[a];
    }
    sum
}
