//! The flow at the beginning.

use finegrain_framework::pack::MOST_LANES;
use finegrain_framework::{Columns, Real, State};

use crate::acceleration::Acceleration;
use crate::around::wrap;
use crate::error::LbmError;
use crate::in_place;
use crate::kernel::Slots;
use crate::lattice::{Lattice, opposite};
use crate::physics::{Fluid, Streaming};
use crate::relaxation::Relaxation;
use crate::row::{Group, Local};

/// A function of the position, m.
type Given<R> = Box<dyn Fn([f64; 3]) -> R>;

/// The flow at the beginning; at rest without pressure differences by default.
pub struct Start {
    /// Velocity, m/s; smooth, because populations follow from its gradient, too.
    pub velocity: Given<[f64; 3]>,
    /// Pressure beyond that of the reference density, Pa.
    pub pressure: Given<f64>,
}

impl Default for Start {
    fn default() -> Self {
        Self { velocity: Box::new(|_| [0.0; 3]), pressure: Box::new(|_| 0.0) }
    }
}

/// What the populations at the beginning follow from, besides.
pub(crate) struct Setting<'a, T, const Q: usize> {
    pub relaxation: &'a Relaxation,
    pub fluid: &'a Fluid,
    pub local: &'a Local<T, Q>,
    pub streaming: Streaming,
}

impl Start {
    /// From a velocity, without pressure differences.
    pub fn with_velocity(velocity: impl Fn([f64; 3]) -> [f64; 3] + 'static) -> Self {
        Self { velocity: Box::new(velocity), ..Self::default() }
    }

    /// Fills in the populations after the first collision of the sites that are in no body.
    pub(crate) fn fill<L: Lattice<Q>, T: Real, const Q: usize>(
        &self,
        setting: &Setting<'_, T, Q>,
        solid: &[u8],
        columns: &mut Columns,
        populations: &[State<T>],
    ) -> Result<(), LbmError> {
        let Setting { relaxation, fluid, local, streaming } = setting;
        let acceleration = &local.acceleration;
        let [nx, ny, nz] = acceleration.mesh.shape;
        let site = |point: usize| [point % nx, point / nx % ny, point / (nx * ny)];
        let fluid_sites: Vec<_> = (0..solid.len()).filter(|&point| solid[point] == 0).collect();
        let mut sites: [Group<T>; Q] = [[T::zero(); MOST_LANES]; Q];
        let mut here: [Group<T>; 3] = [[T::zero(); MOST_LANES]; 3];
        for points in fluid_sites.chunks(MOST_LANES) {
            for (place, &point) in points.iter().enumerate() {
                let f =
                    self.populations::<L, T, Q>(relaxation, fluid, acceleration, site(point))?;
                for q in 0..Q {
                    sites[q][place] = f[q];
                }
                let given = acceleration.at(site(point), 0.0);
                for a in 0..3 {
                    here[a][place] = T::of(given[a]);
                }
            }
            let acceleration = Some(here.each_ref().map(|a| &a[..]));
            let mut rows = sites.each_mut().map(|f| &mut f[..]);
            local.collider.exchange(Slots::of_group(&mut rows), acceleration);
            for q in 0..Q {
                let kept = match streaming {
                    Streaming::TwoGrids => [0; 3],
                    Streaming::InPlace => in_place::kept(L::VELOCITIES[q], q),
                };
                let values = columns.values_mut(populations[q]);
                for (f, &point) in sites[opposite(q)].iter().zip(points) {
                    let [x, y, z] = site(point);
                    let (x, y) = (wrap(x as i32 + kept[0], nx), wrap(y as i32 + kept[1], ny));
                    values[(wrap(z as i32 + kept[2], nz) * ny + y) * nx + x] = *f;
                }
            }
        }
        Ok(())
    }

    /// The populations of a site before its first collision, beyond the weights.
    ///
    /// They are the equilibrium and what goes with the rate of strain and the force in
    /// first order of the relaxation time (Chapman & Enskog; Skordos 1993): its momentum is
    /// `-F / 2`, its stress `-2 rho c_s^2 tau S - (u F + F u) / 2`.
    fn populations<L: Lattice<Q>, T: Real, const Q: usize>(
        &self,
        relaxation: &Relaxation,
        fluid: &Fluid,
        acceleration: &Acceleration,
        site: [usize; 3],
    ) -> Result<[T; Q], LbmError> {
        let mesh = &acceleration.mesh;
        let position = mesh.position(site.map(|i| i as isize));
        let unit = mesh.unit_velocity();
        let velocity = |x: [f64; 3]| (self.velocity)(x).map(|u| u / unit);
        let u = velocity(position);
        let excess = (self.pressure)(position) / (fluid.density * unit * unit) * 3.0;
        if !u.iter().all(|u| u.is_finite()) {
            return Err(LbmError::Start { field: "velocity", position });
        }
        if !excess.is_finite() {
            return Err(LbmError::Start { field: "pressure", position });
        }
        let density = 1.0 + excess;
        let a = acceleration.at(site, 0.0);
        let mut gradient = [[0.0; 3]; 3];
        for b in 0..L::DIMS {
            let shifted = |by: f64| {
                let mut x = position;
                x[b] += by * mesh.spacing;
                velocity(x)
            };
            let (ahead, behind) = (shifted(0.5), shifted(-0.5));
            gradient[b] = [0, 1, 2].map(|a| ahead[a] - behind[a]);
        }
        let mut strain = [[0.0; 3]; 3];
        for i in 0..L::DIMS {
            strain[i] = [0, 1, 2].map(|j| 0.5 * (gradient[i][j] + gradient[j][i]));
        }
        let tau = relaxation.time_at(&strain);
        let mut f = [T::zero(); Q];
        for q in 0..Q {
            let c = L::VELOCITIES[q].map(f64::from);
            let along = |v: [f64; 3]| c[0] * v[0] + c[1] * v[1] + c[2] * v[2];
            let speed = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
            let quadratic = 3.0 * along(u) + 4.5 * along(u).powi(2) - 1.5 * speed;
            let mut stress = 0.0;
            for i in 0..L::DIMS {
                for j in 0..L::DIMS {
                    let tensor = c[i] * c[j] - if i == j { 1.0 / 3.0 } else { 0.0 };
                    let forcing = 0.5 * (u[i] * a[j] + u[j] * a[i]);
                    stress += tensor * density * (-2.0 / 3.0 * tau * strain[i][j] - forcing);
                }
            }
            let beyond = -1.5 * density * along(a) + 4.5 * stress;
            f[q] = T::of(L::WEIGHTS[q] * (excess + density * quadratic + beyond));
        }
        Ok(f)
    }
}
