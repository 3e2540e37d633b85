//! Scaling: time per step, speed-up and efficiency of a scene over the number of workers, measured as far
//! as there are cores and forecast further.

mod forecast;
mod measure;
mod pages;

pub use forecast::Overheads;
pub use measure::{Forecast, Measurement, Plan, Scaling};
