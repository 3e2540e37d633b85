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
pub(crate) struct Trt<T> {
    even: T,
    odd: T,
}

impl<T: Real> Trt<T> {
    /// With this relaxation time of the viscosity, in time steps, and magic parameter.
    pub fn new(relaxation_time: f64, magic: f64) -> Self {
        let odd_time = 0.5 + magic / (relaxation_time - 0.5);
        Self { even: T::of(1.0 / relaxation_time), odd: T::of(1.0 / odd_time) }
    }
}

impl<T: Real> Collide<T> for Trt<T> {
    #[inline(always)]
    fn collide<L: Lattice<Q>, V: Pack<Scalar = T>, const Q: usize>(
        &self,
        f: [V; Q],
        acceleration: [V; 3],
    ) -> [V; Q] {
        let flow = Flow::new::<L>(&f, &acceleration);
        let half = T::of(0.5);
        let even_source = T::one() - half * self.even;
        let odd_source = T::one() - half * self.odd;
        let mut after = f;
        after[0] = f[0]
            + (flow.even_equilibrium::<L>(0) - f[0]) * self.even
            + flow.even_source::<L>(0) * even_source;
        for n in 0..Q / 2 {
            let (q, back) = (2 * n + 1, 2 * n + 2);
            let (even, odd) = ((f[q] + f[back]) * half, (f[q] - f[back]) * half);
            let even_change = (flow.even_equilibrium::<L>(q) - even) * self.even
                + flow.even_source::<L>(q) * even_source;
            let odd_change = (flow.odd_equilibrium::<L>(q) - odd) * self.odd
                + flow.odd_source::<L>(q) * odd_source;
            after[q] = f[q] + (even_change + odd_change);
            after[back] = f[back] + (even_change - odd_change);
        }
        after
    }
}
