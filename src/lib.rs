//! finegrain: fine-grained parallel time stepping.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
pub mod figure;

pub use finegrain_framework as framework;
pub use finegrain_sph as sph;
