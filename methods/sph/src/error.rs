//! Why a model cannot be built.

use finegrain_framework::shape::ShapeError;
use finegrain_framework::{Fault, PartitionError};

/// Why a model could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SphError {
    /// A number is outside its valid range.
    #[error("{name} is {value}; it must be {range}")]
    OutOfRange {
        /// What it is.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// There are no particles, or not as many velocities.
    #[error("{positions} particles with {velocities} velocities: there must be some, and as many")]
    Particles {
        /// Number of positions.
        positions: usize,
        /// Number of velocities.
        velocities: usize,
    },
    /// A choice that goes only with others.
    #[error("{choice} goes only with {others}")]
    Choice {
        /// What was chosen.
        choice: &'static str,
        /// What it needs.
        others: &'static str,
    },
    /// A body makes no sense.
    #[error("body {number}: {cause}")]
    Body {
        /// Which.
        number: usize,
        /// Why.
        cause: ShapeError,
    },
    /// Space could not be divided.
    #[error(transparent)]
    Space(#[from] Fault),
    /// Space could not be divided.
    #[error(transparent)]
    Partition(#[from] PartitionError),
}

/// Refuses a number that is not finite and above zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), SphError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(SphError::OutOfRange { name, value, range: "finite and above zero" })
    }
}

/// Refuses a number that is not finite or negative.
pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<(), SphError> {
    if value >= 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(SphError::OutOfRange { name, value, range: "finite and not negative" })
    }
}

/// Refuses a number that is not finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<(), SphError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(SphError::OutOfRange { name, value, range: "finite" })
    }
}
