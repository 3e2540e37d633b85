//! Recursive regularisation (Malaspinas 2015, arXiv:1505.06900).
//!
//! The populations are computed anew from coefficients of Hermite polynomials: density, momentum,
//! stress, and those of higher order that follow from these three. Per direction the order is at
//! most 2, which is what the velocities -1, 0, 1 can hold; on D3Q19 polynomials in all three
//! directions do not exist.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use num_traits::{One, Zero};

use super::Collide;
use crate::flow::Flow;
use crate::lattice::{Lattice, SOUND_SPEED_SQUARED};

/// `f* = sum over n of w H_n (a_n,eq + (1 - omega) a_n,neq)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Regularised<T> {
    omega: T,
}

impl<T: Real> Regularised<T> {
    /// With this relaxation time, in time steps.
    pub fn new(relaxation_time: f64) -> Self {
        Self { omega: T::of(1.0 / relaxation_time) }
    }
}

impl<T: Real> Collide<T> for Regularised<T> {
    #[inline(always)]
    fn collide<L: Lattice<Q>, V: Pack<Scalar = T>, const Q: usize>(
        &self,
        f: [V; Q],
        acceleration: [V; 3],
    ) -> [V; Q] {
        let flow = Flow::new::<L>(&f, &acceleration);
        let (density, u) = (flow.density, flow.velocity);
        let half = T::of(0.5);
        let kept = T::one() - self.omega;
        // Half of the force is in `u`; with the other half it is the velocity after the collision.
        let mut after = u;
        for a in 0..L::DIMS {
            after[a] = u[a] + acceleration[a] * half;
        }
        let stress = second_moments::<L, V, Q>(&f);
        let zero = density.splat_like(T::zero());
        // The part beyond equilibrium, free of the force (its moment is -(u F + F u) / 2).
        let mut beyond = [[zero; 3]; 3];
        let mut coefficients = [zero; 27];
        coefficients[0] = flow.excess;
        for a in 0..L::DIMS {
            coefficients[POWER[a]] = density * after[a];
            for b in a..L::DIMS {
                let forcing = density * (u[a] * acceleration[b] + u[b] * acceleration[a]) * half;
                let equilibrium = density * u[a] * u[b];
                beyond[a][b] = stress[a][b] - equilibrium + forcing;
                coefficients[POWER[a] + POWER[b]] = equilibrium + beyond[a][b] * kept + forcing;
            }
        }
        for code in 0..3usize.pow(L::DIMS as u32) {
            let powers = powers(code);
            if powers[0] + powers[1] + powers[2] > 2 && exists::<Q>(powers) {
                let equilibrium = density * product(&after, powers);
                let rest = recursion::<L, V, Q>(&beyond, &u, powers);
                coefficients[code] = equilibrium + rest * kept;
            }
        }
        populations::<L, V, Q>(coefficients)
    }
}

/// Steps between coefficients whose order in x, y or z differs by one.
const POWER: [usize; 3] = [1, 3, 9];

/// The orders in x, y and z of coefficient number `code`.
#[inline(always)]
const fn powers(code: usize) -> [usize; 3] {
    [code % 3, code / 3 % 3, code / 9]
}

/// Whether the lattice holds this polynomial.
#[inline(always)]
const fn exists<const Q: usize>([x, y, z]: [usize; 3]) -> bool {
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

/// A coefficient beyond equilibrium of third order or more (Malaspinas 2015, eq. 14, summed up): over
/// all pairs of its indices, the second-order one of the pair times the velocities of the others.
#[inline(always)]
fn recursion<L: Lattice<Q>, V: Pack, const Q: usize>(
    beyond: &[[V; 3]; 3],
    u: &[V; 3],
    powers: [usize; 3],
) -> V {
    let mut sum = u[0].splat_like(V::Scalar::zero());
    for a in 0..L::DIMS {
        for b in a..L::DIMS {
            let pairs = if a == b {
                powers[a] * powers[a].saturating_sub(1) / 2
            } else {
                powers[a] * powers[b]
            };
            if pairs > 0 {
                let mut others = powers;
                others[a] -= 1;
                others[b] -= 1;
                sum = sum + beyond[a][b] * product(u, others) * V::Scalar::of(pairs as f64);
            }
        }
    }
    sum
}

/// Sums of `(c_a c_b - delta_ab / 3) f`, for `a` up to `b`.
#[inline(always)]
fn second_moments<L: Lattice<Q>, V: Pack, const Q: usize>(f: &[V; Q]) -> [[V; 3]; 3] {
    let mut moments = [[f[0].splat_like(V::Scalar::zero()); 3]; 3];
    for q in 0..Q {
        let c = L::VELOCITIES[q];
        for a in 0..L::DIMS {
            let diagonal = f64::from(c[a] * c[a]) - SOUND_SPEED_SQUARED;
            moments[a][a] = moments[a][a] + f[q] * V::Scalar::of(diagonal);
            for b in a + 1..L::DIMS {
                match c[a] * c[b] {
                    1 => moments[a][b] = moments[a][b] + f[q],
                    -1 => moments[a][b] = moments[a][b] - f[q],
                    _ => {}
                }
            }
        }
    }
    moments
}

/// From coefficients of Hermite polynomials to populations: first to sums of
/// `c_x^i c_y^j c_z^k f`, then, direction by direction, to the populations that have them.
#[inline(always)]
fn populations<L: Lattice<Q>, V: Pack, const Q: usize>(mut sums: [V; 27]) -> [V; Q] {
    let third = V::Scalar::of(SOUND_SPEED_SQUARED);
    let half = V::Scalar::of(0.5);
    let size = 3usize.pow(L::DIMS as u32);
    for a in 0..L::DIMS {
        for code in 0..size {
            if powers(code)[a] == 0 {
                let square = code + 2 * POWER[a];
                sums[square] = sums[square] + sums[code] * third;
            }
        }
    }
    for code in 0..size {
        if !exists::<Q>(powers(code)) {
            sums[code] = sums[code].splat_like(V::Scalar::zero());
        }
    }
    for a in 0..L::DIMS {
        for code in 0..size {
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
        let mut code = 0;
        for a in 0..L::DIMS {
            // Velocity 0, 1, -1 is at place 0, 1, 2.
            code += POWER[a] * L::VELOCITIES[q][a].rem_euclid(3) as usize;
        }
        f[q] = sums[code];
    }
    f
}
