//! Two relaxation times (Ginzburg, Verhaeghe & d'Humieres 2008), and one (Bhatnagar, Gross & Krook 1954;
//! Qian, d'Humieres & Lallemand 1992), which is when both are the same.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use super::Collide;
use crate::flow;
use crate::lattice::{self, Lattice};

/// Even and odd parts of each pair of opposite populations relax by themselves: the even part with
/// the relaxation time of the viscosity, the odd one such that
/// `(tau_even - 1/2) (tau_odd - 1/2)` is the magic parameter, or with the same.
///
/// With the equilibrium (Qian et al. 1992, eq. 3) and the force (Guo, Zheng & Shi 2002, eq. 20) written out,
/// half the sum and half the difference of what a pair becomes are
/// `(1 - even_rate) (f + f_back) / 2 + w (even_rate (rho - 1) - u . E / 3 + (c . u) (c . E))` and
/// `(1 - odd_rate) (f - f_back) / 2 + w c . O`
/// with `E = rho (9/2 even_rate u + 9 (1 - even_rate / 2) a)` and
/// `O = rho (3 odd_rate u + 3 (1 - odd_rate / 2) a)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trt {
    /// The magic parameter; `None` for one relaxation time.
    pub magic: Option<f64>,
}

/// Relaxation rate of odd moments: with `tau = 1 / omega`, that of the time `1/2 + magic / (tau - 1/2)`.
#[inline(always)]
pub(crate) fn odd_rate<V: Pack>(omega: V, magic: f64) -> V {
    let viscous = -omega + V::Scalar::of(2.0);
    viscous * V::Scalar::of(2.0) / (viscous + omega * V::Scalar::of(4.0 * magic))
}

impl<T: Real> Collide<T> for Trt {
    #[inline(always)]
    fn collide<L: Lattice<Q>, V: Pack<Scalar = T>, const Q: usize>(
        &self,
        f: [V; Q],
        acceleration: [V; 3],
        omega: V,
    ) -> [V; Q] {
        let even_rate = omega;
        let odd_rate = match self.magic {
            Some(magic) => odd_rate(omega, magic),
            None => omega,
        };
        let [half, third] = [0.5, 1.0 / 3.0].map(T::of);
        let (excess, momentum) = flow::moments::<L, V, Q>(&f);
        let density = excess + T::one();
        let per_density = excess.splat_like(T::one()) / density;
        let [of_velocity, of_force] =
            [density * even_rate, density * (even_rate * -half + T::one())];
        let [odd_velocity, odd_force] =
            [density * odd_rate, density * (odd_rate * -half + T::one())];
        let (mut u, mut even, mut odd) = (momentum, momentum, momentum);
        for a in 0..L::DIMS {
            // In the middle of the collision the velocity has half of the force (Guo et al. 2002, eq. 6b).
            u[a] = momentum[a] * per_density + acceleration[a] * half;
            even[a] = (u[a] * of_velocity + acceleration[a] * of_force * T::of(2.0)) * T::of(4.5);
            odd[a] = (u[a] * odd_velocity + acceleration[a] * odd_force) * T::of(3.0);
        }
        let same = excess * even_rate - flow::product::<L, V, Q>(&u, &even) * third;
        let even = flow::weighted::<L, V, Q, 3>(&even);
        let odd = flow::weighted::<L, V, Q, 3>(&odd);
        let pressure = flow::weighted::<L, V, Q, 1>(&[same]);
        let [even_kept, odd_kept] = [even_rate, odd_rate].map(|rate| rate * -half + half);
        let mut after = f;
        after[0] = f[0] - f[0] * even_rate + same * T::of(L::WEIGHTS[0]);
        for n in 0..Q / 2 {
            let (q, back) = (2 * n + 1, 2 * n + 2);
            let c = L::VELOCITIES[q];
            let l = lattice::square(c) as usize - 1;
            let shift = flow::along(c, &u).mul_add(flow::along(c, &even[l]), pressure[l][0]);
            let even = (f[q] + f[back]).mul_add(even_kept, shift);
            let odd = (f[q] - f[back]).mul_add(odd_kept, flow::along(c, &odd[l]));
            after[q] = even + odd;
            after[back] = even - odd;
        }
        after
    }
}
