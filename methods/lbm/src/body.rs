//! Bodies, and how the fluid is turned back at them.

use serde::{Deserialize, Serialize};

pub use finegrain_framework::shape::Body;

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
