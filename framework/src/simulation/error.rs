//! Why a run ended before its time: where, when and what.

use std::fmt;

use crate::failure::Cause;

/// Why a run ended before its time.
#[derive(Clone, PartialEq, thiserror::Error)]
#[error("{method}: step {step} (t = {time:.6e}), stage {stage:?}{}: {cause}", at(*.sub_domain))]
pub struct RunError {
    /// The method.
    pub method: String,
    /// Number of the step that failed, counted from 0.
    pub step: u64,
    /// Time at its beginning.
    pub time: f64,
    /// Name of the stage.
    pub stage: String,
    /// Number of the sub-domain; `None` for whole-domain work.
    pub sub_domain: Option<usize>,
    /// Why.
    pub cause: Cause,
}

/// As it is displayed: a `main` that returns it shows this.
impl fmt::Debug for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

fn at(sub_domain: Option<usize>) -> String {
    sub_domain.map_or_else(String::new, |id| format!(", sub-domain {id}"))
}
