//! Accelerations that are imposed on the fluid from outside.

use finegrain_framework::{Real, VectorField};

use crate::fringe::Fringe;
use crate::neighbourhood::Particle;
use crate::physics::Physics;
use crate::quantity::{Quantity, Values};

/// All accelerations of a particle that are not sums over others.
#[derive(Clone, Debug)]
pub(crate) struct Imposed<T, const D: usize> {
    /// The part that is the same everywhere and always, m/s^2.
    pub uniform: [T; D],
    field: Option<VectorField>,
    fringe: Option<Fringe>,
}

impl<T: Real, const D: usize> Imposed<T, D> {
    pub fn new(physics: &Physics) -> Self {
        Self {
            uniform: std::array::from_fn(|a| T::of(physics.body_acceleration[a])),
            field: physics.acceleration_field.clone(),
            fringe: physics.fringe.clone(),
        }
    }

    /// What it needs to know of a particle, besides its position.
    pub fn reads(&self) -> impl Iterator<Item = Quantity> {
        Quantity::vector(Quantity::Velocity, if self.fringe.is_some() { D } else { 0 })
    }

    /// Whether some of it varies.
    #[inline(always)]
    pub fn varies(&self) -> bool {
        self.field.is_some() || self.fringe.is_some()
    }

    /// Adds what varies, for a particle at `place`, m.
    pub fn add_varying(
        &self,
        particle: &Particle<T, D>,
        place: [f64; 3],
        time: f64,
        sums: &mut Values<T>,
    ) {
        if let Some(field) = &self.field {
            let given = field.at(place, time);
            for a in 0..D {
                sums[Quantity::Acceleration(a)] += T::of(given[a]);
            }
        }
        if let Some(fringe) = &self.fringe {
            let rate = fringe.rate_at(place[0]);
            if rate > 0.0 {
                let wanted = fringe.velocity.at(place, time);
                for a in 0..D {
                    let lack = T::of(wanted[a]) - particle[Quantity::Velocity(a)];
                    sums[Quantity::Acceleration(a)] += T::of(rate) * lack;
                }
            }
        }
    }
}
