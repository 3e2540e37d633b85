//! Velocity in bodies that the fluid sticks to.

use finegrain_framework::Real;

use super::{Term, Work};
use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

/// `2 v_s - sum_f v_f W_if / sum_f W_if` (Adami, Hu & Adams 2012, eqs. 22 and 23), over the fluid
/// only, with the velocity `v_s` of the surface: what friction sees in particle `i` of a body. `v_s`
/// where there is no fluid around.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MirroredVelocity<T> {
    /// Whether the surface of any body slides.
    pub slides: bool,
    /// A sum of the kernel up to here counts as no fluid around, 1/m^3 (1/m^2 in 2-D).
    pub least_kernel: T,
}

impl<T: Real> Term<T> for MirroredVelocity<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let surface = Quantity::vector(Quantity::SurfaceVelocity, dims).filter(|_| self.slides);
        Quantity::vector(Quantity::Velocity, dims).chain(surface).collect()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::MirroredVelocity, dims).collect()
    }

    fn uses_kernel(&self) -> bool {
        true
    }

    fn acts_on_bodies(&self) -> bool {
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
        let [weight, one] = work.lanes(near.kernel().len());
        near.kernel_in_fluid(weight);
        one.fill(T::one());
        let [total] = T::dots(weight, [&*one]);
        for a in 0..D {
            let surface = i[Quantity::SurfaceVelocity(a)];
            let [velocity] = T::dots(weight, [near.values(Quantity::Velocity(a))]);
            sums[Quantity::MirroredVelocity(a)] += if total > self.least_kernel {
                T::of(2.0) * surface - velocity / total
            } else {
                surface
            };
        }
    }
}

/// `v_s + s_i g` with `g = sum_f s_f (v_f - v_s) W_if / sum_f s_f^2 W_if`, over the fluid only, where
/// `s` is the distance from the surface, negative in bodies, and `v_s` the velocity of the surface:
/// of all profiles that are linear in `s` and have the surface's velocity at it, the one that fits
/// the fluid around particle `i` of a body best. `v_s` where there is no fluid around.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FittedVelocity<T> {
    /// Whether the surface of any body slides.
    pub slides: bool,
    /// A sum of squares up to here counts as no fluid around, 1/m (1 in 2-D).
    pub least_squares: T,
}

impl<T: Real> Term<T> for FittedVelocity<T> {
    fn reads(&self, dims: usize) -> Vec<Quantity> {
        let surface = Quantity::vector(Quantity::SurfaceVelocity, dims).filter(|_| self.slides);
        let velocity = Quantity::vector(Quantity::Velocity, dims);
        velocity.chain(surface).chain([Quantity::SurfaceDistance]).collect()
    }

    fn writes(&self, dims: usize) -> Vec<Quantity> {
        Quantity::vector(Quantity::MirroredVelocity, dims).collect()
    }

    fn uses_kernel(&self) -> bool {
        true
    }

    fn acts_on_bodies(&self) -> bool {
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
        let [weight, one] = work.lanes(near.kernel().len());
        near.kernel_in_fluid(weight);
        one.fill(T::one());
        let distance = near.values(Quantity::SurfaceDistance);
        for (weight, &distance) in weight.iter_mut().zip(distance) {
            *weight *= distance;
        }
        let [squares, first] = T::dots(weight, [distance, &*one]);
        for a in 0..D {
            let surface = i[Quantity::SurfaceVelocity(a)];
            let [velocity] = T::dots(weight, [near.values(Quantity::Velocity(a))]);
            sums[Quantity::MirroredVelocity(a)] += if squares > self.least_squares {
                let slope = (velocity - surface * first) / squares;
                surface + i[Quantity::SurfaceDistance] * slope
            } else {
                surface
            };
        }
    }
}
