//! The columns of a model.

use finegrain_framework::{Columns, Limit, Rate, Real, State};

use crate::lattice::LatticeKind;
use crate::physics::Streaming;

/// What all sites' populations add up to is about 1.
static UNSTABLE: Limit = Limit {
    most: 1.0,
    beyond: "the flow is unstable; choose another collision, more points or more viscosity",
};

/// Columns of a model. A plane has no `velocity_z`.
#[derive(Clone, Debug)]
pub struct Fields<T> {
    /// Populations after the collision, less the weights, in lattice units: `population_0` and so on. In
    /// place, `in_place_0` and so on: odd ones one site ahead.
    pub populations: Vec<State<T>>,
    /// The populations of the next step; none in place.
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
    pub(crate) fn declare(
        columns: &mut Columns,
        lattice: LatticeKind,
        streaming: Streaming,
    ) -> Self {
        let all = 0..lattice.velocities().len();
        let (name, next) = match streaming {
            Streaming::TwoGrids => ("population", all.clone()),
            Streaming::InPlace => ("in_place", 0..0),
        };
        let populations: Vec<_> = all.map(|q| columns.state(&format!("{name}_{q}"))).collect();
        populations.iter().for_each(|&population| columns.limit(population, &UNSTABLE));
        Self {
            populations,
            next: next.map(|q| columns.rate(&format!("next_{q}"))).collect(),
            solid: columns.state("solid"),
            pressure: columns.rate("pressure"),
            velocity: ["velocity_x", "velocity_y", "velocity_z"][..lattice.dims()]
                .iter()
                .map(|name| columns.rate(name))
                .collect(),
        }
    }
}
