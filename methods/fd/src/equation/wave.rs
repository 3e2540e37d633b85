//! The wave equation, `d^2u/dt^2 = c^2 laplace u`.

use finegrain_framework::Real;
use finegrain_framework::Whole;
use finegrain_framework::pack::Pack;
use finegrain_framework::space::Grid;

use super::Equation;
use crate::around::{At, laplacian};
use crate::boundary::Boundary;
use crate::error::{FdError, positive};
use crate::mesh::Mesh;
use crate::model::{Builder, Compiled, Fd, Given, Parts};
use crate::operator::Order;
use crate::stability;

/// Its right-hand side.
pub(crate) struct Waves<T> {
    pub speed_squared: T,
}

impl<T: Real> Equation<T, 1, 0> for Waves<T> {
    const SECOND_ORDER: bool = true;

    fn name(&self) -> &'static str {
        "wave equation"
    }

    #[inline(always)]
    fn rate<V: Pack<Scalar = T>, const R: usize, const K: usize>(
        &self,
        [u]: [At<'_, V, R, K>; 1],
        []: [At<'_, V, R, K>; 0],
        _: T,
    ) -> [V; 1] {
        [laplacian(u) * self.speed_squared]
    }
}

/// The wave equation, stepped by leapfrog: `u_{n+1} = 2 u_n - u_{n-1} + dt^2 c^2 laplace u_n`, which is
/// of second order and keeps an energy to round-off.
#[derive(Clone, Debug)]
pub struct Wave {
    /// Speed of the waves, m/s.
    pub speed: f64,
    /// Order of the Laplacian.
    pub order: Order,
    /// What holds on the boundary.
    pub boundary: Boundary,
}

impl Wave {
    /// Longest stable time step, s: `2 / (c sqrt(rho))`, with the largest eigenvalue of the Laplacian
    /// with its boundary conditions.
    ///
    /// # Errors
    /// As [`Wave::model`].
    pub fn time_step_limit(&self, mesh: &Mesh) -> Result<f64, FdError> {
        positive("speed", self.speed)?;
        let radius = stability::laplacian_radius(mesh, self.order, &self.boundary)?;
        Ok(2.0 / (self.speed * radius.sqrt()))
    }

    /// A model that starts from a displacement and its rate of change, as functions of the position, m.
    /// Its time step, s, never changes.
    ///
    /// # Errors
    /// As [`crate::Heat::model`].
    pub fn model<T: Compiled>(
        &self,
        mesh: &Mesh,
        time_step: f64,
        displacement: Given<'_>,
        velocity: Given<'_>,
    ) -> Result<Fd<T>, FdError> {
        let limit = self.time_step_limit(mesh)?;
        let scheme = format!("leapfrog and a Laplacian of order {}", self.order);
        stability::check_time_step(time_step, limit, scheme)?;
        let mut builder = Builder::<T, 1, 0>::new(mesh, [&self.boundary], self.order)?;
        builder.start([("displacement", displacement)])?;
        builder.two_step("wave", time_step, velocity, |builder, form| {
            T::wave(builder, self.speed, form)
        })
    }
}

/// The energy that leapfrog keeps to round-off where nothing is imposed on the boundary but zeros, over the
/// density: `|(u_n - u_{n-1}) / dt|^2 / 2 - c^2 (u_{n-1}, laplace u_n) / 2`. It is that of the time
/// `t_n - dt / 2`. The derived fields must be up to date.
pub fn energy<T: Compiled>(whole: &mut Whole<'_, Grid>, parts: &Parts<T>, time_step: f64) -> f64 {
    let [acceleration] = parts.derived[..] else { return 0.0 };
    let [energy] = whole.sum(|near| {
        let u = near.rows(parts.unknowns[0]);
        let (before, a) = (near.rate_rows(parts.rates[0]), near.rate_rows(acceleration));
        let mut sum = 0.0;
        for (j, k) in near.sub_domain().rows() {
            let (y, z) = (j as isize, k as isize);
            let row = u.row(y, z).iter().zip(before.row(y, z)).zip(a.row(y, z));
            let row = row.zip(&parts.weights[0]).map(|(((u, before), a), weight)| {
                let [u, before, a] = [u, before, a].map(|x| x.as_f64());
                let velocity = (u - before) / time_step;
                0.5 * weight * (velocity * velocity - before * a)
            });
            sum += parts.weights[1][j] * parts.weights[2][k] * row.sum::<f64>();
        }
        [sum]
    });
    energy
}
