//! finegrain: fine-grained parallel time stepping.
pub use finegrain_framework as framework;
pub use finegrain_sph as sph;
