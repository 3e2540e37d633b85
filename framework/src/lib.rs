pub mod format;
pub mod port;
