//! Smoothed particle hydrodynamics on the finegrain framework.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod dimension;
pub mod fields;
pub mod kernel;
pub mod measure;
pub mod model;
pub mod packing;
pub mod state_equation;
pub mod term;

mod neighbourhood;
mod pacing;
mod sweep;
mod wall;

pub use dimension::Dimension;
pub use fields::Fields;
pub use kernel::{Kernel, SmoothingFunction};
pub use model::{Fluid, Physics, Scheme, Sph, SphError, Start};
pub use packing::{Lattice, Packing};
pub use state_equation::StateEquation;
pub use term::Viscosity;
