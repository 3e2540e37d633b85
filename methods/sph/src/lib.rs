//! Smoothed particle hydrodynamics on the finegrain framework.
//!
//! The formulation of Holmes, Williams & Tilke (2011), composed of terms: conservation of mass
//! (I.1), momentum (I.2) with pressure and viscosity, and energy (I.3) where a scene asks for it;
//! an equation of state for weakly compressible flow; gas with shocks and smoothing lengths that
//! follow its density; bodies filled with particles at rest. What a scene does not name has no
//! columns and no loops. 1-D, 2-D and 3-D; in `f32`, in `f64`, or mixed, with positions in `f64` and
//! all else in `f32`.
//!
//! | file | holds |
//! |---|---|
//! | `term/` | one sum over neighbours each, reading like its equation |
//! | `evaluation.rs` | the order of the terms and updates, from what they read and write |
//! | `sweep.rs`, `sums.rs` | a rate stage: gathers what particles see once, and runs the terms over it |
//! | `gathered.rs`, `surroundings.rs`, `neighbourhood.rs` | what a sweep gathers; all that a sub-domain sees, in records; neighbours of a particle, in lanes |
//! | [`kernel`] | smoothing functions |
//! | [`body`], `wall.rs`, `wall_state.rs`, `surface_distance.rs` | bodies, and how the fluid feels them |
//! | [`packing`] | lattices that are exactly periodic |
//! | `start_check.rs`, `initial_state.rs` | refuse a start that makes no sense |
//! | [`physics`], [`scheme`], [`start`] | what a scene models, how, and from which particles |
//! | `liquid.rs`, [`gas`] | the terms and updates that a liquid and a gas are composed of |
//! | [`model`] | builds a framework model of it |
//!
//! # Example
//! A disc of shear in a periodic box.
//! ```
//! use finegrain_framework::space::cells::Region;
//! use finegrain_framework::{Settings, Simulation};
//! use finegrain_sph::{
//!     Fluid, Packing, Physics, Scheme, Sph, Start, StateEquation, Viscosity, measure,
//! };
//!
//! let lattice = Packing::Square.fit([1.0; 3], 0.05)?;
//! let positions: Vec<_> = lattice.positions().collect();
//! let start = Start {
//!     region: Region { lower: vec![0.0; 2], upper: vec![1.0; 2], periodic: vec![true; 2] },
//!     spacing: 0.05,
//!     particle_volume: lattice.volume_per_particle(),
//!     velocities: positions.iter().map(|x| [(std::f64::consts::TAU * x[1]).sin(), 0.0, 0.0]).collect(),
//!     positions,
//! };
//! let fluid = Fluid {
//!     density: 1000.0,
//!     sound_speed: 10.0,
//!     kinematic_viscosity: 0.01,
//!     state_equation: StateEquation::Linear { background: 0.0 },
//! };
//! let physics = Physics { viscosity: Some(Viscosity::Morris), ..Physics::default() };
//! let sph = Sph::<f64>::new(&start, &fluid, &physics, &Scheme::default())?;
//! let mut simulation = Simulation::new(sph.model, Settings::default())?;
//! simulation.advance(50)?;
//! let totals = measure::totals(&mut simulation.whole(), &sph.fields, sph.particle_mass);
//! assert!(totals.kinetic_energy < 250.0 && totals.momentum[0].abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod body;
pub mod dimension;
pub mod error;
pub mod fields;
pub mod fringe;
pub mod gas;
mod gathered;
pub mod kernel;
pub mod measure;
pub mod model;
pub mod packing;
pub mod physics;
pub mod scheme;
pub mod smoothing;
pub mod stabilisation;
pub mod start;
pub mod state_equation;

mod adaptive_density;
mod bins;
mod correction;
mod evaluation;
mod gas_pacing;
mod imposed;
mod initial_state;
mod liquid;
mod neighbourhood;
mod pacing;
mod pairs;
mod quantity;
mod start_check;
mod sums;
mod surface_distance;
mod surroundings;
mod sweep;
mod sweep_part;
mod term;
mod wall;
mod wall_state;

pub use body::{Body, Slip, WallPressure, WallVelocity};
pub use dimension::Dimension;
pub use error::SphError;
pub use fields::Fields;
pub use fringe::Fringe;
pub use gas::ShockCapturing;
pub use kernel::{Kernel, SmoothingFunction};
pub use model::Sph;
pub use packing::{Lattice, Packing};
pub use pairs::Pairs;
pub use physics::{Fluid, Physics, Viscosity};
pub use scheme::{Density, Edac, Gradient, PressureForm, Scheme};
pub use smoothing::Smoothing;
pub use stabilisation::{ArtificialViscosity, DensityDiffusion, DiffusionForm, Stabilisation};
pub use start::Start;
pub use state_equation::StateEquation;
pub use sweep_part::SweepPart;
