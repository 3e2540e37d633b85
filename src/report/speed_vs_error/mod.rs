//! Speed against error: the same scenes by all methods, and which is the cheapest for an error.

mod comparison;
mod pages;
mod reading;
mod survey;
mod table;

pub use comparison::{COMPARISONS, Comparison, Line};
pub use survey::{Case, Measurement, Plan, Survey};
