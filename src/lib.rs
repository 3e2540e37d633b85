//! finegrain: fine-grained parallel time stepping on multi-core machines.
//!
//! This package is the command line, the scene catalogue and the reports. The framework
//! ([`framework`]) and the numerical methods ([`fd`], [`lbm`], [`sph`]) are crates of their own,
//! re-exported here.
//!
//! # Example
//! A scene of the catalogue, for a few steps:
//! ```
//! use finegrain::scene::{Orders, Precision, Scene};
//!
//! let scene = Scene::find("taylor-green")?;
//! let parameters = scene.set([("resolution", "16")])?;
//! let prepared = scene.prepare(Some("sph"), &parameters, Precision::F64)?;
//! let report = prepared.run(Orders { steps: Some(10), ..Orders::default() })?;
//! assert_eq!(report.points, 256);
//! println!("state hash {:016x}", report.state_hash);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]
#![warn(missing_docs)]

pub mod bench;
pub mod figure;
pub mod report;
pub mod scene;
pub mod trace;

pub use finegrain_fd as fd;
pub use finegrain_framework as framework;
pub use finegrain_lbm as lbm;
pub use finegrain_sph as sph;
