//! Two relaxation times (Ginzburg, Verhaeghe & d'Humieres 2008).

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use super::Collide;
use crate::flow::Flow;
use crate::lattice::Lattice;

/// Even and odd parts of each pair of opposite populations relax by themselves: the even part with
/// the relaxation time of the viscosity, the odd one such that
/// `(tau_even - 1/2) (tau_odd - 1/2)` is the magic parameter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trt {
    /// The magic parameter.
    pub magic: f64,
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
        let flow = Flow::new::<L>(&f, &acceleration);
        let half = T::of(0.5);
        let (even_rate, odd_rate) = (omega, odd_rate(omega, self.magic));
        let even_source = -(even_rate * half) + T::one();
        let odd_source = -(odd_rate * half) + T::one();
        let mut after = f;
        after[0] = f[0]
            + (flow.even_equilibrium::<L>(0) - f[0]) * even_rate
            + flow.even_source::<L>(0) * even_source;
        for n in 0..Q / 2 {
            let (q, back) = (2 * n + 1, 2 * n + 2);
            let (even, odd) = ((f[q] + f[back]) * half, (f[q] - f[back]) * half);
            let even_change = (flow.even_equilibrium::<L>(q) - even) * even_rate
                + flow.even_source::<L>(q) * even_source;
            let odd_change = (flow.odd_equilibrium::<L>(q) - odd) * odd_rate
                + flow.odd_source::<L>(q) * odd_source;
            after[q] = f[q] + (even_change + odd_change);
            after[back] = f[back] + (even_change - odd_change);
        }
        after
    }
}
