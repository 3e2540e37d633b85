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

/// Lines of three moments, along one direction, on a lattice of `dims` directions.
#[inline(always)]
const fn lines(dims: usize) -> usize {
    3usize.pow(dims as u32 - 1)
}

/// Numbers of the moments of line `n` along direction `A`, of order 0, 1 and 2 in it.
#[inline(always)]
const fn line<const A: usize>(n: usize) -> [usize; 3] {
    let code = n / POWER[A] * 3 * POWER[A] + n % POWER[A];
    [code, code + POWER[A], code + 2 * POWER[A]]
}

/// Coefficients of the equilibrium, `rho u_x^i u_y^j u_z^k`: to all orders that the lattice holds.
#[inline(always)]
pub(crate) fn equilibrium<L: Lattice<Q>, V: Pack, const Q: usize>(
    excess: V,
    u: &[V; 3],
) -> [V; 27] {
    let density = excess + V::Scalar::one();
    let mut coefficients = [density; 27];
    for a in 0..L::DIMS {
        for code in 0..POWER[a] {
            let first = coefficients[code] * u[a];
            coefficients[code + POWER[a]] = first;
            coefficients[code + 2 * POWER[a]] = first * u[a];
        }
    }
    coefficients[0] = excess;
    coefficients
}

/// Moments of Hermite coefficients.
#[inline(always)]
pub(crate) fn moments<L: Lattice<Q>, V: Pack, const Q: usize>(
    mut coefficients: [V; 27],
) -> [V; 27] {
    moments_along::<L, V, Q, 0>(&mut coefficients);
    moments_along::<L, V, Q, 1>(&mut coefficients);
    if L::DIMS == 3 {
        moments_along::<L, V, Q, 2>(&mut coefficients);
    }
    coefficients
}

#[inline(always)]
fn moments_along<L: Lattice<Q>, V: Pack, const Q: usize, const A: usize>(
    coefficients: &mut [V; 27],
) {
    let third = V::Scalar::of(SOUND_SPEED_SQUARED);
    for n in 0..lines(L::DIMS) {
        let [zero, _, two] = line::<A>(n);
        coefficients[two] = coefficients[two] + coefficients[zero] * third;
    }
}

/// Moments of populations.
#[inline(always)]
pub(crate) fn moments_of<L: Lattice<Q>, V: Pack, const Q: usize>(f: &[V; Q]) -> [V; 27] {
    let mut sums = [f[0].splat_like(V::Scalar::zero()); 27];
    for q in 0..Q {
        sums[place::<L, Q>(q)] = f[q];
    }
    sum_along::<L, V, Q, 0>(&mut sums);
    sum_along::<L, V, Q, 1>(&mut sums);
    if L::DIMS == 3 {
        sum_along::<L, V, Q, 2>(&mut sums);
    }
    sums
}

#[inline(always)]
fn sum_along<L: Lattice<Q>, V: Pack, const Q: usize, const A: usize>(sums: &mut [V; 27]) {
    for n in 0..lines(L::DIMS) {
        let [zero, one, two] = line::<A>(n);
        let (plus, minus) = (sums[one], sums[two]);
        sums[two] = plus + minus;
        sums[one] = plus - minus;
        sums[zero] = sums[zero] + sums[two];
    }
}

/// The populations that have these moments.
#[inline(always)]
pub(crate) fn populations<L: Lattice<Q>, V: Pack, const Q: usize>(mut sums: [V; 27]) -> [V; Q] {
    for code in 0..count(L::DIMS) {
        if !exists::<Q>(code) {
            sums[code] = sums[code].splat_like(V::Scalar::zero());
        }
    }
    part_along::<L, V, Q, 0>(&mut sums);
    part_along::<L, V, Q, 1>(&mut sums);
    if L::DIMS == 3 {
        part_along::<L, V, Q, 2>(&mut sums);
    }
    let mut f = [sums[0]; Q];
    for q in 0..Q {
        f[q] = sums[place::<L, Q>(q)];
    }
    f
}

#[inline(always)]
fn part_along<L: Lattice<Q>, V: Pack, const Q: usize, const A: usize>(sums: &mut [V; 27]) {
    let half = V::Scalar::of(0.5);
    for n in 0..lines(L::DIMS) {
        let [zero, one, two] = line::<A>(n);
        let (first, second) = (sums[one], sums[two]);
        sums[zero] = sums[zero] - second;
        sums[one] = (second + first) * half;
        sums[two] = (second - first) * half;
    }
}

/// Moments about a velocity, from those about another one that is lower by `u`.
#[inline(always)]
pub(crate) fn seen_from<L: Lattice<Q>, V: Pack, const Q: usize>(
    mut sums: [V; 27],
    u: &[V; 3],
) -> [V; 27] {
    seen_along::<L, V, Q, 0>(&mut sums, u[0]);
    seen_along::<L, V, Q, 1>(&mut sums, u[1]);
    if L::DIMS == 3 {
        seen_along::<L, V, Q, 2>(&mut sums, u[2]);
    }
    sums
}

#[inline(always)]
fn seen_along<L: Lattice<Q>, V: Pack, const Q: usize, const A: usize>(sums: &mut [V; 27], u: V) {
    for n in 0..lines(L::DIMS) {
        let [zero, one, two] = line::<A>(n);
        let moved = sums[zero] * u;
        sums[two] = sums[two] - (sums[one] * V::Scalar::of(2.0) - moved) * u;
        sums[one] = sums[one] - moved;
    }
}

/// Where a population lies among moments before they are summed up: velocity 0, 1, -1 at place 0, 1,
/// 2 in each direction.
#[inline(always)]
const fn place<L: Lattice<Q>, const Q: usize>(q: usize) -> usize {
    let [x, y, z] = L::VELOCITIES[q];
    code(x) * POWER[0] + code(y) * POWER[1] + code(z) * POWER[2]
}

#[inline(always)]
const fn code(c: i32) -> usize {
    if c < 0 { 2 } else { c as usize }
}
