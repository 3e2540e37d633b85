//! What every collision must do, on every lattice.

use finegrain_framework::pack::{Pack, PackF64};
use pulp::Scalar;

use super::*;
use crate::lattice::{D2Q9, D3Q19, D3Q27};

type One = PackF64<Scalar>;

const TAU: f64 = 0.83;

/// Populations that are in no order, beyond the weights.
fn disorder<const Q: usize>() -> [f64; Q] {
    std::array::from_fn(|q| 0.01 * (1.7 * q as f64 + 0.3).sin())
}

fn collide<L: Lattice<Q>, C: Collide<f64>, const Q: usize>(
    collision: &C,
    f: [f64; Q],
    acceleration: [f64; 3],
    tau: f64,
) -> [f64; Q] {
    let pack = |x: f64| One::splat(Scalar, x);
    let (f, acceleration) = (f.map(pack), acceleration.map(pack));
    collision.collide::<L, One, Q>(f, acceleration, pack(1.0 / tau)).map(Pack::vector)
}

/// Density and momentum.
fn conserved<L: Lattice<Q>, const Q: usize>(f: &[f64; Q]) -> [f64; 4] {
    let sum = |of: &dyn Fn([i32; 3]) -> f64| -> f64 {
        f.iter().zip(L::VELOCITIES).map(|(f, c)| f * of(c)).sum()
    };
    let [x, y, z] = [0, 1, 2].map(|a| sum(&|c: [i32; 3]| f64::from(c[a])));
    [1.0 + sum(&|_| 1.0), x, y, z]
}

/// `sum c_a c_b f` less that of equilibrium.
fn stress<L: Lattice<Q>, const Q: usize>(f: &[f64; Q], a: usize, b: usize) -> f64 {
    let [density, momentum @ ..] = conserved::<L, Q>(f);
    let pressure = if a == b { (density - 1.0) / 3.0 } else { 0.0 };
    let all: f64 = f.iter().zip(L::VELOCITIES).map(|(f, c)| f * f64::from(c[a] * c[b])).sum();
    all - pressure - momentum[a] * momentum[b] / density
}

/// A collision: populations, acceleration, relaxation time.
type Collided<'a, const Q: usize> = &'a dyn Fn([f64; Q], [f64; 3], f64) -> [f64; Q];

/// What differs between collisions.
#[derive(Clone, Copy)]
struct Kind {
    /// The trace of the stress relaxes with the viscosity, too.
    relaxes_trace: bool,
    /// The equilibrium has terms of third order in the velocity and more.
    is_whole: bool,
}

/// Checks every collision.
fn every<const Q: usize, L: Lattice<Q>>(check: impl Fn(Collided<'_, Q>, Kind)) {
    let kind = |relaxes_trace, is_whole| Kind { relaxes_trace, is_whole };
    let magic = 3.0 / 16.0;
    check(&|f, a, tau| collide::<L, _, Q>(&Trt { magic: None }, f, a, tau), kind(true, false));
    check(
        &|f, a, tau| collide::<L, _, Q>(&Trt { magic: Some(magic) }, f, a, tau),
        kind(true, false),
    );
    check(&|f, a, tau| collide::<L, _, Q>(&Regularised, f, a, tau), kind(true, true));
    check(&|f, a, tau| collide::<L, _, Q>(&Mrt { magic }, f, a, tau), kind(false, true));
    check(&|f, a, tau| collide::<L, _, Q>(&Central, f, a, tau), kind(false, true));
    check(&|f, a, tau| collide::<L, _, Q>(&Cumulant, f, a, tau), kind(false, true));
}

fn keeps_mass_and_adds_force<const Q: usize, L: Lattice<Q>>() {
    let acceleration = [0.003, -0.002, if L::DIMS == 3 { 0.001 } else { 0.0 }];
    every::<Q, L>(|collide, _| {
        let before = disorder::<Q>();
        let [density, momentum @ ..] = conserved::<L, Q>(&before);
        let after = conserved::<L, Q>(&collide(before, acceleration, TAU));
        assert!((after[0] - density).abs() < 1e-15);
        for a in 0..3 {
            assert!((after[1 + a] - momentum[a] - density * acceleration[a]).abs() < 1e-15);
        }
    });
}

#[test]
fn mass_is_kept_and_momentum_changes_by_the_force() {
    keeps_mass_and_adds_force::<9, D2Q9>();
    keeps_mass_and_adds_force::<19, D3Q19>();
    keeps_mass_and_adds_force::<27, D3Q27>();
}

/// Without force the stress relaxes with the relaxation time of the viscosity, at any velocity.
fn relaxes_the_stress<const Q: usize, L: Lattice<Q>>() {
    every::<Q, L>(|collide, kind| {
        let before = disorder::<Q>();
        let after = collide(before, [0.0; 3], TAU);
        let trace = |f: &[f64; Q]| (0..L::DIMS).map(|a| stress::<L, Q>(f, a, a)).sum::<f64>();
        for a in 0..L::DIMS {
            for b in 0..L::DIMS {
                let [before, after] = [before, after].map(|f| {
                    let rest = if a == b && !kind.relaxes_trace {
                        trace(&f) / L::DIMS as f64
                    } else {
                        0.0
                    };
                    stress::<L, Q>(&f, a, b) - rest
                });
                assert!((after - (1.0 - 1.0 / TAU) * before).abs() < 1e-15, "{a} {b}");
            }
        }
        if !kind.relaxes_trace {
            assert!(trace(&before).abs() > 1e-3 && trace(&after).abs() < 1e-15);
        }
    });
}

#[test]
fn the_stress_relaxes_with_the_viscosity() {
    relaxes_the_stress::<9, D2Q9>();
    relaxes_the_stress::<19, D3Q19>();
    relaxes_the_stress::<27, D3Q27>();
}

/// What many collisions leave is equilibrium: one with another relaxation time does not change it.
fn leaves_equilibrium<const Q: usize, L: Lattice<Q>>() {
    every::<Q, L>(|collide, _| {
        let mut equilibrium = disorder();
        for _ in 0..200 {
            equilibrium = collide(equilibrium, [0.0; 3], 1.0);
        }
        let after = collide(equilibrium, [0.0; 3], TAU);
        for (a, b) in equilibrium.iter().zip(&after) {
            assert!((a - b).abs() < 2e-16, "{a} {b}");
        }
    });
}

#[test]
fn equilibrium_stays() {
    leaves_equilibrium::<9, D2Q9>();
    leaves_equilibrium::<19, D3Q19>();
    leaves_equilibrium::<27, D3Q27>();
}

/// The equilibrium of collisions by moments is on full lattices the product of one-dimensional ones with
/// the same three moments, `(1/3 + u^2 -+ u) / 2` and `2/3 - u^2`: that of a gas that flows as a
/// whole, seen from the lattice. So nothing in them depends on the velocity of the frame.
fn is_a_product<const Q: usize, L: Lattice<Q>>() {
    every::<Q, L>(|collide, kind| {
        let mut equilibrium = disorder();
        for _ in 0..200 {
            equilibrium = collide(equilibrium, [0.0; 3], 1.0);
        }
        let [density, momentum @ ..] = conserved::<L, Q>(&equilibrium);
        let u = momentum.map(|m| m / density);
        let mut furthest = 0.0f64;
        for q in 0..Q {
            let factor = |a: usize| match L::VELOCITIES[q][a] {
                0 => 2.0 / 3.0 - u[a] * u[a],
                c => 0.5 * (1.0 / 3.0 + u[a] * u[a] + f64::from(c) * u[a]),
            };
            let product: f64 = (0..L::DIMS).map(factor).product();
            furthest = furthest.max((equilibrium[q] + L::WEIGHTS[q] - density * product).abs());
        }
        if kind.is_whole {
            assert!(furthest < 2e-16, "{furthest}");
        } else {
            assert!((1e-8..1e-4).contains(&furthest), "{furthest}");
        }
    });
}

#[test]
fn equilibrium_is_a_product_on_full_lattices() {
    is_a_product::<9, D2Q9>();
    is_a_product::<27, D3Q27>();
}

/// Bhatnagar, Gross and Krook's collision is that of two relaxation times if both are the same.
#[test]
fn with_equal_times_two_are_one() {
    let acceleration = [0.003, -0.002, 0.001];
    let one = collide::<D3Q19, _, 19>(&Trt { magic: None }, disorder(), acceleration, TAU);
    let magic = (TAU - 0.5) * (TAU - 0.5);
    let two = collide::<D3Q19, _, 19>(&Trt { magic: Some(magic) }, disorder(), acceleration, TAU);
    for (a, b) in one.iter().zip(&two) {
        assert!((a - b).abs() < 1e-16, "{a} {b}");
    }
}

/// `sum (c_x - u_x)^i (c_y - u_y)^j (c_z - u_z)^k f`, of whole populations.
fn central<L: Lattice<Q>, const Q: usize>(f: &[f64; Q], orders: [i32; 3]) -> f64 {
    let [density, momentum @ ..] = conserved::<L, Q>(f);
    let power = |q: usize| -> f64 {
        let about = |a: usize| f64::from(L::VELOCITIES[q][a]) - momentum[a] / density;
        (0..3).map(|a| about(a).powi(orders[a])).product()
    };
    (0..Q).map(|q| (f[q] + L::WEIGHTS[q]) * power(q)).sum()
}

/// Each pair of directions in its plane, x first.
const PLANES: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];

fn orders(a: usize, b: usize, [i, j]: [i32; 2]) -> [i32; 3] {
    let mut orders = [0; 3];
    orders[a] = i;
    orders[b] = j;
    orders
}

/// What the papers say about moments seen from the fluid after the collision: those of third order are
/// zero; those of fourth order are those of rest (central moments), those of a Gaussian (cumulants), or
/// such that Hermite's coefficient is zero (regularised).
fn moments_seen_from_the_fluid<const Q: usize, L: Lattice<Q>>() {
    let before = disorder::<Q>();
    let central_moments = collide::<L, _, Q>(&Central, before, [0.0; 3], TAU);
    let cumulants = collide::<L, _, Q>(&Cumulant, before, [0.0; 3], TAU);
    let regularised = collide::<L, _, Q>(&Regularised, before, [0.0; 3], TAU);
    let [density, ..] = conserved::<L, Q>(&before);
    for &[a, b] in &PLANES[..if L::DIMS == 2 { 1 } else { 3 }] {
        for f in [&central_moments, &cumulants, &regularised] {
            for third in [[2, 1], [1, 2]] {
                assert!(central::<L, Q>(f, orders(a, b, third)).abs() < 1e-16);
            }
        }
        let fourth = |f| central::<L, Q>(f, orders(a, b, [2, 2]));
        let second = |f, ij| central::<L, Q>(f, orders(a, b, ij));
        assert!((fourth(&central_moments) - density / 9.0).abs() < 1e-16);
        let [aa, bb, ab] = [[2, 0], [0, 2], [1, 1]].map(|ij| second(&cumulants, ij));
        assert!((fourth(&cumulants) - (aa * bb + 2.0 * ab * ab) / density).abs() < 1e-16);
        assert!((aa * bb / density - density / 9.0).abs() > 1e-8);
        let [aa, bb] = [[2, 0], [0, 2]].map(|ij| second(&regularised, ij));
        assert!((fourth(&regularised) - (aa + bb) / 3.0 + density / 9.0).abs() < 1e-16);
    }
}

#[test]
fn moments_beyond_the_stress_are_as_the_papers_say() {
    moments_seen_from_the_fluid::<9, D2Q9>();
    moments_seen_from_the_fluid::<19, D3Q19>();
    moments_seen_from_the_fluid::<27, D3Q27>();
}

/// A Gaussian's moments in all three directions (Isserlis 1918).
#[test]
fn cumulants_in_all_directions() {
    let f = collide::<D3Q27, _, 27>(&Cumulant, disorder(), [0.0; 3], TAU);
    let [density, ..] = conserved::<D3Q27, 27>(&f);
    let moment = |orders| central::<D3Q27, 27>(&f, orders) / density;
    let [xx, yy, zz] = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(moment);
    let [xy, xz, yz] = [[1, 1, 0], [1, 0, 1], [0, 1, 1]].map(moment);
    let is = |orders, expected: f64| {
        let found = moment(orders);
        assert!((found - expected).abs() < 1e-16, "{orders:?}: {found} {expected}");
    };
    is([1, 1, 1], 0.0);
    is([2, 2, 1], 0.0);
    is([2, 1, 1], xx * yz + 2.0 * xy * xz);
    is([1, 2, 1], yy * xz + 2.0 * xy * yz);
    is([1, 1, 2], zz * xy + 2.0 * xz * yz);
    let pairs = xx * yz * yz + yy * xz * xz + zz * xy * xy;
    is([2, 2, 2], xx * yy * zz + 2.0 * pairs + 8.0 * xy * xz * yz);
}

/// Natural moments of odd order relax with the rate of the magic parameter, those of even order beyond
/// the stress at once.
#[test]
fn natural_moments_relax_each_with_its_time() {
    let magic = 0.3;
    let before = disorder::<19>();
    let after = collide::<D3Q19, _, 19>(&Mrt { magic }, before, [0.0; 3], TAU);
    let mut equilibrium = before;
    for _ in 0..200 {
        equilibrium = collide::<D3Q19, _, 19>(&Mrt { magic }, equilibrium, [0.0; 3], 1.0);
    }
    let natural = |f: &[f64; 19], orders: [i32; 3]| -> f64 {
        let power = |q: usize| -> f64 {
            (0..3).map(|a| f64::from(D3Q19::VELOCITIES[q][a]).powi(orders[a])).product()
        };
        (0..19).map(|q| f[q] * power(q)).sum()
    };
    let odd = 1.0 / (0.5 + magic / (TAU - 0.5));
    for &[a, b] in &PLANES {
        for (powers, rate) in [([2, 1], odd), ([1, 2], odd), ([2, 2], 1.0)] {
            let of =
                |f| natural(f, orders(a, b, powers)) - natural(&equilibrium, orders(a, b, powers));
            assert!((of(&after) - (1.0 - rate) * of(&before)).abs() < 1e-16);
            assert!(of(&before).abs() > 1e-4);
        }
    }
}

/// The force of Guo, Zheng & Shi (2002): the velocity of the middle of the collision is that of the
/// equilibrium, and the stress gets `(1 - omega / 2) rho (u a + a u)` (eqs. 6b and 20).
#[test]
fn one_and_two_times_have_the_force_of_guo() {
    let (acceleration, before) = ([0.003, -0.002, 0.001], disorder::<19>());
    let [density, momentum @ ..] = conserved::<D3Q19, 19>(&before);
    let u = [0, 1, 2].map(|a| momentum[a] / density + 0.5 * acceleration[a]);
    for magic in [None, Some(0.3)] {
        let after = collide::<D3Q19, _, 19>(&Trt { magic }, before, acceleration, TAU);
        for (a, b) in [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2)] {
            let second = |f: &[f64; 19]| -> f64 {
                (0..19)
                    .map(|q| f64::from(D3Q19::VELOCITIES[q][a] * D3Q19::VELOCITIES[q][b]) * f[q])
                    .sum()
            };
            let pressure = if a == b { (density - 1.0) / 3.0 } else { 0.0 };
            let equilibrium = pressure + density * u[a] * u[b];
            let source = density * (u[a] * acceleration[b] + u[b] * acceleration[a]);
            let expected = second(&before)
                + (equilibrium - second(&before)) / TAU
                + (1.0 - 0.5 / TAU) * source;
            assert!((second(&after) - expected).abs() < 1e-16, "{a} {b}");
        }
    }
}

/// Hermite's coefficients beyond the stress are zero in all three directions, too.
#[test]
fn regularised_in_all_directions() {
    let f = collide::<D3Q27, _, 27>(&Regularised, disorder(), [0.0; 3], TAU);
    let [density, ..] = conserved::<D3Q27, 27>(&f);
    let moment = |orders| central::<D3Q27, 27>(&f, orders);
    let is = |orders, expected: f64| {
        let found = moment(orders);
        assert!((found - expected).abs() < 1e-16, "{orders:?}: {found} {expected}");
    };
    is([1, 1, 1], 0.0);
    is([2, 2, 1], 0.0);
    is([2, 1, 1], moment([0, 1, 1]) / 3.0);
    is([1, 2, 1], moment([1, 0, 1]) / 3.0);
    is([1, 1, 2], moment([1, 1, 0]) / 3.0);
    let trace = moment([2, 0, 0]) + moment([0, 2, 0]) + moment([0, 0, 2]) - density;
    is([2, 2, 2], density / 27.0 + trace / 9.0);
    assert!(trace.abs() > 1e-4);
}
