//! Why a model cannot be built.

use finegrain_framework::NoMemory;
use finegrain_framework::shape::ShapeError;

/// Why a model could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LbmError {
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
    /// There are more sites than the system has memory for.
    #[error("{sites} sites: {cause}; choose fewer")]
    Memory {
        /// How many.
        sites: usize,
        /// What they take.
        #[source]
        cause: NoMemory,
    },
    /// The relaxation time is not one that the method can work with.
    #[error(
        "the relaxation time is {value} time steps; it must be between {least} and {most}: it is \
         1/2 + 3 nu dt / dx^2, so change the viscosity, the resolution or the time step (by \
         `relaxation_time` or `mach`)"
    )]
    RelaxationTime {
        /// What it came to.
        value: f64,
        /// Smallest allowed.
        least: f64,
        /// Largest allowed.
        most: f64,
    },
    /// The flow is too fast for a method of small Mach number.
    #[error(
        "the Mach number of the largest speed expected, {speed} m/s, is {value}; it must be at most \
         {most}: make the time step shorter (a smaller `mach` or `relaxation_time`, or more points)"
    )]
    Mach {
        /// What it came to.
        value: f64,
        /// The speed, m/s.
        speed: f64,
        /// Largest allowed.
        most: f64,
    },
    /// The mesh has no sites, or extends along z under a plane lattice.
    #[error(
        "a mesh of {shape:?} sites does not go with {lattice}: it needs sites, and one plane of them in 2-D"
    )]
    Shape {
        /// Sites in each direction.
        shape: [usize; 3],
        /// Name of the lattice.
        lattice: &'static str,
    },
    /// A body makes no sense.
    #[error("body {number}: {cause}")]
    Body {
        /// Which.
        number: usize,
        /// Why.
        cause: ShapeError,
    },
    /// The mesh ends where there is neither a wall nor another period.
    #[error(
        "the mesh ends at {position:?} m without a wall: put a body or an opening there or make the \
         direction periodic"
    )]
    Open {
        /// The first place beyond the mesh that is in no body.
        position: [f64; 3],
    },
    /// An opening where the mesh has no end, or two ends that are the same.
    #[error(
        "there can be no opening across {axis}: the direction must not be periodic and have at \
         least 3 sites"
    )]
    Opening {
        /// The direction across.
        axis: &'static str,
    },
    /// More openings than a mesh has ends.
    #[error("{0} openings; a mesh has 6 ends")]
    Openings(usize),
    /// Two openings share an edge, or are the same end.
    #[error("two openings meet at {position:?} m: separate them by a wall")]
    OpeningsMeet {
        /// A site that lies on both.
        position: [f64; 3],
    },
    /// A body is right behind an opening.
    #[error(
        "a body blocks the opening at {position:?} m: leave at least one site of the fluid there"
    )]
    OpeningBlocked {
        /// A site on the plane of the opening.
        position: [f64; 3],
    },
    /// Streaming in place does not cover it.
    #[error(
        "streaming in place does not cover {what}: ask for two grids, or for half-way walls and openings \
         with a velocity or a pressure"
    )]
    InPlace {
        /// What.
        what: &'static str,
    },
    /// Nothing is left for the fluid.
    #[error("bodies fill the whole mesh")]
    Full,
    /// More bodies than are told apart.
    #[error("{0} bodies; there may be at most 255")]
    Bodies(usize),
    /// The initial velocity or pressure is not a number somewhere.
    #[error("the initial {field} at {position:?} m is not finite")]
    Start {
        /// Which.
        field: &'static str,
        /// Where.
        position: [f64; 3],
    },
}

/// Refuses a number that is not finite and above zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), LbmError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(LbmError::OutOfRange { name, value, range: "finite and above zero" })
    }
}

/// Refuses a number that is not finite or negative.
pub(crate) fn not_negative(name: &'static str, value: f64) -> Result<(), LbmError> {
    if value >= 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(LbmError::OutOfRange { name, value, range: "finite and not negative" })
    }
}

/// Refuses a number that is not finite.
pub(crate) fn finite(name: &'static str, value: f64) -> Result<(), LbmError> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(LbmError::OutOfRange { name, value, range: "finite" })
    }
}
