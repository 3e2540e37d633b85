pub mod dimension;
pub mod kernel;
pub mod packing;
