//! Reports: many runs, and what they tell together.

pub mod hard_cases;
pub mod stability;
