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
) -> [f64; Q] {
    let pack = |x: f64| One::splat(Scalar, x);
    collision.collide::<L, One, Q>(f.map(pack), acceleration.map(pack)).map(Pack::vector)
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

fn every<const Q: usize, L: Lattice<Q>>(check: impl Fn(&dyn Fn([f64; Q], [f64; 3]) -> [f64; Q])) {
    check(&|f, a| collide::<L, _, Q>(&Bgk::new(TAU), f, a));
    check(&|f, a| collide::<L, _, Q>(&Trt::new(TAU, 3.0 / 16.0), f, a));
    check(&|f, a| collide::<L, _, Q>(&Regularised::new(TAU), f, a));
}

fn keeps_mass_and_adds_force<const Q: usize, L: Lattice<Q>>() {
    let acceleration = [0.003, -0.002, if L::DIMS == 3 { 0.001 } else { 0.0 }];
    every::<Q, L>(|collide| {
        let before = disorder::<Q>();
        let [density, momentum @ ..] = conserved::<L, Q>(&before);
        let after = conserved::<L, Q>(&collide(before, acceleration));
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
    every::<Q, L>(|collide| {
        let before = disorder::<Q>();
        let after = collide(before, [0.0; 3]);
        for a in 0..L::DIMS {
            for b in 0..L::DIMS {
                let [before, after] = [before, after].map(|f| stress::<L, Q>(&f, a, b));
                assert!((after - (1.0 - 1.0 / TAU) * before).abs() < 1e-15, "{a} {b}");
            }
        }
    });
}

#[test]
fn the_stress_relaxes_with_the_viscosity() {
    relaxes_the_stress::<9, D2Q9>();
    relaxes_the_stress::<19, D3Q19>();
    relaxes_the_stress::<27, D3Q27>();
}

/// What a collision in one step (relaxation time 1) leaves is equilibrium: no other changes it.
fn leaves_equilibrium<const Q: usize, L: Lattice<Q>>() {
    let one_step = [
        collide::<L, _, Q>(&Bgk::new(1.0), disorder(), [0.0; 3]),
        collide::<L, _, Q>(&Trt::new(1.0, 0.25), disorder(), [0.0; 3]),
        collide::<L, _, Q>(&Regularised::new(1.0), disorder(), [0.0; 3]),
    ];
    let again = [
        collide::<L, _, Q>(&Bgk::new(TAU), one_step[0], [0.0; 3]),
        collide::<L, _, Q>(&Trt::new(TAU, 0.1), one_step[1], [0.0; 3]),
        collide::<L, _, Q>(&Regularised::new(TAU), one_step[2], [0.0; 3]),
    ];
    for (equilibrium, after) in one_step.iter().zip(&again) {
        for (a, b) in equilibrium.iter().zip(after) {
            assert!((a - b).abs() < 1e-16, "{a} {b}");
        }
    }
}

#[test]
fn equilibrium_stays() {
    leaves_equilibrium::<9, D2Q9>();
    leaves_equilibrium::<19, D3Q19>();
    leaves_equilibrium::<27, D3Q27>();
}

/// The equilibrium of the regularised collision on full lattices is the product of one-dimensional
/// ones with the same three moments, `(1/3 + u^2 -+ u) / 2` and `2/3 - u^2`: that of a gas that
/// flows as a whole, seen from the lattice.
fn is_a_product<const Q: usize, L: Lattice<Q>>() {
    let equilibrium = collide::<L, _, Q>(&Regularised::new(1.0), disorder(), [0.0; 3]);
    let [density, momentum @ ..] = conserved::<L, Q>(&equilibrium);
    let u = momentum.map(|m| m / density);
    for q in 0..Q {
        let factor = |a: usize| match L::VELOCITIES[q][a] {
            0 => 2.0 / 3.0 - u[a] * u[a],
            c => 0.5 * (1.0 / 3.0 + u[a] * u[a] + f64::from(c) * u[a]),
        };
        let product: f64 = (0..L::DIMS).map(factor).product();
        let population = equilibrium[q] + L::WEIGHTS[q];
        assert!((population - density * product).abs() < 1e-16, "{population} {product}");
    }
}

#[test]
fn regularised_equilibrium_is_a_product_on_full_lattices() {
    is_a_product::<9, D2Q9>();
    is_a_product::<27, D3Q27>();
}

/// Bhatnagar, Gross and Krook's collision is that of two relaxation times if both are the same.
#[test]
fn with_equal_times_two_are_one() {
    let acceleration = [0.003, -0.002, 0.001];
    let one = collide::<D3Q19, _, 19>(&Bgk::new(TAU), disorder(), acceleration);
    let magic = (TAU - 0.5) * (TAU - 0.5);
    let two = collide::<D3Q19, _, 19>(&Trt::new(TAU, magic), disorder(), acceleration);
    for (a, b) in one.iter().zip(&two) {
        assert!((a - b).abs() < 1e-16, "{a} {b}");
    }
}
