//! What a scene models, and how.

use finegrain_framework::VectorField;
use serde::{Deserialize, Serialize};

use crate::body::{Body, Wall};
use crate::collision::Collision;
use crate::error::{LbmError, finite, not_negative, positive};
use crate::lattice::LatticeKind;
use crate::mesh::Mesh;
use crate::opening::{Condition, Opening};

/// Shortest relaxation time, in time steps: closer to 1/2 there is hardly any viscosity left to tell
/// from the rounding of time step and spacing.
const SHORTEST: f64 = 0.500_001;
/// Longest relaxation time: beyond, a disturbance crosses many cells before it relaxes.
const LONGEST: f64 = 100.0;
/// Largest Mach number: the equilibrium is a series in it.
const FASTEST: f64 = 0.3;

/// A fluid that is nearly incompressible because it is slow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluid {
    /// Reference density, kg/m^3.
    pub density: f64,
    /// Kinematic viscosity, m^2/s.
    pub kinematic_viscosity: f64,
    /// Largest speed that is expected, m/s: what the Mach number is of.
    pub largest_speed: f64,
}

impl Fluid {
    pub(crate) fn check(&self, mesh: &Mesh) -> Result<(), LbmError> {
        positive("density", self.density)?;
        positive("kinematic_viscosity", self.kinematic_viscosity)?;
        not_negative("largest_speed", self.largest_speed)?;
        let value = mesh.relaxation_time(self.kinematic_viscosity);
        if !(SHORTEST..=LONGEST).contains(&value) {
            return Err(LbmError::RelaxationTime { value, least: SHORTEST, most: LONGEST });
        }
        let value = mesh.mach(self.largest_speed);
        if value > FASTEST * (1.0 + 1e-12) {
            return Err(LbmError::Mach { value, speed: self.largest_speed, most: FASTEST });
        }
        Ok(())
    }
}

/// What is modelled besides the fluid.
#[derive(Clone, Debug, Default)]
pub struct Physics {
    /// Constant acceleration of the fluid, m/s^2; zero if none.
    pub body_acceleration: [f64; 3],
    /// Acceleration of the fluid that varies, besides.
    pub acceleration_field: Option<VectorField>,
    /// Bodies that do not move. Where several overlap, the fluid meets the one that comes first on
    /// its way, or in this list.
    pub bodies: Vec<Body>,
    /// Ends of the mesh that are open; each plane goes through the last sites at its end.
    pub openings: Vec<Opening>,
}

impl Physics {
    pub(crate) fn check(&self, mesh: &Mesh) -> Result<(), LbmError> {
        for acceleration in self.body_acceleration {
            finite("body_acceleration", acceleration)?;
        }
        // Sites hold the number of their body in a byte, and 0 for none.
        if self.bodies.len() > 255 {
            return Err(LbmError::Bodies(self.bodies.len()));
        }
        for (number, body) in self.bodies.iter().enumerate() {
            body.check().map_err(|cause| LbmError::Body { number, cause })?;
        }
        if self.openings.len() > 6 {
            return Err(LbmError::Openings(self.openings.len()));
        }
        for opening in &self.openings {
            opening.check(mesh)?;
        }
        Ok(())
    }
}

/// Where populations are while they stream from site to site.
/// The same bits come out of both.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Streaming {
    /// In two sets of columns, from one to the other: covers everything.
    TwoGrids,
    /// In one set (esoteric pull, Lehmann 2022): half of the memory, and faster. Covers neither
    /// interpolated walls nor non-reflecting openings, which ask for populations of other sites.
    InPlace,
}

/// How it is modelled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scheme {
    /// The velocities.
    pub lattice: LatticeKind,
    /// How populations relax.
    pub collision: Collision,
    /// How they are turned back at bodies.
    pub wall: Wall,
    /// Where populations are kept; in place wherever that covers what is modelled if `None`.
    pub streaming: Option<Streaming>,
    /// Smagorinsky's constant `C` (1963) of eddies that the mesh does not hold; none if `None`. With them the viscosity is
    /// `sqrt(nu^2 + ((C dx)^2 |S|)^2)` (cf. Meyers & Sagaut 2006), so that they hardly count where `dx^2 |S| / nu` is far
    /// below `1 / C^2`. 0.12 keeps flow in order that is too coarse for its Reynolds number (`docs/scenes.md`).
    pub smagorinsky: Option<f64>,
}

impl Scheme {
    /// The default collision and walls on a lattice, without eddies.
    pub fn on(lattice: LatticeKind) -> Self {
        let (collision, wall) = (Collision::default(), Wall::default());
        Self { lattice, collision, wall, streaming: None, smagorinsky: None }
    }

    pub(crate) fn check(&self) -> Result<(), LbmError> {
        self.collision.check()?;
        self.smagorinsky.map_or(Ok(()), |constant| positive("smagorinsky", constant))
    }

    /// Where populations are kept.
    ///
    /// # Errors
    /// If they are to be in place where that does not cover what is modelled.
    pub(crate) fn streaming(&self, physics: &Physics) -> Result<Streaming, LbmError> {
        let lets_out = |o: &Opening| matches!(o.condition, Condition::NonReflecting { .. });
        let beyond = if self.wall != Wall::HalfWay && !physics.bodies.is_empty() {
            Some("interpolated walls")
        } else if physics.openings.iter().any(lets_out) {
            Some("non-reflecting openings")
        } else {
            None
        };
        match (self.streaming, beyond) {
            (Some(Streaming::TwoGrids), _) | (None, Some(_)) => Ok(Streaming::TwoGrids),
            (_, None) => Ok(Streaming::InPlace),
            (Some(Streaming::InPlace), Some(what)) => Err(LbmError::InPlace { what }),
        }
    }
}
