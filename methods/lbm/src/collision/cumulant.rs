//! Cumulants (Geier, Schonherr, Pasquali & Krafczyk 2015).

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use num_traits::{One, Zero};

use super::Collide;
use crate::flow;
use crate::hermite::{self, POWER};
use crate::lattice::{Lattice, SOUND_SPEED_SQUARED};

/// The stress without its trace relaxes with the viscosity; its trace, and all cumulants of higher order,
/// are set to zero beyond equilibrium (all other rates one, as Geier et al. have it by default). So
/// the populations after the collision are those of a Gaussian of which the covariance is the stress
/// after the collision: moments of third and fifth order about its mean are zero, those of fourth and
/// sixth order products of the covariance (Isserlis 1918).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cumulant;

impl<T: Real> Collide<T> for Cumulant {
    #[inline(always)]
    fn collide<L: Lattice<Q>, V: Pack<Scalar = T>, const Q: usize>(
        &self,
        f: [V; Q],
        acceleration: [V; 3],
        omega: V,
    ) -> [V; Q] {
        let (excess, before) = flow::velocity::<L, V, Q>(&f);
        let after = flow::accelerated::<L, V, Q>(&before, &acceleration);
        let mut stress = flow::deviator::<L, V, Q>(flow::stress::<L, V, Q>(&f, excess, &before));
        let kept = -omega + T::one();
        for a in 0..L::DIMS {
            for b in 0..L::DIMS {
                stress[a][b] = stress[a][b] * kept;
            }
        }
        let equilibrium = hermite::equilibrium::<L, V, Q>(excess, &after);
        let mut moments = hermite::moments::<L, V, Q>(equilibrium);
        let about_mean = gaussian::<L, V, Q>(&stress, excess);
        let beyond = hermite::seen_from::<L, V, Q>(about_mean, &after.map(|u| -u));
        for code in 0..hermite::count(L::DIMS) {
            if hermite::order(code) >= 2 {
                moments[code] = moments[code] + beyond[code];
            }
        }
        hermite::populations::<L, V, Q>(moments)
    }
}

/// Moments about the mean, beyond those of equilibrium, of a Gaussian with the covariance
/// `1/3 + stress / rho`. The stress has no trace.
#[inline(always)]
fn gaussian<L: Lattice<Q>, V: Pack, const Q: usize>(stress: &[[V; 3]; 3], excess: V) -> [V; 27] {
    let [third, two] = [SOUND_SPEED_SQUARED, 2.0].map(V::Scalar::of);
    let mut moments = [excess.splat_like(V::Scalar::zero()); 27];
    let density = excess + V::Scalar::one();
    let per_density = excess.splat_like(V::Scalar::one()) / density;
    for a in 0..L::DIMS {
        for b in a..L::DIMS {
            moments[POWER[a] + POWER[b]] = stress[a][b];
        }
    }
    // <a a b b> = <a a> <b b> + 2 <a b>^2.
    for a in 0..L::DIMS {
        for b in a + 1..L::DIMS {
            let products = stress[a][a] * stress[b][b] + stress[a][b] * stress[a][b] * two;
            moments[2 * POWER[a] + 2 * POWER[b]] =
                (stress[a][a] + stress[b][b]) * third + products * per_density;
        }
    }
    if L::DIMS == 3 {
        // <a a b c> = <a a> <b c> + 2 <a b> <a c>.
        for [a, b, c] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            let products = stress[a][a] * stress[b][c] + stress[a][b] * stress[a][c] * two;
            moments[2 * POWER[a] + POWER[b] + POWER[c]] =
                stress[b][c] * third + products * per_density;
        }
        // <x x y y z z>, in powers of the stress; that of first order is its trace.
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = *stress;
        let (squares, [xy2, xz2, yz2]) = (xx * yy + yy * zz + zz * xx, [xy * xy, xz * xz, yz * yz]);
        let second = squares + (xy2 + xz2 + yz2) * two;
        let mixed = (xx * yz2 + yy * xz2 + zz * xy2) * two;
        let cubes = xx * yy * zz + mixed + xy * yz * xz * V::Scalar::of(8.0);
        moments[26] = second * third * per_density + cubes * per_density * per_density;
    }
    moments
}
