pub mod checkpoint;
pub mod format;
pub mod port;
