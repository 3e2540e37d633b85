//! Lattice Boltzmann methods on the finegrain framework.
//!
//! Nearly incompressible flow by populations that stream from site to site and collide: D2Q9, D3Q19
//! and D3Q27, `f32` and `f64`, several collisions, body forces, bodies with half-way or interpolated
//! walls, open ends, forces by momentum exchange. Lengths, times and masses are physical; lattice units stay
//! inside.
//!
//! | file | holds |
//! |---|---|
//! | [`lattice`] | velocities and weights |
//! | [`mesh`] | sites and time step: the conversion of units |
//! | `flow.rs` | density, velocity and stress of a site |
//! | `hermite.rs`, `frame.rs` | moments of populations, and populations of moments |
//! | `relaxation.rs` | how fast the stress relaxes, eddies included |
//! | `collision/` | one collision each, reading like its paper |
//! | `stream.rs` | the step with two sets of columns: pull, collide, write |
//! | `in_place.rs` | the step with one set |
//! | `row.rs`, `around.rs` | rows of sites, and the populations around them |
//! | `kernel.rs` | the collision of packs of sites |
//! | `sites.rs`, `link.rs` | what bodies do to rows of sites, and to populations |
//! | [`opening`] | velocity inlets, pressure and non-reflecting outlets |
//! | [`start`] | consistent populations at the beginning |
//! | `derived.rs`, [`measure`] | pressure and velocity; sums over the flow, forces on bodies |
//! | [`physics`], [`body`] | what a scene models, and how |
//! | [`model`] | builds a framework model of it |
//!
//! # Example
//! A shear wave in a periodic box.
//! ```
//! use std::f64::consts::TAU;
//!
//! use finegrain_framework::{Settings, Simulation};
//! use finegrain_lbm::{Fluid, LatticeKind, Lbm, Mesh, Physics, Scheme, Start, measure, mesh};
//!
//! let (spacing, viscosity) = (1.0 / 32.0, 0.01);
//! let mesh = Mesh {
//!     shape: [32, 32, 1],
//!     corner: [0.0; 3],
//!     spacing,
//!     time_step: mesh::time_step_of_relaxation_time(spacing, viscosity, 0.6),
//!     periodic: [true; 3],
//! };
//! let fluid = Fluid { density: 1000.0, kinematic_viscosity: viscosity, largest_speed: 0.1 };
//! let start = Start::with_velocity(|[_, y, _]| [0.1 * (TAU * y).sin(), 0.0, 0.0]);
//! let scheme = Scheme::on(LatticeKind::D2Q9);
//! let lbm = Lbm::<f64>::new(&mesh, &fluid, &Physics::default(), &scheme, &start)?;
//! let mut simulation = Simulation::new(lbm.model, Settings::default())?;
//! simulation.advance(100)?;
//! simulation.derive()?;
//! let energy = measure::totals(&mut simulation.whole(), &lbm.parts).kinetic_energy;
//! let decay = (-2.0 * viscosity * TAU * TAU * simulation.clock().time()).exp();
//! assert!((energy / (2.5 * decay) - 1.0).abs() < 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod body;
pub mod collision;
pub mod error;
pub mod fields;
pub mod lattice;
pub mod measure;
pub mod mesh;
pub mod model;
pub mod opening;
pub mod physics;
pub mod start;

mod acceleration;
mod around;
mod derived;
mod flow;
mod frame;
mod hermite;
mod in_place;
mod kernel;
mod link;
mod relaxation;
mod row;
mod sites;
mod stream;
mod tiles;

pub use body::{Body, Wall};
pub use collision::Collision;
pub use error::LbmError;
pub use fields::Fields;
pub use lattice::{Lattice, LatticeKind};
pub use mesh::Mesh;
pub use model::{Compiled, Lbm};
pub use opening::{Condition, Opening};
pub use physics::{Fluid, Physics, Scheme, Streaming};
pub use start::Start;
