//! The columns of an SPH model: only those that its terms need exist.

use finegrain_framework::{Columns, Rate, Real, State};

use crate::quantity::Quantity;

/// Names of the coordinate directions, for column names.
const DIRECTIONS: [&str; 3] = ["x", "y", "z"];

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
    /// Velocity with which the surface of a body slides along itself, m/s, for the particles that
    /// fill it; only where there are such bodies.
    pub surface_velocity: Vec<State<T>>,
    /// Number that a particle keeps for life, while its place in memory changes.
    pub identity: State<u32>,
    /// Volume `m / rho`, m^3 (m^2 in 2-D, m in 1-D), of the present evaluation.
    pub volume: State<T>,
    /// `p / rho^2` of the present evaluation; only if the form of the pressure gradient uses it.
    pub pressure_term: Option<State<T>>,
    /// Pressure, Pa: evolved, or of the present evaluation if it follows from the density; only if
    /// a term uses it.
    pub pressure: Option<State<T>>,
    /// Acceleration, m/s^2.
    pub acceleration: Vec<Rate<T>>,
    /// Rate of change of the density; only where density evolves.
    pub density_rate: Option<Rate<T>>,
    /// Rate of change of the pressure; only where pressure evolves.
    pub pressure_rate: Option<Rate<T>>,
    /// Sum of the kernel, 1/m^3 (1/m^2 in 2-D); only where it gives the density.
    pub number_density: Option<Rate<T>>,
    /// Velocity besides that of the flow, m/s; only with transport velocity.
    pub drift: Vec<Rate<T>>,
    /// Rate of change of the energy.
    pub energy_rate: Option<Rate<T>>,
    /// `mu epsilon / rho^2`, the components xx, (xy, yy, (xz, yz, zz)); only with the viscosity in
    /// strain-rate form.
    pub stress_term: Vec<Rate<T>>,
    /// Velocity that friction sees in bodies, m/s; only where it is extrapolated from the fluid.
    pub mirrored_velocity: Vec<Rate<T>>,
    /// Pressure that bodies take from the fluid, Pa; only where it is extrapolated.
    pub wall_pressure: Option<Rate<T>>,
}

/// Where a quantity is stored.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Column<T> {
    State(State<T>),
    Rate(Rate<T>),
}

impl<T: Real> Fields<T> {
    /// Declares the columns of a model in `dims` dimensions whose terms use the quantities `uses`.
    pub(crate) fn declare(
        columns: &mut Columns,
        dims: usize,
        has_bodies: bool,
        uses: &[Quantity],
    ) -> Self {
        let used = |quantity: Quantity| uses.contains(&quantity);
        let directions = &DIRECTIONS[..dims];
        let vector = |component: fn(usize) -> Quantity| {
            directions.iter().enumerate().filter(move |&(a, _)| used(component(a))).map(|(_, d)| d)
        };
        let name = |what: &str, direction: &str| format!("{what}_{direction}");
        Self {
            position: directions.iter().map(|d| columns.state(&name("position", d))).collect(),
            velocity: directions.iter().map(|d| columns.state(&name("velocity", d))).collect(),
            density: columns.state("density"),
            energy: used(Quantity::EnergyRate).then(|| columns.state("energy")),
            wall_depth: has_bodies.then(|| columns.state("wall_depth")),
            surface_velocity: vector(Quantity::SurfaceVelocity)
                .map(|d| columns.state(&name("surface_velocity", d)))
                .collect(),
            identity: columns.state("identity"),
            volume: columns.register("volume"),
            pressure_term: used(Quantity::PressureTerm).then(|| columns.register("pressure_term")),
            pressure: used(Quantity::Pressure).then(|| {
                if used(Quantity::PressureRate) {
                    columns.state("pressure")
                } else {
                    columns.register("pressure")
                }
            }),
            acceleration: directions
                .iter()
                .map(|d| columns.rate(&name("acceleration", d)))
                .collect(),
            density_rate: used(Quantity::DensityRate).then(|| columns.rate("density_rate")),
            pressure_rate: used(Quantity::PressureRate).then(|| columns.rate("pressure_rate")),
            number_density: used(Quantity::NumberDensity).then(|| columns.rate("number_density")),
            drift: vector(Quantity::Drift).map(|d| columns.rate(&name("drift", d))).collect(),
            energy_rate: used(Quantity::EnergyRate).then(|| columns.rate("energy_rate")),
            stress_term: Quantity::symmetric(Quantity::StressTerm, dims)
                .filter(|&stress| used(stress))
                .enumerate()
                .map(|(k, _)| columns.rate(&format!("stress_term_{k}")))
                .collect(),
            mirrored_velocity: vector(Quantity::MirroredVelocity)
                .map(|d| columns.rate(&name("mirrored_velocity", d)))
                .collect(),
            wall_pressure: used(Quantity::WallPressure).then(|| columns.rate("wall_pressure")),
        }
    }

    /// Where a quantity is stored, if this model has it.
    pub(crate) fn column(&self, quantity: Quantity) -> Option<Column<T>> {
        match quantity {
            Quantity::Velocity(a) => Some(Column::State(self.velocity[a])),
            Quantity::Volume => Some(Column::State(self.volume)),
            Quantity::PressureTerm => self.pressure_term.map(Column::State),
            Quantity::Pressure => self.pressure.map(Column::State),
            Quantity::WallDepth => self.wall_depth.map(Column::State),
            Quantity::StressTerm(k) => self.stress_term.get(k).copied().map(Column::Rate),
            Quantity::Acceleration(a) => Some(Column::Rate(self.acceleration[a])),
            Quantity::DensityRate => self.density_rate.map(Column::Rate),
            Quantity::PressureRate => self.pressure_rate.map(Column::Rate),
            Quantity::NumberDensity => self.number_density.map(Column::Rate),
            Quantity::Drift(a) => self.drift.get(a).copied().map(Column::Rate),
            Quantity::EnergyRate => self.energy_rate.map(Column::Rate),
            Quantity::SurfaceVelocity(a) => {
                self.surface_velocity.get(a).copied().map(Column::State)
            }
            Quantity::MirroredVelocity(a) => {
                self.mirrored_velocity.get(a).copied().map(Column::Rate)
            }
            Quantity::WallPressure => self.wall_pressure.map(Column::Rate),
        }
    }

    /// The column of a quantity that a sweep writes.
    pub(crate) fn rate(&self, quantity: Quantity) -> Option<Rate<T>> {
        match self.column(quantity)? {
            Column::Rate(rate) => Some(rate),
            Column::State(_) => None,
        }
    }
}
