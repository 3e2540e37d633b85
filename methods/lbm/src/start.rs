//! The flow at the beginning.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;
use pulp::Scalar;

use crate::acceleration::Acceleration;
use crate::collision::Collide;
use crate::error::LbmError;
use crate::lattice::Lattice;
use crate::physics::Fluid;
use crate::relaxation::Relaxation;

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

impl Start {
    /// From a velocity, without pressure differences.
    pub fn with_velocity(velocity: impl Fn([f64; 3]) -> [f64; 3] + 'static) -> Self {
        Self { velocity: Box::new(velocity), ..Self::default() }
    }

    /// The populations of a site after its first collision, beyond the weights.
    ///
    /// Before it they are the equilibrium and what goes with the rate of strain and the force in
    /// first order of the relaxation time (Chapman & Enskog; Skordos 1993): its momentum is
    /// `-F / 2`, its stress `-2 rho c_s^2 tau S - (u F + F u) / 2`.
    pub(crate) fn populations<L: Lattice<Q>, C: Collide<T>, T: Real, const Q: usize>(
        &self,
        collision: &C,
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
        let pack = |x: T| T::Pack::<Scalar>::splat(Scalar, x);
        let packs = f.map(pack);
        let omega = relaxation.rate::<L, _, Q>(&packs);
        let packs = collision.collide::<L, _, Q>(packs, a.map(|a| pack(T::of(a))), omega);
        for q in 0..Q {
            packs[q].store(std::slice::from_mut(&mut f[q]));
        }
        Ok(f)
    }
}
