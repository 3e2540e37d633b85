//! Finite differences on the finegrain framework.
//!
//! Equations on evenly spaced points in 1 to 3 directions, `f32` and `f64`: central differences of order 2 to 8
//! with summation by parts at boundaries, upwind and WENO differences for what flows. An equation is a file that
//! reads as on paper, `rate = laplacian(T) * diffusivity`; rows, boundaries and vectors lie below it.
//!
//! | file | holds |
//! |---|---|
//! | [`operator`] | coefficients of difference operators, exact |
//! | [`mesh`], [`boundary`] | where points are, and what holds at the ends |
//! | [`equation`] | one equation each, and how long its time steps may be |
//! | `around.rs` | what an equation sees: fields around a pack of points, and their derivatives |
//! | `line.rs` | derivatives along one axis, with its boundary conditions |
//! | `sweep.rs`, `plane.rs`, `row.rs` | the stage that evaluates an equation: rows of a tile and those around them, packs of a row |
//! | `stability.rs` | the longest stable time step |
//! | `time_stepping.rs`, `implicit/` | explicit and implicit steps; the latter with the cargo feature `implicit` |
//! | `navier_stokes/` | incompressible flow on a staggered grid: its terms, stages and model |
//! | `poisson/` | the pressure, by waves along each axis |
//! | [`measure`] | integrals and extremes |
//! | [`model`] | builds a framework model |
//!
//! # Example
//! Heat in a plate between two cold and two insulated ends.
//! ```
//! use std::f64::consts::PI;
//!
//! use finegrain_fd::{Boundary, Condition, Heat, Mesh, Order, Side, measure};
//! use finegrain_framework::{Integrator, Settings, Simulation};
//!
//! let mut boundary = Boundary::all(Condition::dirichlet(0.0));
//! boundary.0[1] = [Condition::neumann(0.0), Condition::neumann(0.0)];
//! let heat = Heat { diffusivity: 0.1, order: Order::Fourth, integrator: Integrator::Rk4.into(), boundary };
//! let mesh = Mesh::new([Side::ends(33, 0.0, 1.0), Side::ends(17, 0.0, 0.5)]);
//! let time_step = 0.5 * heat.time_step_limit(&mesh)?;
//! let plate = heat.model::<f64>(&mesh, time_step, &|[x, _, _]| (PI * x).sin())?;
//! let mut simulation = Simulation::new(plate.model, Settings::default())?;
//! simulation.advance(100)?;
//! let left = measure::totals(&mut simulation.whole(), &plate.parts, plate.parts.unknowns[0]).most;
//! let exact = (-0.1 * PI * PI * simulation.clock().time()).exp();
//! assert!((left - exact).abs() < 1e-5);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Implicit steps
//! With the cargo feature `implicit`, which compiles faer, [`Heat`] takes time steps of any length by backward Euler,
//! Crank-Nicolson or BDF2 ([`Implicit`]), in every mesh and with every condition that it has:
//! `integrator: Implicit::Bdf2.into()`. The matrix is what the explicit stage comes to, its factor is computed when the
//! time step changes, and a step costs a sparse solve by one thread. Without the feature [`Heat::model`] says what is
//! missing.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod boundary;
pub mod equation;
pub mod error;
pub mod measure;
pub mod mesh;
pub mod model;
pub mod operator;
mod packs;

mod around;
#[cfg(feature = "implicit")]
mod implicit;
mod line;
mod navier_stokes;
mod plane;
mod poisson;
mod row;
mod stability;
mod sweep;
mod time_stepping;

pub use around::{At, laplacian};
pub use boundary::{Boundary, Condition, Data};
pub use equation::{Advection, Burgers, Drift, Equation, Gas, GasEnd, GasState, Heat, Wave};
pub use error::FdError;
pub use mesh::{Mesh, Side, Spread};
pub use model::{Compiled, Fd, Parts};
pub use navier_stokes::{Body, FlowEnd, NavierStokes};
pub use operator::Order;
pub use operator::face::Face;
pub use operator::staggered::StaggeredOrder;
pub use time_stepping::{Implicit, TimeStepping};
