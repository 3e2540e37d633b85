//! Benchmarks that the command line runs.

pub mod breakdown;
pub mod cylinder;
pub mod figures;
pub mod limits;
pub mod memory;
pub mod overheads;
pub mod row;
pub mod samples;
pub mod workers;
