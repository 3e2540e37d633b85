//! Advection at constant velocity, `du/dt = -v . grad u`, by central differences: for what is smooth.

use finegrain_framework::pack::Pack;
use finegrain_framework::{FixedPace, Integrator, Real};

use super::Equation;
use crate::around::At;
use crate::boundary::Boundary;
use crate::error::FdError;
use crate::mesh::Mesh;
use crate::model::{Builder, Compiled, Fd, Given};
use crate::operator::Order;
use crate::stability;

/// Its right-hand side.
pub(crate) struct Drifting<T> {
    pub velocity: [T; 3],
}

impl<T: Real> Equation<T, 1, 0> for Drifting<T> {
    fn name(&self) -> &'static str {
        "advection by central differences"
    }

    #[inline(always)]
    fn rate<V: Pack<Scalar = T>, const R: usize, const K: usize>(
        &self,
        [u]: [At<'_, V, R, K>; 1],
        []: [At<'_, V, R, K>; 0],
        _: T,
    ) -> [V; 1] {
        let mut along = u.first_derivative(0) * self.velocity[0];
        for axis in 1..3 {
            if axis < u.axes() {
                along = along + u.first_derivative(axis) * self.velocity[axis];
            }
        }
        [-along]
    }
}

/// Advection at constant velocity, and how it is solved.
///
/// Where it flows in the boundary needs a value, and where it flows out [`crate::Condition::Outflow`]. Without
/// a step or a shock this is the most accurate; with one it rings.
#[derive(Clone, Debug)]
pub struct Drift {
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// Order of the derivatives.
    pub order: Order,
    /// How time is stepped.
    pub integrator: Integrator,
    /// What holds on the boundary.
    pub boundary: Boundary,
}

impl Drift {
    /// Longest stable time step, s. In a periodic mesh by the amplification of waves; with closed ends by the norm
    /// of the derivatives, which is on the safe side.
    ///
    /// # Errors
    /// As [`Drift::model`].
    pub fn time_step_limit(&self, mesh: &Mesh) -> Result<f64, FdError> {
        self.boundary.check_flow(mesh, self.velocity)?;
        let norm = stability::gradient_norm(mesh, self.order, &self.boundary, self.velocity)?;
        Ok(stability::oscillation_extent(self.integrator, mesh)? / norm)
    }

    /// A model that starts from `start`, a function of the position, m.
    ///
    /// # Errors
    /// As [`crate::Heat::model`]; if it flows in where no value is given, or out where one is.
    pub fn model<T: Compiled>(
        &self,
        mesh: &Mesh,
        time_step: f64,
        start: Given<'_>,
    ) -> Result<Fd<T>, FdError> {
        let limit = self.time_step_limit(mesh)?;
        let scheme = format!("{} and derivatives of order {}", self.integrator.name(), self.order);
        stability::check_time_step(time_step, limit, scheme)?;
        let mut builder = Builder::<T, 1, 0>::new(mesh, [&self.boundary], self.order)?;
        builder.start([("quantity", start)])?;
        let pace = Box::new(FixedPace(time_step));
        builder.first_order("drift", self.integrator, pace, |builder, form| {
            T::drift(builder, self.velocity, form)
        })
    }
}
