//! Bodies in the flow, of second order: ghost faces whose velocities the pressure leaves where they must be.
//!
//! The operators know of no body. Faces of cells inside bodies that the equations in the fluid read are *ghosts*: along
//! the normal of the surface the velocity there has to lie on the parabola through that of the body, on the surface,
//! and two in the fluid (cf. Tseng & Ferziger 2003, J. Comput. Phys. 192, whose line through one mirror image leaves
//! larger errors). To impose it before the projection would lose it there; so the forces at the ghosts are unknowns like the pressure, as in Taira & Colonius (2007, J. Comput. Phys. 225), and
//! as the projection is linear, they follow from the velocities without them by a dense system that is factored
//! once. No slip and no divergence then both hold to round-off.

mod faces;
mod forces;
mod stages;

pub use finegrain_framework::shape::Body;

pub(crate) use faces::Faces;
pub(crate) use forces::Forces;
pub(crate) use stages::{Immersed, NoSlip, Still, When};
