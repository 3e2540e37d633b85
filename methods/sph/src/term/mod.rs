//! Terms: one piece of physics each, composed by a scene.
//!
//! A term is a sum over the neighbours of a particle. It reads gathered lanes and adds to the
//! particle's sums; the files read like their equations.

pub(crate) mod artificial_pressure;
pub(crate) mod artificial_viscosity;
pub(crate) mod conductivity;
pub(crate) mod continuity;
pub(crate) mod density_diffusion;
pub(crate) mod edac;
pub(crate) mod energy;
pub(crate) mod gas_pressure;
pub(crate) mod moment;
pub(crate) mod momentum;
pub(crate) mod monaghan_viscosity;
pub(crate) mod number_density;
pub(crate) mod pressure_difference;
pub(crate) mod repulsion;
pub(crate) mod shifting;
pub(crate) mod shock_viscosity;
pub(crate) mod strain_rate;
pub(crate) mod tensile_control;
pub(crate) mod transport;
pub(crate) mod viscosity;
pub(crate) mod wall_pressure;
pub(crate) mod wall_velocity;
pub(crate) mod weighted;

use finegrain_framework::Real;
use finegrain_framework::lanes::Buffer;

use crate::neighbourhood::{Neighbours, Particle};
use crate::quantity::{Quantity, Values};

use artificial_pressure::ArtificialPressure;
use artificial_viscosity::ArtificialViscosity;
use conductivity::Conductivity;
use continuity::Continuity;
use density_diffusion::DensityDiffusion;
use edac::PressureEvolution;
use energy::Energy;
use gas_pressure::GasPressure;
use moment::{DensitySlope, MomentMatrix};
use momentum::{PressureGradient, StressDivergence};
use monaghan_viscosity::MonaghanViscosity;
use number_density::NumberDensity;
use pressure_difference::PressureDifference;
use repulsion::Repulsion;
use shifting::Shifting;
use shock_viscosity::ShockViscosity;
use strain_rate::StrainRate;
use tensile_control::TensileControl;
use transport::{Drift, DriftStress};
use viscosity::MorrisViscosity;
use wall_pressure::WallPressure;
use wall_velocity::{FittedVelocity, MirroredVelocity};
use weighted::{WeightedPressureGradient, WeightedViscosity};

/// One piece of physics: a sum over neighbours.
pub(crate) trait Term<T: Real> {
    /// The quantities, its own and its neighbours', that a particle needs.
    fn reads(&self, dims: usize) -> Vec<Quantity>;

    /// The quantities that it adds to.
    fn writes(&self, dims: usize) -> Vec<Quantity>;

    /// Whether it needs the kernel itself, and not only its gradient.
    fn uses_kernel(&self) -> bool {
        false
    }

    /// Whether it runs over the kernel's gradient ([`Neighbours::gradient`]).
    fn uses_gradient(&self) -> bool {
        false
    }

    /// Whether velocities in bodies matter to it, which the no-slip condition extrapolates.
    fn sees_velocity_in_bodies(&self) -> bool {
        false
    }

    /// Whether it is a sum for the particles of bodies, and not for those of the fluid.
    fn acts_on_bodies(&self) -> bool {
        false
    }

    /// Whether it is a force between pairs that particles of bodies feel as much as those of the
    /// fluid do.
    fn pushes_bodies(&self) -> bool {
        false
    }

    /// Adds the sum for particle `i`.
    fn add<const D: usize>(
        &self,
        i: &Particle<T, D>,
        near: &Neighbours<T, D>,
        work: &mut Work<T>,
        sums: &mut Values<T>,
    );
}

/// Declares the enumeration of all terms, which is itself a term: a choice at run time of what is
/// compiled into one loop.
macro_rules! terms {
    ($($Name:ident $(<$Scalar:ident>)?),* $(,)?) => {
        /// Any term, with its constants.
        #[derive(Clone, Copy, Debug)]
        pub(crate) enum AnyTerm<T> {
            $($Name($Name $(<$Scalar>)?),)*
        }

        $(
            impl<T> From<$Name $(<$Scalar>)?> for AnyTerm<T> {
                fn from(term: $Name $(<$Scalar>)?) -> Self {
                    Self::$Name(term)
                }
            }
        )*

        impl<T> AnyTerm<T> {
            /// Its name, for error messages.
            pub fn name(&self) -> &'static str {
                match self {
                    $(Self::$Name(_) => stringify!($Name),)*
                }
            }
        }

        impl<T: Real> Term<T> for AnyTerm<T> {
            fn reads(&self, dims: usize) -> Vec<Quantity> {
                match self {
                    $(Self::$Name(term) => Term::<T>::reads(term, dims),)*
                }
            }

            fn writes(&self, dims: usize) -> Vec<Quantity> {
                match self {
                    $(Self::$Name(term) => Term::<T>::writes(term, dims),)*
                }
            }

            fn uses_kernel(&self) -> bool {
                match self {
                    $(Self::$Name(term) => Term::<T>::uses_kernel(term),)*
                }
            }

            fn uses_gradient(&self) -> bool {
                match self {
                    $(Self::$Name(term) => Term::<T>::uses_gradient(term),)*
                }
            }

            fn sees_velocity_in_bodies(&self) -> bool {
                match self {
                    $(Self::$Name(term) => Term::<T>::sees_velocity_in_bodies(term),)*
                }
            }

            fn acts_on_bodies(&self) -> bool {
                match self {
                    $(Self::$Name(term) => Term::<T>::acts_on_bodies(term),)*
                }
            }

            fn pushes_bodies(&self) -> bool {
                match self {
                    $(Self::$Name(term) => Term::<T>::pushes_bodies(term),)*
                }
            }

            #[inline(always)]
            fn add<const D: usize>(
                &self,
                i: &Particle<T, D>,
                near: &Neighbours<T, D>,
                work: &mut Work<T>,
                sums: &mut Values<T>,
            ) {
                match self {
                    $(Self::$Name(term) => term.add(i, near, work, sums),)*
                }
            }
        }
    };
}

terms!(
    Continuity<T>,
    StrainRate<T>,
    PressureGradient<T>,
    StressDivergence<T>,
    MorrisViscosity<T>,
    MonaghanViscosity<T>,
    Energy<T>,
    MirroredVelocity<T>,
    FittedVelocity<T>,
    WallPressure<T>,
    MomentMatrix<T>,
    DensitySlope<T>,
    DensityDiffusion<T>,
    ArtificialViscosity<T>,
    ArtificialPressure<T>,
    TensileControl<T>,
    Shifting<T>,
    GasPressure<T>,
    ShockViscosity<T>,
    Conductivity<T>,
    Repulsion<T>,
    NumberDensity,
    Drift<T>,
    DriftStress,
    PressureEvolution<T>,
    PressureDifference<T>,
    WeightedPressureGradient<T>,
    WeightedViscosity<T>,
);

/// Lanes that a term works with: a weight for each neighbour.
#[derive(Clone, Debug, Default)]
pub(crate) struct Work<T>([Buffer<T>; 2]);

impl<T: Real> Work<T> {
    /// Two work lanes of `length` neighbours, holding whatever they held.
    #[inline(always)]
    pub fn lanes(&mut self, length: usize) -> [&mut [T]; 2] {
        let [first, second] = &mut self.0;
        if first.len() < length {
            first.resize(length);
            second.resize(length);
        }
        [&mut first[..length], &mut second[..length]]
    }
}
