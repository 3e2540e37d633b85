//! Reports: many runs, and what they tell together.

mod diagram;
pub mod hard_cases;
pub mod machine;
pub mod page;
pub mod scaling;
pub mod speed_vs_error;
pub mod stability;
