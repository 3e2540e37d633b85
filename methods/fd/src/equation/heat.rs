//! The heat equation, `dT/dt = kappa laplace T`.

use finegrain_framework::pack::Pack;
use finegrain_framework::{FixedPace, Real};

use super::Equation;
use crate::around::{At, laplacian};
use crate::boundary::Boundary;
use crate::error::{FdError, positive};
use crate::mesh::Mesh;
use crate::model::{Builder, Compiled, Fd, Given};
use crate::operator::Order;
use crate::stability;
use crate::time_stepping::TimeStepping;

/// Its right-hand side.
pub(crate) struct Diffusion<T> {
    pub diffusivity: T,
}

impl<T: Real> Equation<T, 1, 0> for Diffusion<T> {
    fn name(&self) -> &'static str {
        "heat equation"
    }

    #[inline(always)]
    fn rate<V: Pack<Scalar = T>, const R: usize, const K: usize>(
        &self,
        [t]: [At<'_, V, R, K>; 1],
        []: [At<'_, V, R, K>; 0],
        _: T,
    ) -> [V; 1] {
        [laplacian(t) * self.diffusivity]
    }
}

/// The heat equation, and how it is solved.
#[derive(Clone, Debug)]
pub struct Heat {
    /// Diffusivity, m^2/s.
    pub diffusivity: f64,
    /// Order of the Laplacian.
    pub order: Order,
    /// How time is stepped.
    pub integrator: TimeStepping,
    /// What holds on the boundary.
    pub boundary: Boundary,
}

impl Heat {
    /// Longest stable time step, s: what the integrator takes of decay over the largest eigenvalue of
    /// the Laplacian with its boundary conditions; infinite if it is implicit.
    ///
    /// # Errors
    /// As [`Heat::model`].
    pub fn time_step_limit(&self, mesh: &Mesh) -> Result<f64, FdError> {
        positive("diffusivity", self.diffusivity)?;
        let radius = stability::laplacian_radius(mesh, self.order, &self.boundary)?;
        Ok(match self.integrator {
            TimeStepping::Explicit(integrator) => {
                stability::decay_extent(integrator) / (self.diffusivity * radius)
            }
            TimeStepping::Implicit(_) => f64::INFINITY,
        })
    }

    /// A model that starts from a temperature, K, as a function of the position, m.
    ///
    /// # Errors
    /// If a number is outside its valid range, the mesh has too few points, order and boundary do not
    /// go together, or the time step, s, is not stable; of implicit steps, if they were not compiled or there is
    /// no memory for the factor.
    pub fn model<T: Compiled>(
        &self,
        mesh: &Mesh,
        time_step: f64,
        start: Given<'_>,
    ) -> Result<Fd<T>, FdError> {
        let limit = self.time_step_limit(mesh)?;
        let scheme = format!("{} and a Laplacian of order {}", self.integrator, self.order);
        stability::check_time_step(time_step, limit, scheme)?;
        let mut builder = Builder::<T, 1, 0>::new(mesh, [&self.boundary], self.order)?;
        builder.start([("temperature", start)])?;
        match self.integrator {
            TimeStepping::Explicit(integrator) => {
                let pace = Box::new(FixedPace(time_step));
                builder.first_order("heat", integrator, pace, |builder, form| {
                    T::heat(builder, self.diffusivity, form)
                })
            }
            #[cfg(feature = "implicit")]
            TimeStepping::Implicit(scheme) => crate::implicit::model(
                builder,
                "heat",
                scheme,
                time_step,
                |builder, form| T::heat(builder, self.diffusivity, form),
                |line, form| f64::heat(line, self.diffusivity, form),
            ),
            #[cfg(not(feature = "implicit"))]
            TimeStepping::Implicit(scheme) => Err(FdError::NotCompiled { scheme: scheme.name() }),
        }
    }
}
