//! finegrain: fine-grained parallel time stepping on multi-core machines.
//!
//! This package is the command line, the scene catalogue and the reports. The framework
//! ([`framework`]) and the numerical methods ([`sph`]) are crates of their own, re-exported here.
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod bench;
pub mod figure;
pub mod scene;

pub use finegrain_framework as framework;
pub use finegrain_sph as sph;
