//! Moments of populations, direction by direction.
//!
//! A moment of the orders i, j, k in x, y and z is the sum of `c_x^i c_y^j c_z^k f`; of Hermite
//! polynomials it is a coefficient. Per direction the order is at most 2, which is what the velocities
//! -1, 0, 1 can hold; on D3Q19 moments in all three directions do not exist. Moments are of what
//! populations have beyond the weights, and are kept under the number `i + 3 j + 9 k`.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use num_traits::{One, Zero};

use crate::lattice::{Lattice, SOUND_SPEED_SQUARED};

/// Steps between numbers of moments whose order in x, y or z differs by one.
pub(crate) const POWER: [usize; 3] = [1, 3, 9];

/// Numbers of moments on a lattice of `dims` directions.
#[inline(always)]
pub(crate) const fn count(dims: usize) -> usize {
    3usize.pow(dims as u32)
}

/// The orders in x, y and z of moment number `code`.
#[inline(always)]
pub(crate) const fn powers(code: usize) -> [usize; 3] {
    [code % 3, code / 3 % 3, code / 9]
}

/// The order of moment number `code`, all directions together.
#[inline(always)]
pub(crate) const fn order(code: usize) -> usize {
    let [x, y, z] = powers(code);
    x + y + z
}

/// Whether a lattice of `Q` velocities holds this moment.
#[inline(always)]
pub(crate) const fn exists<const Q: usize>(code: usize) -> bool {
    let [x, y, z] = powers(code);
    Q != 19 || x == 0 || y == 0 || z == 0
}

/// `u_x^i u_y^j u_z^k`.
#[inline(always)]
fn product<V: Pack>(u: &[V; 3], powers: [usize; 3]) -> V {
    let mut product = u[0].splat_like(V::Scalar::one());
    for a in 0..3 {
        for _ in 0..powers[a] {
            product = product * u[a];
        }
    }
    product
}

/// Coefficients of the equilibrium, `rho u_x^i u_y^j u_z^k`: to all orders that the lattice holds.
#[inline(always)]
pub(crate) fn equilibrium<L: Lattice<Q>, V: Pack, const Q: usize>(
    excess: V,
    u: &[V; 3],
) -> [V; 27] {
    let density = excess + V::Scalar::one();
    let mut coefficients = [excess; 27];
    for code in 1..count(L::DIMS) {
        coefficients[code] = density * product(u, powers(code));
    }
    coefficients
}

/// Moments of Hermite coefficients.
#[inline(always)]
pub(crate) fn moments<L: Lattice<Q>, V: Pack, const Q: usize>(
    mut coefficients: [V; 27],
) -> [V; 27] {
    let third = V::Scalar::of(SOUND_SPEED_SQUARED);
    for a in 0..L::DIMS {
        for code in 0..count(L::DIMS) {
            if powers(code)[a] == 0 {
                let square = code + 2 * POWER[a];
                coefficients[square] = coefficients[square] + coefficients[code] * third;
            }
        }
    }
    coefficients
}

/// Moments of populations.
#[inline(always)]
pub(crate) fn moments_of<L: Lattice<Q>, V: Pack, const Q: usize>(f: &[V; Q]) -> [V; 27] {
    let mut sums = [f[0].splat_like(V::Scalar::zero()); 27];
    for q in 0..Q {
        sums[place::<L, Q>(q)] = f[q];
    }
    for a in 0..L::DIMS {
        for code in 0..count(L::DIMS) {
            if powers(code)[a] == 0 {
                let (one, two) = (code + POWER[a], code + 2 * POWER[a]);
                let (plus, minus) = (sums[one], sums[two]);
                sums[two] = plus + minus;
                sums[one] = plus - minus;
                sums[code] = sums[code] + sums[two];
            }
        }
    }
    sums
}

/// The populations that have these moments.
#[inline(always)]
pub(crate) fn populations<L: Lattice<Q>, V: Pack, const Q: usize>(mut sums: [V; 27]) -> [V; Q] {
    let half = V::Scalar::of(0.5);
    for code in 0..count(L::DIMS) {
        if !exists::<Q>(code) {
            sums[code] = sums[code].splat_like(V::Scalar::zero());
        }
    }
    for a in 0..L::DIMS {
        for code in 0..count(L::DIMS) {
            if powers(code)[a] == 0 {
                let (one, two) = (code + POWER[a], code + 2 * POWER[a]);
                let (first, second) = (sums[one], sums[two]);
                sums[code] = sums[code] - second;
                sums[one] = (second + first) * half;
                sums[two] = (second - first) * half;
            }
        }
    }
    let mut f = [sums[0]; Q];
    for q in 0..Q {
        f[q] = sums[place::<L, Q>(q)];
    }
    f
}

/// Moments about a velocity, from those about another one that is lower by `u`.
#[inline(always)]
pub(crate) fn seen_from<L: Lattice<Q>, V: Pack, const Q: usize>(
    mut sums: [V; 27],
    u: &[V; 3],
) -> [V; 27] {
    for a in 0..L::DIMS {
        for code in 0..count(L::DIMS) {
            if powers(code)[a] == 0 {
                let (one, two) = (code + POWER[a], code + 2 * POWER[a]);
                let moved = sums[code] * u[a];
                sums[two] = sums[two] - (sums[one] * V::Scalar::of(2.0) - moved) * u[a];
                sums[one] = sums[one] - moved;
            }
        }
    }
    sums
}

/// Where a population lies among moments before they are summed up: velocity 0, 1, -1 at place 0, 1,
/// 2 in each direction.
#[inline(always)]
fn place<L: Lattice<Q>, const Q: usize>(q: usize) -> usize {
    let mut code = 0;
    for a in 0..L::DIMS {
        code += POWER[a] * L::VELOCITIES[q][a].rem_euclid(3) as usize;
    }
    code
}
