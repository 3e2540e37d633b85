//! What particles have, and what terms read of neighbours and write.

use std::ops::{Index, IndexMut};

use finegrain_framework::Real;

/// A scalar quantity, or one component of a vector or tensor. A model has columns only for those
/// that its terms read or write.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Quantity {
    Velocity(usize),
    Volume,
    PressureTerm,
    WallDepth,
    StressTerm(usize),
    Acceleration(usize),
    DensityRate,
    EnergyRate,
    /// Velocity with which the surface of a body slides along itself; 0 in the fluid.
    SurfaceVelocity(usize),
    /// Velocity that friction sees in a body; 0 in the fluid.
    MirroredVelocity(usize),
    /// Pressure of the fluid, continued into bodies; 0 in the fluid.
    WallPressure,
    Density,
    /// Sums of density differences over the gradient, before the correction.
    DensitySlope(usize),
    /// Corrected gradient of the density.
    DensityGradient(usize),
    /// Moment matrix of the neighbours.
    Moment(usize),
    /// Inverse of the moment matrix.
    Correction(usize),
    /// Smallest eigenvalue of the moment matrix: 1 in the fluid, less at a free surface.
    Fullness,
    /// Velocity of a particle besides that of the fluid.
    Drift(usize),
    Energy,
    Pressure,
    SoundSpeed,
    SmoothingLength,
    /// `Omega` of Springel & Hernquist (2002).
    GradH,
    /// Fastest signal between a particle and its neighbours.
    SignalSpeed,
    PressureRate,
    NumberDensity,
    /// Distance to the nearest surface of a body; negative inside.
    SurfaceDistance,
    /// Acceleration that a particle of a body would have from the forces of the fluid.
    Reaction(usize),
}

impl Quantity {
    /// Number of different quantities.
    pub const COUNT: usize = 59;

    /// Its place among all.
    #[inline(always)]
    pub const fn index(self) -> usize {
        match self {
            Self::Velocity(a) => a,
            Self::Volume => 3,
            Self::PressureTerm => 4,
            Self::WallDepth => 5,
            Self::StressTerm(k) => 6 + k,
            Self::Acceleration(a) => 12 + a,
            Self::DensityRate => 15,
            Self::EnergyRate => 16,
            Self::SurfaceVelocity(a) => 17 + a,
            Self::MirroredVelocity(a) => 20 + a,
            Self::WallPressure => 23,
            Self::Density => 24,
            Self::DensitySlope(a) => 25 + a,
            Self::DensityGradient(a) => 28 + a,
            Self::Moment(k) => 31 + k,
            Self::Correction(k) => 37 + k,
            Self::Fullness => 43,
            Self::Drift(a) => 44 + a,
            Self::Energy => 47,
            Self::Pressure => 48,
            Self::SoundSpeed => 49,
            Self::SmoothingLength => 50,
            Self::GradH => 51,
            Self::SignalSpeed => 52,
            Self::PressureRate => 53,
            Self::NumberDensity => 54,
            Self::SurfaceDistance => 55,
            Self::Reaction(a) => 56 + a,
        }
    }

    /// The components of a vector in `dims` dimensions.
    pub fn vector(component: fn(usize) -> Self, dims: usize) -> impl Iterator<Item = Self> {
        (0..dims).map(component)
    }

    /// The components of a symmetric tensor in `dims` dimensions, in the order xx, xy, yy, xz, yz,
    /// zz.
    pub fn symmetric(component: fn(usize) -> Self, dims: usize) -> impl Iterator<Item = Self> {
        (0..dims * (dims + 1) / 2).map(component)
    }
}

/// Place of component (a, b) of a symmetric tensor in the order xx, xy, yy, xz, yz, zz.
#[inline(always)]
pub(crate) const fn component(a: usize, b: usize) -> usize {
    let (low, high) = if a < b { (a, b) } else { (b, a) };
    high * (high + 1) / 2 + low
}

/// A value for each quantity; 0 for those that are not in use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Values<T>([T; Quantity::COUNT]);

impl<T: Real> Values<T> {
    /// All zero.
    #[inline(always)]
    pub fn zero() -> Self {
        Self([T::zero(); Quantity::COUNT])
    }

    /// Adds a vector to the components that `component` names.
    #[inline(always)]
    pub fn add<const D: usize>(&mut self, component: fn(usize) -> Quantity, vector: [T; D]) {
        for (a, x) in vector.into_iter().enumerate() {
            self[component(a)] += x;
        }
    }
}

impl<T> Index<Quantity> for Values<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, quantity: Quantity) -> &T {
        &self.0[quantity.index()]
    }
}

impl<T> IndexMut<Quantity> for Values<T> {
    #[inline(always)]
    fn index_mut(&mut self, quantity: Quantity) -> &mut T {
        &mut self.0[quantity.index()]
    }
}
