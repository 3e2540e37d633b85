//! The columns of a model.

use finegrain_framework::{Columns, Rate, Real, State};

use crate::lattice::LatticeKind;

/// Columns of a model. A plane has no `velocity_z`.
#[derive(Clone, Debug)]
pub struct Fields<T> {
    /// Populations after the collision, less the weights, in lattice units: `population_0` and so on.
    pub populations: Vec<State<T>>,
    /// The populations of the next step.
    pub(crate) next: Vec<Rate<T>>,
    /// Number of the body that a site is in, from 1; 0 in the fluid.
    pub solid: State<u8>,
    /// Derived: pressure beyond that of the reference density, Pa; 0 in bodies.
    pub pressure: Rate<T>,
    /// Derived: velocity, m/s; 0 in bodies.
    pub velocity: Vec<Rate<T>>,
}

impl<T: Real> Fields<T> {
    /// Declares them.
    pub(crate) fn declare(columns: &mut Columns, lattice: LatticeKind) -> Self {
        let all = 0..lattice.velocities().len();
        Self {
            populations: all.clone().map(|q| columns.state(&format!("population_{q}"))).collect(),
            next: all.map(|q| columns.rate(&format!("next_{q}"))).collect(),
            solid: columns.state("solid"),
            pressure: columns.rate("pressure"),
            velocity: ["velocity_x", "velocity_y", "velocity_z"][..lattice.dims()]
                .iter()
                .map(|name| columns.rate(name))
                .collect(),
        }
    }
}
