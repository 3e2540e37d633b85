//! Bodies in a fluid, described once for every method.

use super::{Shape, ShapeError};

/// A body that the fluid does not enter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// The space that it fills.
    pub shape: Shape,
    /// Velocity with which its surface slides along itself, m/s, as a lid or a belt does; the body stays
    /// where it is.
    pub surface_velocity: [f64; 3],
}

impl From<Shape> for Body {
    /// A body at rest.
    fn from(shape: Shape) -> Self {
        Self { shape, surface_velocity: [0.0; 3] }
    }
}

impl Body {
    /// Checks that the numbers describe a body.
    ///
    /// # Errors
    /// [`ShapeError`] says which number is at fault.
    pub fn check(&self) -> Result<(), ShapeError> {
        self.shape.check()?;
        match self.surface_velocity.into_iter().find(|component| !component.is_finite()) {
            Some(component) => Err(ShapeError::SurfaceVelocity(component)),
            None => Ok(()),
        }
    }

    /// Whether its surface moves.
    pub fn slides(&self) -> bool {
        self.surface_velocity != [0.0; 3]
    }
}
