//! Particle shifting: particles move a little faster or slower than the fluid, towards where
//! there are fewer.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `-U H sum_j V_j (1 + R (W_ij / W(dx))^4) grad_i W_ij`, m/s, with a speed `U` of the flow, the
/// radius `H` of the support and `R = 0.2`: down the gradient of the particle concentration (Lind
/// et al. 2012), with the factor of Sun, Colagrossi, Marrone & Zhang (2017, eqs. 8 and 10), at
/// most `U / 2`.
///
/// Particles of a free surface move along it only; those of spray not at all (there, eq. 10).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shifting<T> {
    /// `U`, m/s.
    pub speed: T,
    /// `H`, m.
    pub support_radius: T,
    /// `1 / W(dx)` with the spacing `dx`.
    pub inverse_kernel: T,
    /// Particles less full than this are of the free surface, and than half of it spray.
    pub least_fullness: T,
}

/// `R` of Monaghan (2000), against pairing.
const AGAINST_PAIRING: f64 = 0.2;

impl<T: Real> Term<T> for Shifting<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let correction = Quantity::symmetric(Quantity::Correction, dims);
        correction.chain([Quantity::Volume, Quantity::Fullness]).collect()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::Drift, dims).collect()
    }

    fn uses_kernel(&self) -> bool {
        true
    }

    #[inline(always)]
    fn add<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    ) {
        let fullness = i[Quantity::Fullness];
        if fullness < T::of(0.5) * self.least_fullness {
            return;
        }
        let factor = near.gradient_factor();
        let [weight, _] = work.lanes(factor.len());
        let inverse_kernel = self.inverse_kernel;
        let lanes = weight.iter_mut().zip(factor).zip(near.values(Quantity::Volume));
        for (((weight, &factor), &volume), &kernel) in lanes.zip(near.kernel()) {
            let f = kernel * inverse_kernel;
            *weight = factor * volume * (T::of(AGAINST_PAIRING) * (f * f)).mul_add(f * f, T::one());
        }
        let mut drift = near.sum_differences(weight);
        let mut squared = T::zero();
        for a in 0..D {
            drift[a] *= -self.speed * self.support_radius;
            squared += drift[a] * drift[a];
        }
        let most = T::of(0.5) * self.speed;
        if squared > most * most {
            let scale = most / squared.sqrt();
            for a in 0..D {
                drift[a] *= scale;
            }
        }
        if fullness < self.least_fullness {
            let normal = self.normal(i, near, work);
            let mut across = T::zero();
            for a in 0..D {
                across += normal[a] * drift[a];
            }
            for a in 0..D {
                drift[a] -= across * normal[a];
            }
        }
        sums.add(Quantity::Drift, drift);
    }
}

impl<T: Real> Shifting<T> {
    /// Unit normal of the free surface, into the fluid: along the corrected gradient of the
    /// volume fraction (Marrone et al. 2010).
    #[inline(always)]
    fn normal<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
    ) -> [T; D] {
        let factor = near.gradient_factor();
        let [weight, _] = work.lanes(factor.len());
        let lanes = weight.iter_mut().zip(factor).zip(near.values(Quantity::Volume));
        for ((weight, &factor), &volume) in lanes {
            *weight = factor * volume;
        }
        let mut normal = i.corrected(near.sum_differences(weight));
        let mut squared = T::zero();
        for a in 0..D {
            squared += normal[a] * normal[a];
        }
        if squared > T::zero() {
            let scale = T::one() / squared.sqrt();
            for a in 0..D {
                normal[a] *= scale;
            }
        }
        normal
    }
}
