//! Openings: ends of the mesh through which fluid comes and goes.
//!
//! The sites at that end lie on the plane of the opening. Populations that would come from beyond it
//! are not known; from those that are, and from what the opening prescribes, follow density, velocity
//! and stress, and all populations of the site are computed anew from these (Latt & Chopard 2008), with
//! coefficients of higher order that are consistent with them (Malaspinas 2015). Where a wall meets
//! the plane, its last site turns back what the wall turns back, and lacks only what comes from beyond
//! the plane, corner included: no other rule is needed.

use finegrain_framework::pack::Pack;
use finegrain_framework::shape::Axis;
use finegrain_framework::{Real, VectorField};
use pulp::Scalar;

use crate::error::{LbmError, finite, not_negative};
use crate::flow;
use crate::frame;
use crate::lattice::{Lattice, SOUND_SPEED_SQUARED, opposite};
use crate::mesh::Mesh;

/// One end of the mesh, open.
#[derive(Clone, Debug)]
pub struct Opening {
    /// The direction across it.
    pub axis: Axis,
    /// Whether it is the upper end.
    pub is_upper: bool,
    /// What is prescribed there.
    pub condition: Condition,
}

/// What is prescribed at an opening.
#[derive(Clone, Debug)]
pub enum Condition {
    /// The velocity, m/s; the density follows from it (Zou & He 1997, eq. 19).
    Velocity(VectorField),
    /// The pressure beyond that of the reference density, Pa; fluid goes straight through the plane
    /// (Zou & He 1997).
    Pressure(f64),
    /// Waves go out: of the characteristic waves at the plane those that leave are taken from inside
    /// and the one that enters has no amplitude, but for a slow return to a pressure, without which
    /// it would drift (Poinsot & Lele 1992, eqs. 25 to 27 and 40; with lattice Boltzmann Heubes, Bartel
    /// & Ehrhardt 2014, Wissocq et al. 2017).
    NonReflecting {
        /// Pressure beyond that of the reference density, Pa.
        pressure: f64,
        /// Rate of the return to it, 1/s; zero if there is none. Waves much slower are reflected.
        relaxation: f64,
    },
}

impl Opening {
    pub(crate) fn check(&self, mesh: &Mesh) -> Result<(), LbmError> {
        if mesh.periodic[self.axis()] || mesh.shape[self.axis()] < 3 {
            return Err(LbmError::Opening { axis: ["x", "y", "z"][self.axis()] });
        }
        match self.condition {
            Condition::Velocity(_) => Ok(()),
            Condition::Pressure(pressure) => finite("pressure", pressure),
            Condition::NonReflecting { pressure, relaxation } => {
                finite("pressure", pressure)?;
                not_negative("relaxation", relaxation)
            }
        }
    }

    /// Index of the direction across.
    pub(crate) fn axis(&self) -> usize {
        match self.axis {
            Axis::X => 0,
            Axis::Y => 1,
            Axis::Z => 2,
        }
    }

    /// Step from the plane into the mesh.
    pub(crate) fn inward(&self) -> i32 {
        if self.is_upper { -1 } else { 1 }
    }

    /// Whether a site lies on the plane.
    pub(crate) fn has(&self, mesh: &Mesh, site: [usize; 3]) -> bool {
        let last = mesh.shape[self.axis()] - 1;
        site[self.axis()] == if self.is_upper { last } else { 0 }
    }

    /// Whether a place beyond the mesh is beyond this end.
    pub(crate) fn is_before(&self, mesh: &Mesh, site: [isize; 3]) -> bool {
        let place = site[self.axis()];
        if self.is_upper { place >= mesh.shape[self.axis()] as isize } else { place < 0 }
    }
}

/// Openings as the step needs them.
#[derive(Clone, Debug)]
pub(crate) struct Openings {
    pub all: Vec<Opening>,
    pub mesh: Mesh,
    /// One lattice unit of pressure, Pa.
    pub unit_pressure: f64,
}

/// Density less one and velocity, in lattice units.
type State = (f64, [f64; 3]);

/// A site on an opening's plane before its collision.
pub(crate) struct Edge {
    pub site: [usize; 3],
    /// Of the populations, s.
    pub time: f64,
    /// By the body force, in lattice units.
    pub acceleration: [f64; 3],
}

impl Openings {
    /// Replaces the populations of a site on the plane of opening `number`, before the collision;
    /// `earlier` are the populations after the collision of the step before, of this site and of the
    /// next one inside.
    pub fn complete<L: Lattice<Q>, T: Real, const Q: usize>(
        &self,
        number: usize,
        f: &mut [T; Q],
        edge: &Edge,
        earlier: &dyn Fn(i32) -> [T; Q],
    ) {
        let opening = &self.all[number];
        let (excess, velocity) = self.state::<L, T, Q>(opening, f, edge, earlier);
        let pack = |x: f64| T::Pack::<Scalar>::splat(Scalar, T::of(x));
        let (excess, velocity) = (pack(excess), velocity.map(pack));
        let no_stress = [[pack(0.0); 3]; 3];
        let equilibrium = frame::regularised::<L, _, Q>(excess, &velocity, no_stress);
        // The part beyond equilibrium that comes from outside is that which goes there.
        let mut beyond = [pack(0.0); Q];
        for q in 0..Q {
            let from = if Self::enters::<L, Q>(opening, q) { opposite(q) } else { q };
            beyond[q] =
                T::Pack::<Scalar>::load(Scalar, std::slice::from_ref(&f[from])) - equilibrium[from];
        }
        let nowhere = [pack(0.0); 3];
        let (sum, _) = flow::moments::<L, _, Q>(&beyond);
        let stress = flow::stress::<L, _, Q>(&beyond, sum, &nowhere);
        let completed = frame::regularised::<L, _, Q>(excess, &velocity, stress);
        for q in 0..Q {
            completed[q].store(std::slice::from_mut(&mut f[q]));
        }
    }

    /// Whether a population comes from beyond the plane.
    fn enters<L: Lattice<Q>, const Q: usize>(opening: &Opening, q: usize) -> bool {
        L::VELOCITIES[q][opening.axis()] == opening.inward()
    }

    /// Density and velocity at the plane; of the velocity the part before the collision, which has
    /// none of the force.
    fn state<L: Lattice<Q>, T: Real, const Q: usize>(
        &self,
        opening: &Opening,
        f: &[T; Q],
        edge: &Edge,
        earlier: &dyn Fn(i32) -> [T; Q],
    ) -> State {
        let (axis, inward) = (opening.axis(), f64::from(opening.inward()));
        // Populations that go along the plane, and twice those that go out through it.
        let mut sum = 0.0;
        for q in 0..Q {
            let times = 1.0 - inward * f64::from(L::VELOCITIES[q][axis]);
            sum += times * f[q].as_f64();
        }
        let before =
            |velocity: [f64; 3]| [0, 1, 2].map(|a| velocity[a] - 0.5 * edge.acceleration[a]);
        match &opening.condition {
            Condition::Velocity(field) => {
                let position = self.mesh.position(edge.site.map(|i| i as isize));
                let unit = self.mesh.unit_velocity();
                let velocity = before(field.at(position, edge.time).map(|u| u / unit));
                let into = inward * velocity[axis];
                ((sum + into) / (1.0 - into), velocity)
            }
            Condition::Pressure(pressure) => {
                let excess = pressure / (SOUND_SPEED_SQUARED * self.unit_pressure);
                let mut velocity = before([0.0; 3]);
                velocity[axis] = inward * (excess - sum) / (1.0 + excess);
                (excess, velocity)
            }
            Condition::NonReflecting { pressure, relaxation } => {
                let target = pressure / (SOUND_SPEED_SQUARED * self.unit_pressure);
                let rate = relaxation * self.mesh.time_step;
                let state = |n: i32| after_collision::<L, T, Q>(&earlier(n), &edge.acceleration);
                let (excess, velocity) = leave(opening, state(0), state(1), target, rate);
                (excess, before(velocity))
            }
        }
    }
}

/// Density less one and velocity from populations after a collision.
fn after_collision<L: Lattice<Q>, T: Real, const Q: usize>(
    f: &[T; Q],
    acceleration: &[f64; 3],
) -> State {
    let (mut excess, mut velocity) = (0.0, [0.0; 3]);
    for q in 0..Q {
        excess += f[q].as_f64();
        for a in 0..L::DIMS {
            velocity[a] += f64::from(L::VELOCITIES[q][a]) * f[q].as_f64();
        }
    }
    (excess, [0, 1, 2].map(|a| velocity[a] / (1.0 + excess) - 0.5 * acceleration[a]))
}

/// One time step of the characteristic equations at the plane, from the state there and one site
/// further inside (Poinsot & Lele 1992, eqs. 25 to 27, isothermal): of the waves that the outward
/// derivatives are made of, the one that comes in is replaced.
fn leave(opening: &Opening, here: State, inside: State, target: f64, rate: f64) -> State {
    let ((excess, velocity), axis) = (here, opening.axis());
    let (density, outward) = (1.0 + excess, -f64::from(opening.inward()));
    let sound = SOUND_SPEED_SQUARED.sqrt();
    let along = [0, 1, 2].map(|a| velocity[a] - inside.1[a]);
    let normal = outward * velocity[axis];
    let pressure_change = SOUND_SPEED_SQUARED * (excess - inside.0);
    let velocity_change = density * sound * outward * along[axis];
    let leaving = (normal + sound) * (pressure_change + velocity_change);
    // What comes in would lower the pressure by half of its amplitude.
    let entering = 2.0 * rate * SOUND_SPEED_SQUARED * (excess - target);
    let mut later = velocity;
    for a in (0..3).filter(|&a| a != axis) {
        later[a] -= normal.max(0.0) * along[a];
    }
    later[axis] -= outward * (leaving - entering) / (2.0 * density * sound);
    (excess - (leaving + entering) / (2.0 * SOUND_SPEED_SQUARED), later)
}

#[cfg(test)]
mod tests {
    use finegrain_framework::pack::PackF64;

    use super::*;
    use crate::collision::{Collide, Trt};
    use crate::lattice::D3Q19;

    /// A wave of sound that leaves with the flow goes out at the speed of both together, unchanged.
    #[test]
    fn sound_leaves_with_the_flow() {
        let sound = SOUND_SPEED_SQUARED.sqrt();
        for is_upper in [false, true] {
            let condition = Condition::Pressure(0.0);
            let opening = Opening { axis: Axis::Y, is_upper, condition };
            let outward = -f64::from(opening.inward());
            for flow in [-0.05, 0.0, 0.1] {
                let (density, rise) = (1.02, 1e-3);
                let change = sound * rise / density;
                let here = (density - 1.0, [0.03, outward * flow, 0.0]);
                let inside = (density - 1.0 - rise, [0.03, outward * (flow - change), 0.0]);
                let (excess, velocity) = leave(&opening, here, inside, 0.0, 0.0);
                let speed = flow + sound;
                assert!((excess - (here.0 - speed * rise)).abs() < 1e-16);
                assert!((outward * velocity[1] - (flow - speed * change)).abs() < 1e-16);
                assert_eq!([velocity[0], velocity[2]], [0.03, 0.0]);
            }
        }
    }

    /// The velocity in the middle of the collision is the same seen from before it and from after.
    #[test]
    fn the_velocity_after_a_collision_has_half_of_the_force() {
        let acceleration = [0.003, -0.002, 0.001];
        let before: [f64; 19] = std::array::from_fn(|q| 0.01 * (1.7 * q as f64).sin());
        let pack = |x: f64| PackF64::splat(Scalar, x);
        let after = Trt { magic: None }
            .collide::<D3Q19, _, 19>(before.map(pack), acceleration.map(pack), pack(1.3))
            .map(Pack::vector);
        let without = after_collision::<D3Q19, _, 19>(&before, &[0.0; 3]);
        let (excess, velocity) = after_collision::<D3Q19, _, 19>(&after, &acceleration);
        assert!((excess - without.0).abs() < 1e-15);
        for a in 0..3 {
            assert!((velocity[a] - (without.1[a] + 0.5 * acceleration[a])).abs() < 1e-15);
        }
    }
}
