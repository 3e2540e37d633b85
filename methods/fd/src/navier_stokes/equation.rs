//! The terms of incompressible flow on a staggered grid (Harlow & Welch 1965): velocities on the faces of cells,
//! each half a spacing below its cell along its own axis, and pressure in the middle.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use super::around::At;

/// What a stage computes at its points.
pub(crate) trait Term<T: Real, const F: usize, const D: usize, const K: usize>:
    Send + Sync + 'static
{
    /// For messages and traces.
    const NAME: &'static str;

    /// Number of columns that it writes.
    const OUT: usize;

    /// What belongs into column `i`.
    fn value<V: Pack<Scalar = T>>(&self, i: usize, at: At<'_, V, F, D, K>) -> V;

    /// The same for points that are near an end.
    #[inline(always)]
    fn value_near_end<V: Pack<Scalar = T>>(&self, i: usize, at: At<'_, V, F, D, K>) -> V {
        self.value(i, at)
    }

    /// Whether a place along an axis of so many `points` is so near to an end that column `i` differs there.
    #[inline(always)]
    fn is_near_end(&self, _i: usize, _axis: usize, _place: usize, _points: usize) -> bool {
        false
    }
}

/// `-d(u_j u_i)/dx_j + nu d^2 u_i/dx_j^2 + f_i`: the rate of change of the velocity but for the pressure.
pub(crate) struct Momentum<T> {
    pub viscosity: T,
    pub acceleration: [T; 3],
}

impl<T: Real, const D: usize, const K: usize> Term<T, D, D, K> for Momentum<T> {
    const NAME: &'static str = "advection and diffusion";
    const OUT: usize = D;

    #[inline(always)]
    fn value<V: Pack<Scalar = T>>(&self, i: usize, u: At<'_, V, D, D, K>) -> V {
        let mut rate = V::splat(u.simd, self.acceleration[i]);
        for j in 0..D {
            rate = rate - transport(u, i, j) + u.second_derivative(i, j) * self.viscosity;
        }
        rate
    }
}

/// `d(u_j u_i)/dx_j`, without a sum, in the form that keeps momentum and, where the discrete divergence vanishes,
/// energy: of second order that of Harlow & Welch (1965), of fourth Morinishi et al. (1998, J. Comput. Phys. 143),
/// "Div.-S4".
#[inline(always)]
fn transport<V: Pack, const D: usize, const K: usize>(
    u: At<'_, V, D, D, K>,
    i: usize,
    j: usize,
) -> V {
    let mut sum = (flux(u, i, j, 1, 0) - flux(u, i, j, 0, 0)) * u.derivative_weight(j, 0);
    for k in 1..K {
        let far = k as isize;
        let difference = flux(u, i, j, 1 + far, far) - flux(u, i, j, -far, far);
        sum = sum + difference * u.derivative_weight(j, k);
    }
    sum
}

/// `u_j u_i` on face `face` along j, the one below this point being 0: `u_j` from along i, and `u_i` a mean of the two
/// points `2 k + 1` apart about it.
#[inline(always)]
fn flux<V: Pack, const D: usize, const K: usize>(
    u: At<'_, V, D, D, K>,
    i: usize,
    j: usize,
    face: isize,
    k: isize,
) -> V {
    let carried = u.shifted(i, j, face + k) + u.shifted(i, j, face - 1 - k);
    u.mean(j, i, j, face) * carried * V::Scalar::of(0.5)
}

/// `du_j/dx_j`, of whatever fields lie on the faces.
pub(crate) struct Divergence;

impl<T: Real, const D: usize, const K: usize> Term<T, D, D, K> for Divergence {
    const NAME: &'static str = "divergence";
    const OUT: usize = 1;

    #[inline(always)]
    fn value<V: Pack<Scalar = T>>(&self, _: usize, u: At<'_, V, D, D, K>) -> V {
        divergence(u)
    }
}

#[inline(always)]
fn divergence<V: Pack, const D: usize, const K: usize>(u: At<'_, V, D, D, K>) -> V {
    let mut sum = u.derivative_above(0, 0);
    for j in 1..D {
        sum = sum + u.derivative_above(j, j);
    }
    sum
}

/// `-dp/dx_i`, p being the pressure over the density.
pub(crate) struct PressureGradient;

impl<T: Real, const D: usize, const K: usize> Term<T, 1, D, K> for PressureGradient {
    const NAME: &'static str = "pressure gradient";
    const OUT: usize = D;

    #[inline(always)]
    fn value<V: Pack<Scalar = T>>(&self, i: usize, p: At<'_, V, 1, D, K>) -> V {
        -p.derivative_below(0, i)
    }
}

/// The velocity in the middle of cells, and its divergence there: for those who look.
pub(crate) struct InTheMiddle;

impl<T: Real, const D: usize, const K: usize> Term<T, D, D, K> for InTheMiddle {
    const NAME: &'static str = "velocity in the middle";
    const OUT: usize = D + 1;

    #[inline(always)]
    fn value<V: Pack<Scalar = T>>(&self, i: usize, u: At<'_, V, D, D, K>) -> V {
        if i == D {
            return divergence(u);
        }
        // Of fourth order whatever that of the equation, so that looking adds no error to speak of.
        let near = u.shifted(i, i, 0) + u.shifted(i, i, 1);
        let far = u.shifted(i, i, -1) + u.shifted(i, i, 2);
        near * T::of(9.0 / 16.0) - far * T::of(1.0 / 16.0)
    }
}
