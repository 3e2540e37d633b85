//! Conditions on the boundary.
//!
//! Where points lie on the ends of an axis ([`Spread::Ends`]) conditions are imposed
//! weakly, by penalties that fit the summation by parts: the point on the boundary evolves, too, and
//! comes as close to its condition as the scheme is accurate. Where points lie in the middle of cells
//! ([`Spread::Cells`]) they are imposed by ghost points beyond the end.
//!
//! Derivatives are along the axes, so that every axis has conditions of its own, and a point in a corner
//! feels those of all the ends it is next to. None is given to the corner itself: where they contradict
//! each other there (a lid that slides along a wall at rest), the solution has a step that the mesh
//! resolves as it can.

use std::fmt;
use std::sync::Arc;

use crate::error::FdError;
use crate::mesh::{AXES, Mesh, Spread};

/// A value on the boundary: a function of the position, m, and the time, s.
#[derive(Clone)]
pub enum Data {
    /// The same everywhere and always.
    Constant(f64),
    /// Varies.
    Varying(Arc<dyn Fn([f64; 3], f64) -> f64 + Send + Sync>),
}

impl Data {
    /// From a function of position and time. It must give the same for the same arguments whoever
    /// asks.
    pub fn varying(data: impl Fn([f64; 3], f64) -> f64 + Send + Sync + 'static) -> Self {
        Self::Varying(Arc::new(data))
    }

    #[inline]
    pub(crate) fn at(&self, position: [f64; 3], time: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Varying(data) => data(position, time),
        }
    }
}

impl fmt::Debug for Data {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(value) => write!(f, "{value:?}"),
            Self::Varying(_) => f.write_str("varying"),
        }
    }
}

impl From<f64> for Data {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

/// What holds on one end of an axis, n pointing outwards.
#[derive(Clone, Debug)]
pub enum Condition {
    /// `u = g`: a wall of given temperature, an inflow.
    Dirichlet(Data),
    /// `du/dn = g`: a wall of given flux; of symmetry, with 0.
    Neumann(Data),
    /// `value u + slope du/dn = g`: a wall that exchanges heat with what is beyond.
    Robin {
        /// Factor of the value; not negative.
        value: f64,
        /// Factor of the derivative, m; above zero.
        slope: f64,
        /// What their sum is.
        data: Data,
    },
    /// Nothing: what leaves leaves.
    Outflow,
}

impl Condition {
    /// `u = g`.
    pub fn dirichlet(data: impl Into<Data>) -> Self {
        Self::Dirichlet(data.into())
    }

    /// `du/dn = g`.
    pub fn neumann(data: impl Into<Data>) -> Self {
        Self::Neumann(data.into())
    }

    /// `value u + slope du/dn = g`.
    pub fn robin(value: f64, slope: f64, data: impl Into<Data>) -> Self {
        Self::Robin { value, slope, data: data.into() }
    }

    /// Factors of value and derivative; `None` if nothing is imposed.
    pub(crate) fn factors(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Dirichlet(_) => Some([1.0, 0.0]),
            Self::Neumann(_) => Some([0.0, 1.0]),
            Self::Robin { value, slope, .. } => Some([value, slope]),
            Self::Outflow => None,
        }
    }

    /// What value and derivative come to.
    pub(crate) fn data(&self) -> &Data {
        match self {
            Self::Dirichlet(data) | Self::Neumann(data) | Self::Robin { data, .. } => data,
            Self::Outflow => &Data::Constant(0.0),
        }
    }
}

/// Conditions at the lower and upper end of x, y and z; not asked for where an axis is periodic.
#[derive(Clone, Debug)]
pub struct Boundary(pub [[Condition; 2]; 3]);

impl Boundary {
    /// The same condition on all ends.
    pub fn all(condition: Condition) -> Self {
        Self([0, 1, 2].map(|_| [condition.clone(), condition.clone()]))
    }

    /// The conditions along one axis as those of x, with zero imposed.
    #[cfg(feature = "implicit")]
    pub(crate) fn homogeneous_along(&self, axis: usize) -> Self {
        let mut boundary = Self::all(Condition::Outflow);
        boundary.0[0] = self.0[axis].clone().map(|condition| match condition {
            Condition::Dirichlet(_) => Condition::dirichlet(0.0),
            Condition::Neumann(_) => Condition::neumann(0.0),
            Condition::Robin { value, slope, .. } => Condition::robin(value, slope, 0.0),
            Condition::Outflow => Condition::Outflow,
        });
        boundary
    }

    pub(crate) fn check(&self, mesh: &Mesh) -> Result<(), FdError> {
        let bounded = mesh.sides().iter().zip(&self.0).zip(AXES);
        for ((_, ends), axis) in bounded.filter(|((s, _), _)| s.spread != Spread::Periodic) {
            for (condition, end) in ends.iter().zip(["lower", "upper"]) {
                let refused = |cause: String| Err(FdError::Condition { axis, end, cause });
                if let Condition::Robin { value, slope, .. } = *condition
                    && !(value >= 0.0 && value.is_finite() && slope > 0.0 && slope.is_finite())
                {
                    return refused(format!(
                        "value is {value} and slope is {slope}; they must be finite, the first not \
                         negative and the second above zero"
                    ));
                }
                if let Data::Constant(data) = *condition.data()
                    && !data.is_finite()
                {
                    return refused(format!("the value given is {data}; it must be finite"));
                }
            }
        }
        Ok(())
    }

    /// Refuses conditions that do not go with a flow of this velocity: a value belongs where it comes in, and
    /// nothing where it goes out.
    pub(crate) fn check_flow(&self, mesh: &Mesh, velocity: [f64; 3]) -> Result<(), FdError> {
        let bounded = mesh.sides().iter().zip(&self.0).zip(AXES).zip(velocity);
        for (((side, ends), axis), v) in bounded {
            if side.spread != Spread::Ends {
                continue;
            }
            for ((condition, end), inwards) in ends.iter().zip(["lower", "upper"]).zip([v, -v]) {
                let is_right = match condition {
                    Condition::Dirichlet(_) => inwards > 0.0,
                    Condition::Outflow => inwards <= 0.0,
                    _ => false,
                };
                if !is_right {
                    let cause =
                        "where it flows in a value must be given, elsewhere nothing".to_owned();
                    return Err(FdError::Condition { axis, end, cause });
                }
            }
        }
        Ok(())
    }
}
