//! Why a model cannot be built.

use finegrain_framework::NoMemory;

use crate::operator::Order;

/// Why a model could not be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FdError {
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
    /// The time step is longer than the scheme is stable with.
    #[error(
        "the time step is {time_step:e} s; with {scheme} on this mesh it must be at most {limit:e} s: \
         choose a smaller `courant`"
    )]
    TimeStep {
        /// What it was, s.
        time_step: f64,
        /// Largest allowed, s.
        limit: f64,
        /// The scheme, in words.
        scheme: String,
    },
    /// The scheme is not stable with any time step.
    #[error("{scheme} is not stable with any time step: choose another integrator")]
    NeverStable {
        /// The scheme, in words.
        scheme: String,
    },
    /// Implicit steps were not compiled.
    #[error(
        "integrator = {scheme}: implicit steps need the cargo feature `implicit`, which this was built without; \
         build it with `--features implicit`, or choose euler, rk2, ssp-rk3 or rk4"
    )]
    NotCompiled {
        /// The scheme.
        scheme: &'static str,
    },
    /// There is no factor of the matrix of implicit steps.
    #[error(
        "the matrix of implicit steps for {points} points cannot be factorised: {cause}; choose fewer points"
    )]
    Factor {
        /// Number of points.
        points: usize,
        /// Why.
        cause: String,
    },
    /// There are fewer points along an axis than stencils need.
    #[error("{points} points along {axis}; there must be at least {least}")]
    TooFew {
        /// The axis.
        axis: char,
        /// Points there are.
        points: usize,
        /// Points there must be.
        least: usize,
    },
    /// An axis ends below where it begins, or is not finite.
    #[error("along {axis} the mesh goes from {lower} m to {upper} m; the second must be greater")]
    Extent {
        /// The axis.
        axis: char,
        /// Where it begins, m.
        lower: f64,
        /// Where it ends, m.
        upper: f64,
    },
    /// There is no closure of this order.
    #[error("there is no closure of order {0} at boundaries; there are 2, 4 and 6")]
    NoClosure(Order),
    /// Values on faces need points beyond the ends.
    #[error(
        "along {0} points lie on the ends; with values on faces they must lie in the middle of cells, or \
         the axis must be periodic"
    )]
    Ends(char),
    /// A boundary condition makes no sense.
    #[error("the boundary condition at the {end} end of {axis}: {cause}")]
    Condition {
        /// The axis.
        axis: char,
        /// Which end of it.
        end: &'static str,
        /// Why.
        cause: String,
    },
    /// A body makes no sense, or does not fit the mesh.
    #[error("body {number}: {cause}")]
    Body {
        /// Which, from 0.
        number: usize,
        /// Why.
        cause: String,
    },
    /// A body lies over an end of the mesh, or too near to it.
    #[error(
        "body {number} is less than two cells from an end of {axis}, or lies over it: there must be room for the flow \
         around it, or the axis must be periodic"
    )]
    BodyAtEnd {
        /// Which, from 0.
        number: usize,
        /// The axis.
        axis: char,
    },
    /// Bodies are too near to each other.
    #[error(
        "the gap between body {number} and another, or itself, at {position:?} m is narrower than the mesh resolves: \
         there must be two cells at least"
    )]
    Gap {
        /// One of the bodies, from 0.
        number: usize,
        /// Where, m.
        position: [f64; 3],
    },
    /// There are more points than the system has memory for.
    #[error("{points} points: {cause}; choose fewer")]
    Memory {
        /// How many.
        points: usize,
        /// What they take.
        #[source]
        cause: NoMemory,
    },
    /// The state at the beginning is not a number somewhere.
    #[error("the initial {field} at {position:?} m is {value}; it must be {range}")]
    Start {
        /// Which.
        field: &'static str,
        /// Where.
        position: [f64; 3],
        /// What it was.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
}

/// Refuses a number that is not finite and above zero.
pub(crate) fn positive(name: &'static str, value: f64) -> Result<(), FdError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(FdError::OutOfRange { name, value, range: "finite and above zero" })
    }
}
