//! Small models that the tests run: each exercises one way in which sub-domains depend on one
//! another.
#![allow(dead_code, reason = "every test binary uses its own share of these")]

pub mod closures;
pub mod heat;
pub mod particles;
pub mod plate;
pub mod random;
pub mod sorted;
