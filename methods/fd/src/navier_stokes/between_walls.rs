//! Advection and diffusion of fourth order between walls, where continuity and pressure are of second.
//!
//! On the meshes of a flow with thin layers nearly all of the error of second order is that of advection, and with that
//! of diffusion most of what remains: the projection, which a direct solver wants to be of second order there, adds
//! little. As what flows has no divergence by differences of second order only, advection is in the form that keeps
//! energy whatever the divergence, half fluxes and half derivatives ("Skew-S4" of Morinishi et al. 1998, J. Comput.
//! Phys. 143). Next to walls, where it would read through them, all is of second order.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use super::around::{At, Coefficients};
use super::equation::{Momentum, Term};

/// Points from a wall to which operators would read through it.
const NEAR: usize = 3;

/// [`Momentum`] between walls.
pub(crate) struct BetweenWalls<T, const D: usize> {
    pub momentum: Momentum<T>,
    /// Of second order.
    pub coefficients: Coefficients<T, D, 1>,
    /// Which axes lie between walls.
    pub walls: [bool; 3],
}

impl<T: Real, const D: usize> Term<T, D, D, 2> for BetweenWalls<T, D> {
    const NAME: &'static str = "advection and diffusion";
    const OUT: usize = D;

    #[inline(always)]
    fn value<V: Pack<Scalar = T>>(&self, i: usize, u: At<'_, V, D, D, 2>) -> V {
        let mut rate = V::splat(u.simd, self.momentum.acceleration[i]);
        for j in 0..D {
            let friction = u.second_derivative(i, j) * self.momentum.viscosity;
            rate = rate - transport(u, i, j) + friction;
        }
        rate
    }

    #[inline(always)]
    fn value_near_end<V: Pack<Scalar = T>>(&self, i: usize, u: At<'_, V, D, D, 2>) -> V {
        self.momentum.value(i, u.with(&self.coefficients))
    }

    /// Velocities along an axis lie on its lower wall at place 0, and would on the upper one at `points`.
    #[inline(always)]
    fn is_near_end(&self, i: usize, axis: usize, place: usize, points: usize) -> bool {
        let last = if i == axis { points } else { points - 1 };
        self.walls[axis] && (place < NEAR || place + NEAR > last)
    }
}

/// `d(u_j u_i) / (2 dx_j) + u_j du_i / (2 dx_j)`, without a sum: of the fluxes of `transport` only what they bring from
/// points beyond them.
#[inline(always)]
fn transport<V: Pack, const D: usize>(u: At<'_, V, D, D, 2>, i: usize, j: usize) -> V {
    let brought = |far: isize| {
        let above = u.mean(j, i, j, 1 + far) * u.shifted(i, j, 1 + 2 * far);
        let below = u.mean(j, i, j, -far) * u.shifted(i, j, -1 - 2 * far);
        (above - below) * u.derivative_weight(j, far as usize)
    };
    (brought(0) + brought(1)) * V::Scalar::of(0.5)
}
