//! Recursive regularisation (Malaspinas 2015, arXiv:1505.06900).
//!
//! The populations are computed anew from coefficients of Hermite polynomials: density, momentum,
//! stress, and those of higher order that follow from these three. The force changes the velocity
//! between the equilibrium before and the one after (Kupershtokh, Medvedev & Karpov 2009), which up to
//! the square of the acceleration is what Guo, Zheng & Shi (2002) add.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use super::Collide;
use crate::flow;
use crate::frame;
use crate::lattice::Lattice;

/// `f* = sum over n of w H_n (a_n,eq + (1 - omega) a_n,neq)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Regularised;

impl<T: Real> Collide<T> for Regularised {
    #[inline(always)]
    fn collide<L: Lattice<Q>, V: Pack<Scalar = T>, const Q: usize>(
        &self,
        f: [V; Q],
        acceleration: [V; 3],
        omega: V,
    ) -> [V; Q] {
        let (excess, before) = flow::velocity::<L, V, Q>(&f);
        let after = flow::accelerated::<L, V, Q>(&before, &acceleration);
        let stress = flow::stress::<L, V, Q>(&f, excess, &before);
        let kept = flow::scaled::<L, V, Q>(stress, -omega + T::one());
        frame::regularised::<L, V, Q>(excess, &after, kept)
    }
}
