//! What the commands do.

pub mod bench;
pub mod progress;
pub mod report;
pub mod run;
pub mod scene_file;
pub mod scenes;
pub mod signals;

/// Whatever ends a command; its message is for the user.
pub type CommandError = Box<dyn std::error::Error>;
