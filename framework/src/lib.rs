pub mod real;
pub mod shape;
