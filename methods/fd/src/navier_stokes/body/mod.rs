//! Bodies in the flow, of second order: ghost faces whose velocities the pressure leaves where they must be.
//!
//! The operators know of no body. Faces of cells inside bodies that the equations in the fluid read are *ghosts*: the
//! velocity there has to be such that half-way to its mirror image in the fluid, on the surface, it is that of the
//! body (Tseng & Ferziger 2003, J. Comput. Phys. 192). To impose it before the projection would lose it there; so
//! the forces at the ghosts are unknowns like the pressure, as in Taira & Colonius (2007, J. Comput. Phys. 225), and
//! as the projection is linear, they follow from the velocities without them by a dense system that is factored
//! once. No slip and no divergence then both hold to round-off.

mod faces;
mod forces;
mod stages;

use finegrain_framework::shape::Shape;

use crate::error::FdError;

pub(crate) use faces::Faces;
pub(crate) use forces::Forces;
pub(crate) use stages::{Immersed, NoSlip, Still, When};

/// A body that the fluid does not enter and sticks to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// The space that it fills.
    pub shape: Shape,
    /// Velocity with which its surface slides along itself, m/s.
    pub surface_velocity: [f64; 3],
}

impl From<Shape> for Body {
    /// A body at rest.
    fn from(shape: Shape) -> Self {
        Self { shape, surface_velocity: [0.0; 3] }
    }
}

impl Body {
    pub(super) fn check(&self, number: usize) -> Result<(), FdError> {
        let refused = |cause: String| FdError::Body { number, cause };
        self.shape.check().map_err(|cause| refused(cause.to_string()))?;
        if !self.surface_velocity.iter().all(|v| v.is_finite()) {
            let velocity = self.surface_velocity;
            return Err(refused(format!("surface_velocity is {velocity:?}; it must be finite")));
        }
        Ok(())
    }
}
