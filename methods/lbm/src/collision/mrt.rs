//! Multiple relaxation times of natural moments, seen from the lattice (d'Humieres 1992; Lallemand & Luo
//! 2000; in space d'Humieres et al. 2002).

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use super::Collide;
use super::trt::odd_rate;
use crate::flow;
use crate::hermite::{self, POWER};
use crate::lattice::Lattice;

/// `m* = m + S (m_eq - m)`. The stress without its trace relaxes with the viscosity; moments of odd
/// order such that walls stand still (Ginzburg & d'Humieres 2003); the trace, which is the bulk
/// viscosity, and even moments beyond it at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mrt {
    /// `(1 / omega - 1/2) (1 / omega_odd - 1/2)`.
    pub magic: f64,
}

impl<T: Real> Collide<T> for Mrt {
    #[inline(always)]
    fn collide<L: Lattice<Q>, V: Pack<Scalar = T>, const Q: usize>(
        &self,
        f: [V; Q],
        acceleration: [V; 3],
        omega: V,
    ) -> [V; Q] {
        let (excess, before) = flow::velocity::<L, V, Q>(&f);
        let after = flow::accelerated::<L, V, Q>(&before, &acceleration);
        let now = hermite::moments_of::<L, V, Q>(&f);
        let equilibrium =
            |u: &[V; 3]| hermite::moments::<L, V, Q>(hermite::equilibrium::<L, V, Q>(excess, u));
        let (from, mut to) = (equilibrium(&before), equilibrium(&after));
        let kept = -omega + T::one();
        let kept_odd = -odd_rate(omega, self.magic) + T::one();
        for code in 0..hermite::count(L::DIMS) {
            if hermite::order(code) > 2 && hermite::order(code) % 2 == 1 {
                to[code] = to[code] + (now[code] - from[code]) * kept_odd;
            }
        }
        let mut stress = [[excess; 3]; 3];
        for a in 0..L::DIMS {
            for b in a..L::DIMS {
                let code = POWER[a] + POWER[b];
                stress[a][b] = now[code] - from[code];
            }
        }
        let stress = flow::deviator::<L, V, Q>(stress);
        for a in 0..L::DIMS {
            for b in a..L::DIMS {
                let code = POWER[a] + POWER[b];
                to[code] = to[code] + stress[a][b] * kept;
            }
        }
        hermite::populations::<L, V, Q>(to)
    }
}
