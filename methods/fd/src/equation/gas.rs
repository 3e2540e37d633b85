//! Euler's equations of an ideal gas: density, momentum and energy are carried along, and pressure pushes.
//!
//! Fluxes are taken apart into families of waves, and each family is split by its largest speed nearby and
//! reconstructed by itself, by WENO of fifth order (Jiang & Shu 1996; Shu 1998, Lect. Notes Math. 1697; weights of
//! Borges et al. 2008). Density, momentum and energy have the steps of all families: where these have not parted yet
//! every parabola has a step in it, and what is made of them oscillates. Where the sum would leave a point without
//! density or pressure, as much as needed of the flux of first order takes its place (Hu, Adams & Shu 2013, J. Comput.
//! Phys. 242), so that none ever becomes negative.

mod waves;

use finegrain_framework::pack::Pack;
use finegrain_framework::space::Grid;
use finegrain_framework::{Fault, Integrator, Pace, Pacing, Real, Stage, State, Whole};

use self::waves::{Side, Waves};
use super::Equation;
use crate::around::At;
use crate::boundary::{Boundary, Condition};
use crate::error::{FdError, positive};
use crate::mesh::Mesh;
use crate::model::{Builder, Compiled, Fd};
use crate::operator::Order;
use crate::operator::face::{Weno5Z, split};
use crate::sweep::Form;

/// Of density and pressure after a step with the flux of first order, what that of fifth order leaves at
/// least.
const LEAST: f64 = 1e-3;

/// Right-hand side for density, momentum in `F - 2` directions, and energy.
pub(crate) struct Conservation<T> {
    pub heat_ratio: T,
}

impl<T: Real, const F: usize> Equation<T, F, 0> for Conservation<T> {
    const IS_LIGHT: bool = false;

    fn name(&self) -> &'static str {
        "Euler's equations"
    }

    #[inline(always)]
    fn rate<V: Pack<Scalar = T>, const R: usize, const K: usize>(
        &self,
        u: [At<'_, V, R, K>; F],
        []: [At<'_, V, R, K>; 0],
        dt: T,
    ) -> [V; F] {
        let mut rate = [u[0].here().splat_like(T::zero()); F];
        for axis in 0..F - 2 {
            let ahead = self.flux(u, axis, 1, dt);
            let behind = self.flux(u, axis, 0, dt);
            for f in 0..F {
                rate[f] = rate[f] - (ahead[f] - behind[f]) * u[0].per_spacing(axis);
            }
        }
        rate
    }
}

/// How a gas flows along an axis.
#[derive(Clone, Copy)]
struct Flow<V, const F: usize> {
    flux: [V; F],
    velocity: V,
    sound: V,
}

impl<T: Real> Conservation<T> {
    #[inline(always)]
    fn pressure<V: Pack<Scalar = T>, const F: usize>(&self, u: [V; F]) -> V {
        let mut squared = u[1] * u[1];
        for f in 2..F - 1 {
            squared = squared + u[f] * u[f];
        }
        let kinetic = squared * T::of(0.5) / u[0];
        (u[F - 1] - kinetic) * (self.heat_ratio - T::one())
    }

    #[inline(always)]
    fn flow<V: Pack<Scalar = T>, const F: usize>(&self, u: [V; F], axis: usize) -> Flow<V, F> {
        let (pressure, velocity) = (self.pressure(u), u[1 + axis] / u[0]);
        let mut flux = u;
        for f in 0..F {
            flux[f] = u[f] * velocity;
        }
        flux[1 + axis] = flux[1 + axis] + pressure;
        flux[F - 1] = flux[F - 1] + pressure * velocity;
        let sound = (pressure * self.heat_ratio / u[0]).sqrt();
        Flow { flux, velocity, sound }
    }

    /// On the face before point `face`.
    #[inline(always)]
    fn flux<V: Pack<Scalar = T>, const R: usize, const K: usize, const F: usize>(
        &self,
        u: [At<'_, V, R, K>; F],
        axis: usize,
        face: isize,
        dt: T,
    ) -> [V; F] {
        let here = u[0].here();
        let mut points = [[here; F]; 6];
        let mut flows = [Flow { flux: [here; F], velocity: here, sound: here }; 6];
        for n in 0..6 {
            for f in 0..F {
                points[n][f] = u[f].shifted(axis, face - 3 + n as isize);
            }
            flows[n] = self.flow(points[n], axis);
        }
        let left = Side { unknowns: points[2], sound: flows[2].sound };
        let right = Side { unknowns: points[3], sound: flows[3].sound };
        let waves = Waves::between(left, right, axis, self.heat_ratio);
        let (mut states, mut fluxes) = (points, points);
        let (mut fastest, mut speeds) =
            (here.splat_like(T::zero()), [here.splat_like(T::zero()); F]);
        for n in 0..6 {
            let Flow { flux, velocity, sound } = flows[n];
            states[n] = waves.strengths(points[n]);
            fluxes[n] = waves.strengths(flux);
            fastest = fastest.max(velocity.abs() + sound);
            let speed = waves.speeds(velocity, sound);
            for f in 0..F {
                speeds[f] = speeds[f].max(speed[f].abs());
            }
        }
        let (mut high, mut low) = ([here; F], [here; F]);
        for f in 0..F {
            let (mut state, mut flux) = ([here; 6], [here; 6]);
            for n in 0..6 {
                state[n] = states[n][f];
                flux[n] = fluxes[n][f];
            }
            high[f] = split::<V, Weno5Z>(state, flux, speeds[f]);
            let jump = fastest * (points[3][f] - points[2][f]);
            low[f] = (flows[2].flux[f] + flows[3].flux[f] - jump) * T::of(0.5);
        }
        high = waves.sum(high);
        // Each side's share of a step in which only this face counts.
        let share = u[0].per_spacing(axis) * (dt * T::of(2.0 * (F - 2) as f64));
        self.limit(points[2], low, &mut high, -share);
        self.limit(points[3], low, &mut high, share);
        high
    }

    /// Takes as much of `low` into `high` as point `u` needs, which changes by `share` times the flux.
    #[inline(always)]
    fn limit<V: Pack<Scalar = T>, const F: usize>(
        &self,
        u: [V; F],
        low: [V; F],
        high: &mut [V; F],
        share: V,
    ) {
        let safe = after(u, low, share);
        let density = after(u, *high, share)[0];
        blend(low, high, part(safe[0], density));
        let pressure = self.pressure(after(u, *high, share));
        blend(low, high, part(self.pressure(safe), pressure));
    }
}

/// A point that changes by `share` times a flux.
#[inline(always)]
fn after<V: Pack, const F: usize>(u: [V; F], flux: [V; F], share: V) -> [V; F] {
    let mut after = u;
    for f in 0..F {
        after[f] = u[f] + flux[f] * share;
    }
    after
}

/// How much of the way from a safe value to another can be gone until [`LEAST`] of it is left.
#[inline(always)]
fn part<V: Pack>(safe: V, other: V) -> V {
    let zero = safe.splat_like(V::Scalar::of(0.0));
    let one = safe.splat_like(V::Scalar::of(1.0));
    // Where the other value is the greater all of the way can be gone: the quotient is huge then.
    let falls = (safe - other).max(safe * V::Scalar::of(1e-6));
    (safe * V::Scalar::of(1.0 - LEAST) / falls).min(one).max(zero)
}

#[inline(always)]
fn blend<V: Pack, const F: usize>(low: [V; F], high: &mut [V; F], part: V) {
    for f in 0..F {
        high[f] = low[f] + (high[f] - low[f]) * part;
    }
}

/// An ideal gas at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GasState {
    /// Density, kg/m^3.
    pub density: f64,
    /// Velocity, m/s.
    pub velocity: [f64; 3],
    /// Pressure, Pa.
    pub pressure: f64,
}

/// What a gas meets at an end of an axis that is not periodic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GasEnd {
    /// More of the same: what gets there leaves.
    Open,
    /// A wall along which it slides.
    Wall,
}

/// An ideal gas without viscosity, in 1 or 2 directions, and how it is stepped: by SSP-RK3, as fast as
/// its waves allow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gas {
    /// Ratio of the specific heats.
    pub heat_ratio: f64,
    /// Courant number: how far, in spacings and times the number of directions, the fastest wave goes in a
    /// step. At most 1/2, with which density and pressure stay positive.
    pub courant: f64,
    /// What it meets at the lower and upper ends of x and y.
    pub ends: [[GasEnd; 2]; 2],
}

/// Makes the stage of a gas from its ratio of specific heats.
type MakeStage<T, const F: usize> =
    fn(&Builder<'_, T, F, 0>, f64, Form) -> Result<Stage<Grid>, FdError>;

impl Gas {
    /// Largest Courant number with which positive stays positive (Hu et al. 2013, section 2.2).
    pub const LARGEST_COURANT: f64 = 0.5;

    /// A model that starts from a gas as a function of the position, m.
    ///
    /// # Errors
    /// If a number is outside its valid range, the mesh has too few points or is not of 1 or 2
    /// directions, or the gas at the beginning has no density or pressure.
    pub fn model<T: Compiled>(
        &self,
        mesh: &Mesh,
        start: &dyn Fn([f64; 3]) -> GasState,
    ) -> Result<Fd<T>, FdError> {
        positive("courant", self.courant)?;
        if self.courant > Self::LARGEST_COURANT {
            let range = "at most 0.5: with more, density or pressure may become negative";
            return Err(FdError::OutOfRange { name: "courant", value: self.courant, range });
        }
        if !(self.heat_ratio > 1.0 && self.heat_ratio.is_finite()) {
            let range = "finite and above 1";
            return Err(FdError::OutOfRange { name: "heat_ratio", value: self.heat_ratio, range });
        }
        for position in mesh.positions() {
            let state = start(position);
            for (field, value) in [("density", state.density), ("pressure", state.pressure)] {
                if !(value > 0.0 && value.is_finite()) {
                    let range = "finite and above zero";
                    return Err(FdError::Start { field, position, value, range });
                }
            }
        }
        match mesh.dims() {
            1 => self.build::<T, 3>(mesh, start, T::gas_in_line),
            2 => self.build::<T, 4>(mesh, start, T::gas_in_plane),
            dims => {
                let (name, range) = ("number of directions of a gas", "1 or 2");
                Err(FdError::OutOfRange { name, value: dims as f64, range })
            }
        }
    }

    fn build<T: Compiled, const F: usize>(
        &self,
        mesh: &Mesh,
        start: &dyn Fn([f64; 3]) -> GasState,
        stage: MakeStage<T, F>,
    ) -> Result<Fd<T>, FdError> {
        let boundaries: [Boundary; F] = std::array::from_fn(|f| self.boundary(f));
        let mut builder = Builder::<T, F, 0>::new(mesh, boundaries.each_ref(), Order::Sixth)?;
        let values: [_; F] = std::array::from_fn(|f| move |x| self.conserved(start(x), f, F));
        let names = ["density", "momentum_x", "momentum_y"];
        let name = |f: usize| if f == F - 1 { "energy" } else { names[f] };
        builder.start(std::array::from_fn(|f| (name(f), &values[f] as _)))?;
        let fields = builder.unknowns().to_vec();
        let speeds = Speeds { heat_ratio: self.heat_ratio, spacing: mesh.spacing(), fields };
        let pacing = Box::new(CourantPace { courant: self.courant, speeds });
        builder.first_order("gas", Integrator::SspRk3, pacing, |builder, form| {
            stage(builder, self.heat_ratio, form)
        })
    }

    /// What holds for unknown `f` at the ends: at walls all is even but the momentum towards them.
    fn boundary(&self, f: usize) -> Boundary {
        let mut boundary = Boundary::all(Condition::Outflow);
        for (axis, ends) in self.ends.iter().enumerate() {
            for (condition, end) in boundary.0[axis].iter_mut().zip(ends) {
                *condition = match end {
                    GasEnd::Open => Condition::Outflow,
                    GasEnd::Wall if f == 1 + axis => Condition::dirichlet(0.0),
                    GasEnd::Wall => Condition::neumann(0.0),
                };
            }
        }
        boundary
    }

    /// Unknown `f` of `count` of a gas.
    fn conserved(&self, gas: GasState, f: usize, count: usize) -> f64 {
        let GasState { density, velocity, pressure } = gas;
        match f {
            0 => density,
            f if f == count - 1 => {
                let squared: f64 = velocity[..count - 2].iter().map(|u| u * u).sum();
                pressure / (self.heat_ratio - 1.0) + 0.5 * density * squared
            }
            f => density * velocity[f - 1],
        }
    }
}

/// How fast waves cross spacings.
struct Speeds<T: Real> {
    heat_ratio: f64,
    spacing: [f64; 3],
    fields: Vec<State<T>>,
}

impl<T: Compiled> Speeds<T> {
    /// The largest speed of a wave over the spacing, 1/s, of all points and axes.
    fn fastest(&self, whole: &mut Whole<'_, Grid>) -> f64 {
        let [fastest] = whole.max(|near| {
            let rows: Vec<_> = self.fields.iter().map(|&f| near.rows(f)).collect();
            let mut fastest = 0.0f64;
            for (j, k) in near.sub_domain().rows() {
                let row: Vec<_> = rows.iter().map(|r| r.row(j as isize, k as isize)).collect();
                for x in 0..row[0].len() {
                    let at = |f: usize| row[f][x].as_f64();
                    let (density, energy) = (at(0), at(row.len() - 1));
                    let momentum = |axis: usize| at(1 + axis);
                    let squared: f64 = (0..row.len() - 2).map(|a| momentum(a).powi(2)).sum();
                    let pressure = (self.heat_ratio - 1.0) * (energy - 0.5 * squared / density);
                    let sound = (self.heat_ratio * pressure / density).sqrt();
                    for axis in 0..row.len() - 2 {
                        let speed = ((momentum(axis) / density).abs() + sound) / self.spacing[axis];
                        fastest = if speed > fastest || speed.is_nan() { speed } else { fastest };
                    }
                }
            }
            [fastest]
        });
        fastest
    }
}

/// Steps in which the fastest wave goes as far as the Courant number says.
struct CourantPace<T: Real> {
    courant: f64,
    speeds: Speeds<T>,
}

impl<T: Compiled> Pacing<Grid> for CourantPace<T> {
    fn pace(&mut self, whole: &mut Whole<'_, Grid>) -> Result<Pace, Fault> {
        let directions = self.speeds.fields.len() - 2;
        let dt = self.courant / (self.speeds.fastest(whole) * directions as f64);
        if dt > 0.0 && dt.is_finite() {
            Ok(Pace { dt, steps: 1 })
        } else {
            Err(Fault::new(format!(
                "the time step comes to {dt} s: density or pressure is not a number above zero somewhere"
            )))
        }
    }
}
