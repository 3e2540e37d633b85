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
    /// The kernel reaches too far around a periodic box.
    #[error(
        "the kernel reaches {range:.3e} m, more than twice the period of {period:.3e} m in direction \
         {direction}: make the box longer, or smoothing_ratio or the spacing smaller"
    )]
    Period {
        /// Direction of the period.
        direction: usize,
        /// The period, m.
        period: f64,
        /// Radius of the kernel's support, m.
        range: f64,
    },
    /// Two particles are at one place, or nearly.
    #[error(
        "particles {first} and {second} are {distance:.3e} m apart, at {position:?}; it must be at \
         least {least:.3e} m"
    )]
    Overlap {
        /// One of them, counted as the positions are.
        first: usize,
        /// The other.
        second: usize,
        /// Position of the first, m.
        position: [f64; 3],
        /// Their distance, m.
        distance: f64,
        /// The least distance, m.
        least: f64,
    },
    /// A body without particles, which the fluid would not feel.
    #[error("body {number}: no particle fills it")]
    EmptyBody {
        /// Which.
        number: usize,
    },
    /// A body that is not filled as deep as the fluid sees it.
    #[error(
        "body {number}: {} at {at:?}, as deep as particle {particle} of the fluid sees with a kernel \
         that reaches {range:.3e} m; fill it with particles, or make smoothing_ratio or the spacing \
         smaller",
        if *.is_thin { "it is too thin" } else { "there is a gap" }
    )]
    Gap {
        /// Which body.
        number: usize,
        /// The particle that sees the gap, counted as the positions are.
        particle: usize,
        /// Where there is none of the body's particles around, m.
        at: [f64; 3],
        /// Radius of the kernel's support, m.
        range: f64,
        /// Whether that is outside of all bodies.
        is_thin: bool,
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
