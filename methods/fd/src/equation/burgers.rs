//! Burgers' equation, `du/dt + d(u^2/2)/dx = nu d^2u/dx^2`, along x.

use std::marker::PhantomData;

use finegrain_framework::pack::Pack;
use finegrain_framework::{FixedPace, Integrator, Real};

use super::Equation;
use crate::around::At;
use crate::boundary::Boundary;
use crate::error::{FdError, positive};
use crate::mesh::Mesh;
use crate::model::{Builder, Compiled, Fd, Given};
use crate::operator::Order;
use crate::operator::face::{Face, FaceValue, split};
use crate::stability;

/// Its right-hand side.
pub(crate) struct Steepening<T, F> {
    viscosity: T,
    face: PhantomData<F>,
}

impl<T, F> Steepening<T, F> {
    pub fn new(viscosity: T, _: F) -> Self {
        Self { viscosity, face: PhantomData }
    }
}

impl<T: Real, F: FaceValue> Equation<T, 1, 0> for Steepening<T, F> {
    const IS_LIGHT: bool = false;

    fn name(&self) -> &'static str {
        "Burgers' equation"
    }

    #[inline(always)]
    fn rate<V: Pack<Scalar = T>, const R: usize, const K: usize>(
        &self,
        [u]: [At<'_, V, R, K>; 1],
        []: [At<'_, V, R, K>; 0],
        _: T,
    ) -> [V; 1] {
        let convection = (flux::<V, F, R, K>(u, 1) - flux::<V, F, R, K>(u, 0)) * u.per_spacing(0);
        [u.second_derivative(0) * self.viscosity - convection]
    }
}

/// `u^2 / 2` on the face before point `face`, with the largest speed nearby.
#[inline(always)]
fn flux<V: Pack, F: FaceValue, const R: usize, const K: usize>(
    u: At<'_, V, R, K>,
    face: isize,
) -> V {
    let mut points = [u.here(); 6];
    let mut fluxes = points;
    let mut fastest = u.shifted(0, face).abs();
    for n in 0..6 {
        points[n] = u.shifted(0, face - 3 + n as isize);
        fluxes[n] = points[n] * points[n] * V::Scalar::of(0.5);
        fastest = fastest.max(points[n].abs());
    }
    split::<V, F>(points, fluxes, fastest)
}

/// Burgers' equation, and how it is solved.
#[derive(Clone, Debug)]
pub struct Burgers {
    /// Viscosity, m^2/s.
    pub viscosity: f64,
    /// How values on faces are made.
    pub face: Face,
    /// How time is stepped.
    pub integrator: Integrator,
    /// What holds on the boundary.
    pub boundary: Boundary,
}

impl Burgers {
    /// Longest stable time step, s, with the largest speed, m/s: that of convection and that of viscosity,
    /// one after the other.
    ///
    /// # Errors
    /// As [`Burgers::model`].
    pub fn time_step_limit(&self, mesh: &Mesh, speed: f64) -> Result<f64, FdError> {
        positive("viscosity", self.viscosity)?;
        let radius = stability::laplacian_radius(mesh, Order::Sixth, &self.boundary)?;
        let decay = self.viscosity * radius / stability::decay_extent(self.integrator);
        let courant = stability::advection_limit(self.face, self.integrator)?;
        Ok(1.0 / (decay + speed / (courant * mesh.spacing()[0])))
    }

    /// A model that starts from a velocity, m/s, as a function of the position, m; at no time may it be
    /// faster than at the beginning.
    ///
    /// # Errors
    /// As [`crate::Heat::model`].
    pub fn model<T: Compiled>(
        &self,
        mesh: &Mesh,
        time_step: f64,
        start: Given<'_>,
    ) -> Result<Fd<T>, FdError> {
        let fastest = mesh.positions().map(|x| start(x).abs()).fold(0.0, f64::max);
        let limit = self.time_step_limit(mesh, fastest)?;
        let scheme = format!("{} and {}", self.integrator.name(), self.face.name());
        stability::check_time_step(time_step, limit, scheme)?;
        let mut builder = Builder::<T, 1, 0>::new(mesh, [&self.boundary], Order::Sixth)?;
        builder.start([("velocity", start)])?;
        let pace = Box::new(FixedPace(time_step));
        builder.first_order("burgers", self.integrator, pace, |builder, form| {
            T::burgers(builder, self.viscosity, self.face, form)
        })
    }
}
