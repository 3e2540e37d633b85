//! The columns of an SPH model: only those that its terms need exist.

use finegrain_framework::{Columns, Rate, Real, State};

use crate::quantity::Quantity;

/// Names of the coordinate directions, for column names.
const DIRECTIONS: [&str; 3] = ["x", "y", "z"];

/// Handles of the columns of one model, of type `T` but for the positions, of type `P`.
#[derive(Clone, Debug)]
pub struct Fields<T, P = T> {
    /// Position, m, one column a direction.
    pub position: Vec<State<P>>,
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
    /// Sound speed of each particle, m/s, of the present evaluation; only for gas.
    pub sound_speed: Option<State<T>>,
    /// Smoothing length of each particle, m; only where it follows the density.
    pub smoothing_length: Option<Rate<T>>,
    /// `Omega`, by which forces of varying smoothing lengths differ; only where they vary.
    pub grad_h: Option<Rate<T>>,
    /// Speed of the fastest signal between a particle and its neighbours, m/s; only with artificial
    /// viscosity for shocks.
    pub signal_speed: Option<Rate<T>>,
    /// Acceleration, m/s^2.
    pub acceleration: Vec<Rate<T>>,
    /// Rate of change of the density; only where density evolves.
    pub density_rate: Option<Rate<T>>,
    /// Rate of change of the pressure; only where pressure evolves.
    pub pressure_rate: Option<Rate<T>>,
    /// Sum of the kernel, 1/m^3 (1/m^2 in 2-D); only where it gives the density.
    pub number_density: Option<Rate<T>>,
    /// Rate of change of the energy.
    pub energy_rate: Option<Rate<T>>,
    /// `mu epsilon / rho^2`, the components xx, (xy, yy, (xz, yz, zz)); only with the viscosity in
    /// strain-rate form.
    pub stress_term: Vec<Rate<T>>,
    /// Force of the fluid and of the rest of the body on a particle of a body, over its mass,
    /// m/s^2; 0 in the fluid. Only where forces on bodies are asked for.
    pub reaction: Vec<Rate<T>>,
    /// Distance to the nearest surface of a body, m, negative inside; only where a profile of the
    /// velocity is fitted.
    pub surface_distance: Option<State<T>>,
    /// Velocity that friction sees in bodies, m/s; only where it is extrapolated from the fluid.
    pub mirrored_velocity: Vec<Rate<T>>,
    /// Pressure that bodies take from the fluid, Pa; only where it is extrapolated.
    pub wall_pressure: Option<Rate<T>>,
    /// Sums of density differences over the kernel gradient, kg/m^4; only with density diffusion
    /// that knows the gradient.
    pub density_slope: Vec<Rate<T>>,
    /// Gradient of the density of the present evaluation, kg/m^4; as above.
    pub density_gradient: Vec<State<T>>,
    /// Moment matrix of the neighbours, the components xx, (xy, yy, (xz, yz, zz)); only with terms
    /// that correct the kernel gradient or know the free surface.
    pub moment: Vec<Rate<T>>,
    /// Inverse of the moment matrix; only with terms that correct the kernel gradient.
    pub correction: Vec<State<T>>,
    /// Smallest eigenvalue of the moment matrix: 1 in the fluid, less at a free surface; only with
    /// terms that know the free surface.
    pub fullness: Option<State<T>>,
    /// Velocity of particles besides that of the fluid, m/s; only with shifting.
    pub drift: Vec<Rate<T>>,
}

/// Where a quantity is stored.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Column<T> {
    State(State<T>),
    Rate(Rate<T>),
}

impl<T: Real, P: Real> Fields<T, P> {
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
        let symmetric = |component: fn(usize) -> Quantity| {
            Quantity::symmetric(component, dims).filter(|&q| used(q)).enumerate()
        };
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
            sound_speed: used(Quantity::SoundSpeed).then(|| columns.register("sound_speed")),
            smoothing_length: used(Quantity::SmoothingLength)
                .then(|| columns.rate("smoothing_length")),
            grad_h: used(Quantity::GradH).then(|| columns.rate("grad_h")),
            signal_speed: used(Quantity::SignalSpeed).then(|| columns.rate("signal_speed")),
            acceleration: directions
                .iter()
                .map(|d| columns.rate(&name("acceleration", d)))
                .collect(),
            density_rate: used(Quantity::DensityRate).then(|| columns.rate("density_rate")),
            pressure_rate: used(Quantity::PressureRate).then(|| columns.rate("pressure_rate")),
            number_density: used(Quantity::NumberDensity).then(|| columns.rate("number_density")),
            energy_rate: used(Quantity::EnergyRate).then(|| columns.rate("energy_rate")),
            stress_term: Quantity::symmetric(Quantity::StressTerm, dims)
                .filter(|&stress| used(stress))
                .enumerate()
                .map(|(k, _)| columns.rate(&format!("stress_term_{k}")))
                .collect(),
            reaction: vector(Quantity::Reaction)
                .map(|d| columns.rate(&name("reaction", d)))
                .collect(),
            surface_distance: used(Quantity::SurfaceDistance)
                .then(|| columns.register("surface_distance")),
            mirrored_velocity: vector(Quantity::MirroredVelocity)
                .map(|d| columns.rate(&name("mirrored_velocity", d)))
                .collect(),
            wall_pressure: used(Quantity::WallPressure).then(|| columns.rate("wall_pressure")),
            density_slope: vector(Quantity::DensitySlope)
                .map(|d| columns.rate(&name("density_slope", d)))
                .collect(),
            density_gradient: vector(Quantity::DensityGradient)
                .map(|d| columns.register(&name("density_gradient", d)))
                .collect(),
            moment: symmetric(Quantity::Moment)
                .map(|(k, _)| columns.rate(&format!("moment_{k}")))
                .collect(),
            correction: symmetric(Quantity::Correction)
                .map(|(k, _)| columns.register(&format!("correction_{k}")))
                .collect(),
            fullness: used(Quantity::Fullness).then(|| columns.register("fullness")),
            drift: vector(Quantity::Drift).map(|d| columns.rate(&name("drift", d))).collect(),
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
            Quantity::EnergyRate => self.energy_rate.map(Column::Rate),
            Quantity::SurfaceVelocity(a) => {
                self.surface_velocity.get(a).copied().map(Column::State)
            }
            Quantity::MirroredVelocity(a) => {
                self.mirrored_velocity.get(a).copied().map(Column::Rate)
            }
            Quantity::Reaction(a) => self.reaction.get(a).copied().map(Column::Rate),
            Quantity::SurfaceDistance => self.surface_distance.map(Column::State),
            Quantity::WallPressure => self.wall_pressure.map(Column::Rate),
            Quantity::Density => Some(Column::State(self.density)),
            Quantity::DensitySlope(a) => self.density_slope.get(a).copied().map(Column::Rate),
            Quantity::DensityGradient(a) => {
                self.density_gradient.get(a).copied().map(Column::State)
            }
            Quantity::Moment(k) => self.moment.get(k).copied().map(Column::Rate),
            Quantity::Correction(k) => self.correction.get(k).copied().map(Column::State),
            Quantity::Fullness => self.fullness.map(Column::State),
            Quantity::Drift(a) => self.drift.get(a).copied().map(Column::Rate),
            Quantity::Energy => self.energy.map(Column::State),
            Quantity::SoundSpeed => self.sound_speed.map(Column::State),
            Quantity::SmoothingLength => self.smoothing_length.map(Column::Rate),
            Quantity::GradH => self.grad_h.map(Column::Rate),
            Quantity::SignalSpeed => self.signal_speed.map(Column::Rate),
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
