//! Bodies, and how the fluid is turned back at them.

use finegrain_framework::shape::Shape;
use serde::{Deserialize, Serialize};

use crate::error::{LbmError, finite};

/// A body that the fluid does not enter and sticks to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// The space that it fills.
    pub shape: Shape,
    /// Velocity with which its surface slides along itself, m/s, as a lid or a belt does.
    pub surface_velocity: [f64; 3],
}

impl From<Shape> for Body {
    /// A body at rest.
    fn from(shape: Shape) -> Self {
        Self { shape, surface_velocity: [0.0; 3] }
    }
}

impl Body {
    pub(crate) fn check(&self, number: usize) -> Result<(), LbmError> {
        self.shape.check().map_err(|cause| LbmError::Body { number, cause })?;
        for component in self.surface_velocity {
            finite("surface_velocity", component)?;
        }
        Ok(())
    }
}

/// Where on its way from a site into a body a population is turned back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Wall {
    /// Half-way (Ladd 1994): exact for walls along the lattice that lie half-way between sites, and
    /// mass is kept to round-off; others become stairs.
    HalfWay,
    /// At the surface, by linear interpolation (Bouzidi, Firdaouss & Lallemand 2001): second order
    /// on curved bodies, but mass is not kept exactly there. Where the next site is in a body, too,
    /// half-way.
    #[default]
    Interpolated,
}
