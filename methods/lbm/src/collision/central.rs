//! Central moments: relaxation seen from the fluid (Geier, Greiner & Korvink 2006; De Rosis 2016, 2017).

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use super::Collide;
use crate::flow;
use crate::frame::{self, Beyond};
use crate::lattice::Lattice;

/// In the frame of the fluid, where the equilibrium is that of rest, the stress without its trace
/// relaxes with the viscosity, and all other moments are set to their equilibrium (De Rosis 2017,
/// eq. 25: rates of one).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Central;

impl<T: Real> Collide<T> for Central {
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
        frame::populations::<L, V, Q>(excess, &after, &Beyond::stress(kept))
    }
}
