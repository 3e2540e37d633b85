//! Advection, `du/dt + div(v u) = 0` with a given velocity v.

use std::marker::PhantomData;

use finegrain_framework::pack::Pack;
use finegrain_framework::{FixedPace, Integrator, Real};

use super::Equation;
use crate::around::At;
use crate::boundary::Boundary;
use crate::error::FdError;
use crate::mesh::Mesh;
use crate::model::{Builder, Compiled, Fd, Given};
use crate::operator::Order;
use crate::operator::face::{Face, FaceValue};
use crate::stability;

/// Its right-hand side.
pub(crate) struct Transport<F>(PhantomData<F>);

impl<F> Transport<F> {
    pub fn new(_: F) -> Self {
        Self(PhantomData)
    }
}

impl<T: Real, F: FaceValue> Equation<T, 1, 3> for Transport<F> {
    const IS_LIGHT: bool = false;

    fn name(&self) -> &'static str {
        "advection"
    }

    #[inline(always)]
    fn rate<V: Pack<Scalar = T>, const R: usize, const K: usize>(
        &self,
        [u]: [At<'_, V, R, K>; 1],
        velocity: [At<'_, V, R, K>; 3],
        _: T,
    ) -> [V; 1] {
        let mut rate = divergence::<T, F, V, R, K>(u, velocity[0], 0);
        for axis in 1..3 {
            if axis < u.axes() {
                rate = rate + divergence::<T, F, V, R, K>(u, velocity[axis], axis);
            }
        }
        [-rate]
    }
}

/// `d(v u)/dx` along an axis.
#[inline(always)]
fn divergence<T: Real, F: FaceValue, V: Pack<Scalar = T>, const R: usize, const K: usize>(
    u: At<'_, V, R, K>,
    v: At<'_, V, R, K>,
    axis: usize,
) -> V {
    let ahead = flux::<T, F, V, R, K>(u, v, axis, 1);
    let behind = flux::<T, F, V, R, K>(u, v, axis, 0);
    (ahead - behind) * u.per_spacing(axis)
}

/// `v u` on the face before point `face`, from upstream.
#[inline(always)]
fn flux<T: Real, F: FaceValue, V: Pack<Scalar = T>, const R: usize, const K: usize>(
    u: At<'_, V, R, K>,
    v: At<'_, V, R, K>,
    axis: usize,
    face: isize,
) -> V {
    let mut points = [u.here(); 6];
    for n in 0..6 {
        points[n] = u.shifted(axis, face - 3 + n as isize);
    }
    let [a, b, c, d, e, f] = points;
    let (left, right) = (F::value([a, b, c, d, e]), F::value([f, e, d, c, b]));
    let speed = (v.shifted(axis, face) + v.shifted(axis, face - 1)) * T::of(0.5);
    let forth = (speed + speed.abs()) * T::of(0.5);
    let back = (speed - speed.abs()) * T::of(0.5);
    forth * left + back * right
}

/// Advection, and how it is solved.
#[derive(Clone, Debug)]
pub struct Advection {
    /// How values on faces are made.
    pub face: Face,
    /// How time is stepped.
    pub integrator: Integrator,
    /// What holds on the boundary.
    pub boundary: Boundary,
}

impl Advection {
    /// Longest stable time step, s, of the linear scheme with the largest speeds, m/s, along the axes: by
    /// the amplification of waves. WENO schemes are taken for the linear one of their order.
    ///
    /// # Errors
    /// As [`Advection::model`].
    pub fn time_step_limit(&self, mesh: &Mesh, speeds: [f64; 3]) -> Result<f64, FdError> {
        stability::check_mesh(mesh, Order::Sixth)?;
        let spacing = mesh.spacing();
        let rate: f64 = (0..mesh.dims()).map(|a| speeds[a].abs() / spacing[a]).sum();
        Ok(stability::advection_limit(self.face, self.integrator)? / rate)
    }

    /// A model that starts from `start`, in a velocity, m/s, that is given as a function of the position,
    /// m, and does not change. Along every axis the velocity should not vary in that direction: fluxes are
    /// exact in second order where it does.
    ///
    /// # Errors
    /// As [`crate::Heat::model`].
    pub fn model<T: Compiled>(
        &self,
        mesh: &Mesh,
        time_step: f64,
        velocity: &dyn Fn([f64; 3]) -> [f64; 3],
        start: Given<'_>,
    ) -> Result<Fd<T>, FdError> {
        let mut fastest = [0.0f64; 3];
        for position in mesh.positions() {
            let v = velocity(position);
            for a in 0..3 {
                fastest[a] = fastest[a].max(v[a].abs());
            }
        }
        let limit = self.time_step_limit(mesh, fastest)?;
        let scheme = format!("{} and {}", self.integrator.name(), self.face.name());
        stability::check_time_step(time_step, limit, scheme)?;
        let mut builder = Builder::<T, 1, 3>::new(mesh, [&self.boundary], Order::Sixth)?;
        builder.start([("quantity", start)])?;
        let component = |a: usize| move |x: [f64; 3]| velocity(x)[a];
        builder.given([
            ("velocity_x", &component(0)),
            ("velocity_y", &component(1)),
            ("velocity_z", &component(2)),
        ])?;
        let pace = Box::new(FixedPace(time_step));
        builder.first_order("advection", self.integrator, pace, |builder, form| {
            T::advection(builder, self.face, form)
        })
    }
}
