//! Two relaxation times (Ginzburg, Verhaeghe & d'Humieres 2008), and one (Bhatnagar, Gross & Krook 1954;
//! Qian, d'Humieres & Lallemand 1992), which is when both are the same.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use super::Collide;
use crate::flow;
use crate::lattice::Lattice;

/// Even and odd parts of each pair of opposite populations relax by themselves: the even part with
/// the relaxation time of the viscosity, the odd one such that
/// `(tau_even - 1/2) (tau_odd - 1/2)` is the magic parameter, or with the same.
///
/// With the equilibrium (Qian et al. 1992, eq. 3) and the force (Guo, Zheng & Shi 2002, eq. 20) written out,
/// what a pair gets has few parts that are its own:
/// `w (even_rate (rho - 1) - u . E / 3 + (c . u) (c . E)) - even_rate f_even +- (w c . O - odd_rate f_odd)`
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
        let u = flow::project::<L, V, Q>(&u);
        let even = flow::project::<L, V, Q>(&even);
        let odd = flow::project::<L, V, Q>(&odd);
        let [even_half, odd_half] = [even_rate * half, odd_rate * half];
        let mut after = f;
        after[0] = f[0] + (same * T::of(L::WEIGHTS[0]) - f[0] * even_rate);
        for n in 0..Q / 2 {
            let (q, back) = (2 * n + 1, 2 * n + 2);
            let weight = T::of(L::WEIGHTS[q]);
            let even = (same + u[q] * even[q]) * weight - (f[q] + f[back]) * even_half;
            let odd = odd[q] * weight - (f[q] - f[back]) * odd_half;
            after[q] = f[q] + (even + odd);
            after[back] = f[back] + (even - odd);
        }
        after
    }
}
