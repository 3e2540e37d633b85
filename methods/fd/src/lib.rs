//! Finite differences on the finegrain framework.
#![forbid(unsafe_code)]
#![warn(missing_docs)]
