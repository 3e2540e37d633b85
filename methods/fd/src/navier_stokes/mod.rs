//! Incompressible flow, `du/dt + div(u u) = -grad p + nu laplace u + f`, `div u = 0`, with p over the density.
//!
//! Every evaluation of the rates is projected: the pressure is the one with which the rates have no divergence
//! (and take away what rounding has left in the velocity). Velocities that have none then never get any, whatever
//! the integrator, which keeps its order; to project the velocity after every stage comes to the same, but would
//! need integrators of its own, and the pressure of a stage would be one at no time in particular.

mod around;
mod between_walls;
mod body;
mod end;
mod equation;
mod pace;
mod patch;
mod stages;
mod stencil;

use std::sync::Arc;

use finegrain_framework::space::Grid;
use finegrain_framework::{Columns, Evolution, Integrator, Model, Rate, Real, State, Step};

use crate::error::{FdError, positive};
use crate::mesh::{AXES, Mesh};
use crate::model::{Compiled, Fd, Parts};
use crate::operator::staggered::StaggeredOrder;
use body::Faces;
use pace::{FlowPace, Limit};

pub use body::Body;
pub(crate) use body::Immersed;
pub use end::FlowEnd;
pub(crate) use stages::{Fields, Stages};

/// Incompressible flow in 2 or 3 directions, and how it is solved: on a staggered grid of cells, each side of the mesh
/// being periodic or, with [`Spread::Cells`](crate::Spread::Cells), having [`FlowEnd`]s.
#[derive(Clone, Debug, PartialEq)]
pub struct NavierStokes {
    /// Kinematic viscosity, m^2/s.
    pub viscosity: f64,
    /// Acceleration by a body force, m/s^2.
    pub acceleration: [f64; 3],
    /// What is at the lower and upper ends of each axis that is not periodic.
    pub ends: [[FlowEnd; 2]; 3],
    /// Bodies in the flow; in 2 directions, with operators of second order.
    pub bodies: Vec<Body>,
    /// Order of the operators. With ends only advection and diffusion are of the fourth, three points or more from them;
    /// the whole is then of second order, but errors are smaller.
    pub order: StaggeredOrder,
    /// How time is stepped.
    pub integrator: Integrator,
    /// The time step over the longest that is stable, at most 1.
    pub courant: f64,
}

impl NavierStokes {
    /// Names of the fields for those who look: in the middle of cells the pressure over the density, m^2/s^2, the
    /// components of the velocity, m/s, and in the end its divergence, 1/s.
    pub const DERIVED: [&str; 5] =
        ["pressure", "velocity_x", "velocity_y", "velocity_z", "divergence"];

    /// Longest stable time step, s, where the components of the velocity are at most `speeds`, m/s: by how the
    /// integrator amplifies waves in a uniform flow.
    ///
    /// # Errors
    /// As [`NavierStokes::model`].
    pub fn time_step_limit(&self, mesh: &Mesh, speeds: [f64; 3]) -> Result<f64, FdError> {
        self.check(mesh)?;
        let limit = Limit::new(self, mesh).of(speeds);
        if limit > 0.0 {
            return Ok(limit);
        }
        let scheme = format!("central differences with {}", self.integrator.name());
        Err(FdError::NeverStable { scheme })
    }

    /// A model that starts from a velocity, m/s, as a function of the position, m, of which what has a divergence is
    /// taken away. Its time steps follow the largest speeds.
    ///
    /// The unknowns are the velocities along each axis, half a spacing below the points of the mesh along that axis.
    ///
    /// # Errors
    /// If a number is outside its valid range, the mesh is not of 2 or 3 directions or has too few points, points
    /// lie on the ends, there are bodies with operators of fourth order, a wall moves into or out of the
    /// fluid, it comes in or leaves where it cannot, a body does not fit the mesh, or the scheme is stable with no time
    /// step.
    pub fn model<T: Compiled>(
        &self,
        mesh: &Mesh,
        start: &dyn Fn([f64; 3]) -> [f64; 3],
    ) -> Result<Fd<T>, FdError> {
        self.time_step_limit(mesh, [0.0; 3])?;
        let dims = mesh.dims();
        // Velocities and their rates, and the pressure; what is derived for those who look costs nothing until then.
        mesh.check_memory::<T>(2 * dims + 1)?;
        let domain = Grid::builder(mesh.shape())
            .periodic(mesh.is_periodic())
            .reach(self.reach())
            .origin(mesh.position([0; 3]))
            .spacing(mesh.spacing())
            .build();
        let mut columns = Columns::new(domain.points());
        let axes = || AXES.iter().take(dims).enumerate();
        let names = axes().map(|(_, axis)| format!("face_velocity_{axis}"));
        let velocity: Vec<State<T>> = names.map(|name| columns.state(&name)).collect();
        let names = axes().map(|(_, axis)| format!("rate_velocity_{axis}"));
        let rates: Vec<Rate<T>> = names.map(|name| columns.rate(&name)).collect();
        let pressure = columns.rate(Self::DERIVED[0]);
        let middle = axes().map(|(a, _)| Self::DERIVED[1 + a]).chain([Self::DERIVED[4]]);
        let middle: Vec<Rate<T>> = middle.map(|name| columns.rate(name)).collect();
        for (a, &column) in velocity.iter().enumerate() {
            self.begin(mesh, a, start, columns.values_mut(column))?;
        }
        let immersed = self.immersed(mesh, &velocity, &rates, pressure, &mut columns)?;
        let fields = Fields {
            equation: self.clone(),
            mesh: mesh.clone(),
            order: self.order,
            velocity: velocity.clone(),
            rates: rates.clone(),
            pressure,
            middle: middle.clone(),
            immersed: immersed.clone(),
        };
        let stages = T::navier_stokes(&fields)?;
        let pairs = velocity.iter().copied().zip(rates.iter().copied());
        let evolution = pairs.fold(Evolution::new(), |all, (u, rate)| all.with(u, rate));
        let mut plan = self.integrator.plan(&mut columns, &evolution, &stages.evaluation);
        plan.prologue = Some(Step::builder().stages_at(0.0, &stages.start).build());
        plan.derived = Some(Step::builder().stages_at(0.0, &stages.looking).build());
        let model = Model {
            method: "fd navier-stokes".to_owned(),
            domain,
            columns,
            plan,
            whole: Vec::new(),
            pacing: Box::new(FlowPace::new(self, mesh, &velocity)),
        };
        let mut weights = [0, 1, 2].map(|a| vec![mesh.spacing()[a]; mesh.shape()[a]]);
        if let Some(beyond) = self.layer_beyond(mesh) {
            weights[beyond.axis][beyond.place] = 0.0;
        }
        let derived = [pressure].into_iter().chain(middle).collect();
        let mesh = mesh.clone();
        Ok(Fd {
            model,
            parts: Parts { mesh, unknowns: velocity, rates, derived, weights, immersed },
        })
    }

    /// The bodies on the mesh, if there are any.
    fn immersed<T: Compiled>(
        &self,
        mesh: &Mesh,
        velocity: &[State<T>],
        rates: &[Rate<T>],
        pressure: Rate<T>,
        columns: &mut Columns,
    ) -> Result<Option<Immersed<T>>, FdError> {
        if self.bodies.is_empty() {
            return Ok(None);
        }
        let faces = Arc::new(Faces::new(mesh, &self.bodies, self.layer_beyond(mesh))?);
        let traction = ["traction_x", "traction_y"].map(|name| columns.rate(name)).to_vec();
        let (velocity, rates) = (velocity.to_vec(), rates.to_vec());
        let acceleration = self.acceleration;
        Ok(Some(Immersed { faces, velocity, rates, pressure, traction, acceleration }))
    }

    /// Points that operators read to either side.
    fn reach(&self) -> usize {
        if self.order == StaggeredOrder::Second { 2 } else { 3 }
    }

    fn check(&self, mesh: &Mesh) -> Result<(), FdError> {
        positive("viscosity", self.viscosity)?;
        positive("courant", self.courant)?;
        if self.courant > 1.0 {
            let range = "at most 1: more than the longest time step is not stable";
            return Err(FdError::OutOfRange { name: "courant", value: self.courant, range });
        }
        for value in self.acceleration {
            if !value.is_finite() {
                let (name, range) = ("acceleration", "finite");
                return Err(FdError::OutOfRange { name, value, range });
            }
        }
        if mesh.dims() == 1 {
            let (name, range) = ("number of directions of a flow", "2 or 3");
            return Err(FdError::OutOfRange { name, value: 1.0, range });
        }
        mesh.check(|_| 2 * self.reach())?;
        self.check_ends(mesh)?;
        for (number, body) in self.bodies.iter().enumerate() {
            body.check().map_err(|cause| FdError::Body { number, cause: cause.to_string() })?;
            if mesh.dims() != 2 || self.order != StaggeredOrder::Second {
                let cause =
                    "bodies take a mesh of two directions and operators of order 2".to_owned();
                return Err(FdError::Body { number, cause });
            }
        }
        if matches!(self.integrator, Integrator::Leapfrog | Integrator::SymplecticEuler) {
            let scheme = format!("incompressible flow with {}", self.integrator.name());
            return Err(FdError::NeverStable { scheme });
        }
        Ok(())
    }

    /// The velocity along axis `a` at the beginning.
    fn begin<T: Real>(
        &self,
        mesh: &Mesh,
        a: usize,
        start: &dyn Fn([f64; 3]) -> [f64; 3],
        targets: &mut [T],
    ) -> Result<(), FdError> {
        const NAMES: [&str; 3] = ["velocity_x", "velocity_y", "velocity_z"];
        let (lower, below) = (mesh.sides()[a].lower, 0.5 * mesh.spacing()[a]);
        let has_wall = !mesh.is_periodic()[a] && self.ends[a][0] != FlowEnd::Inflow;
        for (target, mut position) in targets.iter_mut().zip(mesh.positions()) {
            let is_on_wall = has_wall && position[a] < lower + 1.5 * below;
            position[a] -= below;
            let value = if is_on_wall { 0.0 } else { start(position)[a] };
            if !value.is_finite() {
                let (field, range) = (NAMES[a], "finite");
                return Err(FdError::Start { field, position, value, range });
            }
            *target = T::of(value);
        }
        Ok(())
    }
}
