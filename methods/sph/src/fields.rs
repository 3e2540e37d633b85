//! The columns of an SPH model: only those that its terms need exist.

use finegrain_framework::{Columns, Rate, Real, State};

use crate::term::Term;

/// Names of the coordinate directions, for column names.
const DIRECTIONS: [&str; 3] = ["x", "y", "z"];

/// Number of independent components of a symmetric tensor in `dims` dimensions.
pub(crate) const fn symmetric(dims: usize) -> usize {
    dims * (dims + 1) / 2
}

/// Handles of the columns of one model.
#[derive(Clone, Debug)]
pub struct Fields<T> {
    /// Position, m, one column a direction.
    pub position: Vec<State<T>>,
    /// Velocity, m/s.
    pub velocity: Vec<State<T>>,
    /// Density, kg/m^3.
    pub density: State<T>,
    /// Specific internal energy, J/kg; only with the energy equation.
    pub energy: Option<State<T>>,
    /// Depth below the surface of a body, m, for the particles that fill it; 0 in the fluid. Only
    /// where there are bodies.
    pub wall_depth: Option<State<T>>,
    /// Number that a particle keeps for life, while its place in memory changes.
    pub identity: State<u32>,
    /// Volume `m / rho`, m^3 (m^2 in 2-D, m in 1-D), of the present evaluation.
    pub volume: State<T>,
    /// `p / rho^2` of the present evaluation.
    pub pressure_term: State<T>,
    /// Acceleration, m/s^2.
    pub acceleration: Vec<Rate<T>>,
    /// Rate of change of the density.
    pub density_rate: Rate<T>,
    /// Rate of change of the energy.
    pub energy_rate: Option<Rate<T>>,
    /// `mu epsilon / rho^2`, the components xx, (xy, yy, (xz, yz, zz)); only with the viscosity in
    /// strain-rate form.
    pub stress_term: Vec<Rate<T>>,
}

impl<T: Real> Fields<T> {
    /// Declares what `terms` need in `dims` dimensions.
    pub(crate) fn declare(
        columns: &mut Columns,
        dims: usize,
        has_bodies: bool,
        terms: &[Term<T>],
    ) -> Self {
        let has_energy = terms.iter().any(|t| matches!(t, Term::Energy(_)));
        let has_stress = terms.iter().any(|t| matches!(t, Term::StrainRate(_)));
        let directions = &DIRECTIONS[..dims];
        let name = |what: &str, direction: &str| format!("{what}_{direction}");
        Self {
            position: directions.iter().map(|d| columns.state(&name("position", d))).collect(),
            velocity: directions.iter().map(|d| columns.state(&name("velocity", d))).collect(),
            density: columns.state("density"),
            energy: has_energy.then(|| columns.state("energy")),
            wall_depth: has_bodies.then(|| columns.state("wall_depth")),
            identity: columns.state("identity"),
            volume: columns.register("volume"),
            pressure_term: columns.register("pressure_term"),
            acceleration: directions
                .iter()
                .map(|d| columns.rate(&name("acceleration", d)))
                .collect(),
            density_rate: columns.rate("density_rate"),
            energy_rate: has_energy.then(|| columns.rate("energy_rate")),
            stress_term: if has_stress {
                (0..symmetric(dims)).map(|k| columns.rate(&format!("stress_term_{k}"))).collect()
            } else {
                Vec::new()
            },
        }
    }
}
