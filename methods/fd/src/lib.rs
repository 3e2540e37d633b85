//! Finite differences on the finegrain framework.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod boundary;
pub mod equation;
pub mod error;
pub mod measure;
pub mod mesh;
pub mod model;
pub mod operator;

mod around;
mod line;
mod row;
mod stability;
mod sweep;

pub use around::{At, laplacian};
pub use boundary::{Boundary, Condition, Data};
pub use equation::{Advection, Burgers, Equation, Gas, GasEnd, GasState, Heat, Wave};
pub use error::FdError;
pub use mesh::{Mesh, Side, Spread};
pub use model::{Compiled, Fd, Parts};
pub use operator::Order;
pub use operator::face::Face;
