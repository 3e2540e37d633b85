pub mod dimension;
pub mod kernel;
