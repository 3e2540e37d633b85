//! Particles at the beginning.

use finegrain_framework::space::cells::Region;
use finegrain_framework::{Columns, Real};

use crate::error::{SphError, positive};
use crate::fields::Fields;
use crate::physics::Fluid;
use crate::wall::Walls;

/// Particles at the beginning.
#[derive(Clone, Debug)]
pub struct Start {
    /// Where they live.
    pub region: Region,
    /// Distance of neighbouring particles, m.
    pub spacing: f64,
    /// Volume of one particle, m^3 (m^2 in 2-D, m in 1-D).
    pub particle_volume: f64,
    /// Positions, m.
    pub positions: Vec<[f64; 3]>,
    /// Velocities, m/s; at rest if empty.
    pub velocities: Vec<[f64; 3]>,
}

impl Start {
    pub(crate) fn check(&self) -> Result<(), SphError> {
        positive("spacing", self.spacing)?;
        positive("particle_volume", self.particle_volume)?;
        let (positions, velocities) = (self.positions.len(), self.velocities.len());
        if positions == 0 || (velocities != 0 && velocities != positions) {
            return Err(SphError::Particles { positions, velocities });
        }
        Ok(())
    }

    /// Sets the initial state.
    pub(crate) fn fill<T: Real, P: Real>(
        &self,
        columns: &mut Columns,
        fields: &Fields<T, P>,
        fluid: &Fluid,
        walls: &Walls,
    ) {
        for (a, (&position, &velocity)) in fields.position.iter().zip(&fields.velocity).enumerate()
        {
            for (x, at) in columns.values_mut(position).iter_mut().zip(&self.positions) {
                *x = P::of(at[a]);
            }
            for (v, given) in columns.values_mut(velocity).iter_mut().zip(&self.velocities) {
                *v = T::of(given[a]);
            }
        }
        columns.values_mut(fields.density).fill(T::of(fluid.density));
        for (i, identity) in columns.values_mut(fields.identity).iter_mut().enumerate() {
            *identity = i as u32;
        }
        if let Some(wall_depth) = fields.wall_depth {
            for (depth, &at) in columns.values_mut(wall_depth).iter_mut().zip(&self.positions) {
                *depth = T::of((-walls.signed_distance(at)).max(0.0));
            }
            for &velocity in &fields.velocity {
                for i in 0..self.positions.len() {
                    if columns.values(wall_depth)[i] > T::zero() {
                        columns.values_mut(velocity)[i] = T::zero();
                    }
                }
            }
            for (i, &at) in self.positions.iter().enumerate() {
                if columns.values(wall_depth)[i] > T::zero() {
                    let velocity = walls.surface_velocity(at);
                    for (&column, v) in fields.surface_velocity.iter().zip(velocity) {
                        columns.values_mut(column)[i] = T::of(v);
                    }
                }
            }
        }
    }
}
