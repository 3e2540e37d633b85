//! Cumulants (Geier, Schonherr, Pasquali & Krafczyk 2015).

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use num_traits::One;

use super::Collide;
use crate::flow;
use crate::frame::{self, Beyond, PLANES, planes};
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
        let stress = flow::deviator::<L, V, Q>(flow::stress::<L, V, Q>(&f, excess, &before));
        let kept = flow::scaled::<L, V, Q>(stress, -omega + T::one());
        frame::populations::<L, V, Q>(excess, &after, &gaussian::<L, V, Q>(kept, excess))
    }
}

/// Moments about the mean, beyond those of equilibrium, of a Gaussian with the covariance
/// `1/3 + stress / rho`. The stress has no trace.
#[inline(always)]
fn gaussian<L: Lattice<Q>, V: Pack, const Q: usize>(s: [[V; 3]; 3], excess: V) -> Beyond<V> {
    let [third, two] = [SOUND_SPEED_SQUARED, 2.0].map(V::Scalar::of);
    let density = excess + V::Scalar::one();
    let per_density = excess.splat_like(V::Scalar::one()) / density;
    let mut beyond = Beyond::stress(s);
    for p in 0..planes(L::DIMS) {
        let [a, b, c] = PLANES[p];
        // <a a b b> = <a a> <b b> + 2 <a b>^2.
        let products = s[a][a] * s[b][b] + s[a][b] * s[a][b] * two;
        beyond.fourth[c] = (s[a][a] + s[b][b]) * third + products * per_density;
        if Q == 27 {
            // <c c a b> = <c c> <a b> + 2 <c a> <c b>.
            let products = s[c][c] * s[a][b] + s[c][a] * s[c][b] * two;
            beyond.mixed[c] = s[a][b] * third + products * per_density;
        }
    }
    if Q == 27 {
        // <x x y y z z>, in powers of the stress; that of first order is its trace.
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = s;
        let (squares, [xy2, xz2, yz2]) = (xx * yy + yy * zz + zz * xx, [xy * xy, xz * xz, yz * yz]);
        let second = squares + (xy2 + xz2 + yz2) * two;
        let pairs = (xx * yz2 + yy * xz2 + zz * xy2) * two;
        let cubes = xx * yy * zz + pairs + xy * yz * xz * V::Scalar::of(8.0);
        beyond.sixth = second * third * per_density + cubes * per_density * per_density;
    }
    beyond
}
