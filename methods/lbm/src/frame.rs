//! Populations from moments as seen from the fluid.
//!
//! Central moments, cumulants and recursive regularisation set the same moments: density, velocity and
//! stress, nothing of third order in the frame of the fluid, and what each of them says beyond. Seen from
//! the lattice a central moment gets shares of those of lower order (Geier et al. 2006), which are
//! written out here plane by plane: some 60 operations on D3Q19, and as many for the populations.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use num_traits::{One, Zero};

use crate::hermite::{self, POWER};
use crate::lattice::{Lattice, SOUND_SPEED_SQUARED};

/// Moments of order two and more about the velocity of the fluid, beyond those of equilibrium; those of
/// odd order are zero.
#[derive(Clone, Copy)]
pub(crate) struct Beyond<V> {
    /// `<a b>`, both halves.
    pub second: [[V; 3]; 3],
    /// `<a a b b>` of the plane across each direction.
    pub fourth: [V; 3],
    /// `<a a b c>` of each direction `a`, on D3Q27.
    pub mixed: [V; 3],
    /// `<x x y y z z>`, on D3Q27.
    pub sixth: V,
}

impl<V: Pack> Beyond<V> {
    /// Nothing beyond the stress.
    #[inline(always)]
    pub fn stress(second: [[V; 3]; 3]) -> Self {
        let zero = second[0][0].splat_like(V::Scalar::zero());
        Self { second, fourth: [zero; 3], mixed: [zero; 3], sixth: zero }
    }
}

/// The directions that span a plane, and the one across it; a lattice in the plane has the first only.
pub(crate) const PLANES: [[usize; 3]; 3] = [[0, 1, 2], [0, 2, 1], [1, 2, 0]];

/// Planes of a lattice of `dims` directions.
#[inline(always)]
pub(crate) const fn planes(dims: usize) -> usize {
    dims * (dims - 1) / 2
}

/// The populations with this density (less one), velocity, and moments.
#[inline(always)]
pub(crate) fn populations<L: Lattice<Q>, V: Pack, const Q: usize>(
    excess: V,
    u: &[V; 3],
    beyond: &Beyond<V>,
) -> [V; Q] {
    if Q == 27 {
        on_cube::<L, V, Q>(excess, u, beyond)
    } else {
        in_planes::<L, V, Q>(excess, u, beyond)
    }
}

/// The populations with this density (less one), velocity and stress beyond equilibrium, and with
/// coefficients of higher order that follow from these (Malaspinas 2015, eqs. 12 to 15). Hermite
/// polynomials keep their coefficients when seen from another frame as powers do (they are Appell's), so
/// in that of the fluid those beyond the stress are zero.
#[inline(always)]
pub(crate) fn regularised<L: Lattice<Q>, V: Pack, const Q: usize>(
    excess: V,
    u: &[V; 3],
    stress: [[V; 3]; 3],
) -> [V; Q] {
    let third = V::Scalar::of(SOUND_SPEED_SQUARED);
    let mut beyond = Beyond::stress(stress);
    for p in 0..planes(L::DIMS) {
        let [a, b, across] = PLANES[p];
        beyond.fourth[across] = (stress[a][a] + stress[b][b]) * third;
        beyond.mixed[across] = stress[a][b] * third;
    }
    if L::DIMS == 3 {
        let trace = stress[0][0] + stress[1][1] + stress[2][2];
        beyond.sixth = trace * (third * third);
    }
    populations::<L, V, Q>(excess, u, &beyond)
}

/// On lattices whose moments all lie in planes.
#[inline(always)]
fn in_planes<L: Lattice<Q>, V: Pack, const Q: usize>(
    excess: V,
    u: &[V; 3],
    beyond: &Beyond<V>,
) -> [V; Q] {
    let third = V::Scalar::of(SOUND_SPEED_SQUARED);
    let density = excess + V::Scalar::one();
    let s = &beyond.second;
    // In each direction, seen from the lattice: momentum, second moments whole and less those of rest.
    let (mut first, mut whole, mut second) = (*u, *u, *u);
    for a in 0..L::DIMS {
        first[a] = density * u[a];
        second[a] = first[a].mul_add(u[a], s[a][a] + excess * third);
        whole[a] = second[a] + third;
    }
    let mut f = [excess; Q];
    let mut left = Left { rest: excess, even: second, odd: first };
    for a in 0..L::DIMS {
        left.rest = left.rest - second[a];
    }
    let seen = Seen { excess, first, whole };
    in_plane::<L, V, Q, 0, 1, 2>(&mut f, &mut left, &seen, u, beyond);
    if L::DIMS == 3 {
        in_plane::<L, V, Q, 0, 2, 1>(&mut f, &mut left, &seen, u, beyond);
        in_plane::<L, V, Q, 1, 2, 0>(&mut f, &mut left, &seen, u, beyond);
    }
    f[0] = left.rest;
    on_axis::<L, V, Q, 0>(&mut f, &left);
    on_axis::<L, V, Q, 1>(&mut f, &left);
    if L::DIMS == 3 {
        on_axis::<L, V, Q, 2>(&mut f, &left);
    }
    f
}

/// Moments of each direction as seen from the lattice.
struct Seen<V> {
    excess: V,
    first: [V; 3],
    /// Those of second order with that of rest.
    whole: [V; 3],
}

/// What is left for rest and axes once diagonals have theirs.
struct Left<V> {
    rest: V,
    even: [V; 3],
    odd: [V; 3],
}

/// The populations on the diagonals of the plane of `A` and `B`.
#[inline(always)]
fn in_plane<
    L: Lattice<Q>,
    V: Pack,
    const Q: usize,
    const A: usize,
    const B: usize,
    const ACROSS: usize,
>(
    f: &mut [V; Q],
    left: &mut Left<V>,
    seen: &Seen<V>,
    u: &[V; 3],
    beyond: &Beyond<V>,
) {
    let [third, ninth] = [SOUND_SPEED_SQUARED, SOUND_SPEED_SQUARED.powi(2)].map(V::Scalar::of);
    let [quarter, two] = [0.25, 2.0].map(V::Scalar::of);
    let Seen { excess, first, whole } = *seen;
    let (s, [ua, ub]) = (&beyond.second, [u[A], u[B]]);
    let both = s[A][B] * two;
    let ab = first[A].mul_add(ub, s[A][B]);
    let aab = ub.mul_add(whole[A], ua * both);
    let abb = ua.mul_add(whole[B], ub * both);
    let about = excess * third + s[A][A] + third;
    let rest = excess * ninth + beyond.fourth[ACROSS];
    let aabb = ua.mul_add(ub.mul_add(both * two, ua * whole[B]), (ub * ub).mul_add(about, rest));
    left.rest = left.rest + aabb;
    left.even[A] = left.even[A] - aabb;
    left.even[B] = left.even[B] - aabb;
    left.odd[A] = left.odd[A] - abb;
    left.odd[B] = left.odd[B] - aab;
    let [along, crossing] = [(aabb + ab) * quarter, (aabb - ab) * quarter];
    let [forward, sideways] = [(abb + aab) * quarter, (abb - aab) * quarter];
    let diagonal = const { diagonals::<L, Q>(A, B) };
    f[diagonal[0]] = along + forward;
    f[diagonal[1]] = along - forward;
    f[diagonal[2]] = crossing + sideways;
    f[diagonal[3]] = crossing - sideways;
}

/// The populations on axis `A`.
#[inline(always)]
fn on_axis<L: Lattice<Q>, V: Pack, const Q: usize, const A: usize>(f: &mut [V; Q], left: &Left<V>) {
    let half = V::Scalar::of(0.5);
    let [plus, minus] = const { axis::<L, Q>(A) };
    f[plus] = (left.even[A] + left.odd[A]) * half;
    f[minus] = (left.even[A] - left.odd[A]) * half;
}

/// With moments in all three directions at once.
#[inline(always)]
fn on_cube<L: Lattice<Q>, V: Pack, const Q: usize>(
    excess: V,
    u: &[V; 3],
    beyond: &Beyond<V>,
) -> [V; Q] {
    let mut about = [excess.splat_like(V::Scalar::zero()); 27];
    for a in 0..3 {
        for b in a..3 {
            about[POWER[a] + POWER[b]] = beyond.second[a][b];
        }
    }
    for [a, b, across] in PLANES {
        about[2 * POWER[a] + 2 * POWER[b]] = beyond.fourth[across];
        about[2 * POWER[across] + POWER[a] + POWER[b]] = beyond.mixed[across];
    }
    about[26] = beyond.sixth;
    let mut moments = hermite::moments::<L, V, Q>(hermite::equilibrium::<L, V, Q>(excess, u));
    let seen = hermite::seen_from::<L, V, Q>(about, &u.map(|u| -u));
    for code in 0..27 {
        moments[code] = moments[code] + seen[code];
    }
    hermite::populations::<L, V, Q>(moments)
}

/// Numbers of the velocities along and against direction `a`.
const fn axis<L: Lattice<Q>, const Q: usize>(a: usize) -> [usize; 2] {
    let mut c = [0; 3];
    c[a] = 1;
    let plus = number::<L, Q>(c);
    c[a] = -1;
    [plus, number::<L, Q>(c)]
}

/// Numbers of the velocities along and against the two diagonals of a plane.
const fn diagonals<L: Lattice<Q>, const Q: usize>(a: usize, b: usize) -> [usize; 4] {
    let mut numbers = [0; 4];
    let signs = [[1, 1], [-1, -1], [1, -1], [-1, 1]];
    let mut n = 0;
    while n < 4 {
        let mut c = [0; 3];
        c[a] = signs[n][0];
        c[b] = signs[n][1];
        numbers[n] = number::<L, Q>(c);
        n += 1;
    }
    numbers
}

/// Number of a velocity; 0 in a plane if it goes across, which is compiled but never run.
const fn number<L: Lattice<Q>, const Q: usize>(c: [i32; 3]) -> usize {
    let mut q = 1;
    while q < Q {
        let v = L::VELOCITIES[q];
        if v[0] == c[0] && v[1] == c[1] && v[2] == c[2] {
            return q;
        }
        q += 1;
    }
    0
}
