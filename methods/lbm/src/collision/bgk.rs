//! One relaxation time (Qian, d'Humieres & Lallemand 1992).

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use super::Collide;
use crate::flow::Flow;
use crate::lattice::Lattice;

/// `f* = f - omega (f - f_eq) + (1 - omega / 2) S`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bgk;

impl<T: Real> Collide<T> for Bgk {
    #[inline(always)]
    fn collide<L: Lattice<Q>, V: Pack<Scalar = T>, const Q: usize>(
        &self,
        f: [V; Q],
        acceleration: [V; 3],
        omega: V,
    ) -> [V; Q] {
        let flow = Flow::new::<L>(&f, &acceleration);
        let source = omega * T::of(-0.5) + T::one();
        let mut after = f;
        after[0] = f[0]
            + (flow.even_equilibrium::<L>(0) - f[0]) * omega
            + flow.even_source::<L>(0) * source;
        for n in 0..Q / 2 {
            let (q, back) = (2 * n + 1, 2 * n + 2);
            let (even, odd) = (flow.even_equilibrium::<L>(q), flow.odd_equilibrium::<L>(q));
            let sources = (flow.even_source::<L>(q), flow.odd_source::<L>(q));
            after[q] = f[q] + (even + odd - f[q]) * omega + (sources.0 + sources.1) * source;
            after[back] =
                f[back] + (even - odd - f[back]) * omega + (sources.0 - sources.1) * source;
        }
        after
    }
}
