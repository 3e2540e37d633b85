//! Spaces that the framework offers: ready-made [`crate::Domain`]s.

pub mod cells;
pub mod grid;
mod independent;

pub use cells::Cells;
pub use grid::Grid;
pub use independent::Independent;
