//! How fast the stress relaxes: by the viscosity, and by that of eddies which the mesh does not hold.

use std::f64::consts::SQRT_2;

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use crate::flow;
use crate::lattice::Lattice;

/// The relaxation of the stress, in lattice units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relaxation {
    /// Relaxation time of the fluid's own viscosity, in time steps.
    pub time: f64,
    /// Smagorinsky's constant (Smagorinsky 1963), if there are eddies: their viscosity is
    /// `C^2 |S|` with `|S| = sqrt(2 S : S)`.
    pub smagorinsky: Option<f64>,
}

impl Relaxation {
    /// Relaxation time where the rate of strain is `strain`, per time step.
    pub fn time_at(&self, strain: &[[f64; 3]; 3]) -> f64 {
        let squared: f64 = strain.iter().flatten().map(|s| s * s).sum();
        let constant = self.smagorinsky.unwrap_or_default();
        self.time + 3.0 * constant * constant * (2.0 * squared).sqrt()
    }

    /// Relaxation rate at a pack of sites. With eddies the rate of strain is that of the stress beyond
    /// equilibrium, which the whole viscosity makes (Hou, Sterling, Chen & Doolen 1996):
    /// `tau^2 - tau_0 tau = 9 C^2 sqrt(Pi : Pi / 2) / rho`, for `|S| = 3 sqrt(Pi : Pi / 2) / (rho tau)`.
    #[inline(always)]
    pub fn rate<L: Lattice<Q>, V: Pack, const Q: usize>(&self, f: &[V; Q]) -> V {
        let Some(constant) = self.smagorinsky else {
            return f[0].splat_like(V::Scalar::of(1.0 / self.time));
        };
        let (excess, velocity) = flow::velocity::<L, V, Q>(f);
        let stress = flow::stress::<L, V, Q>(f, excess, &velocity);
        let mut squared = excess.splat_like(V::Scalar::of(0.0));
        for a in 0..L::DIMS {
            for b in a..L::DIMS {
                let times = V::Scalar::of(if a == b { 1.0 } else { 2.0 });
                squared = squared + stress[a][b] * stress[a][b] * times;
            }
        }
        let eddies = V::Scalar::of(18.0 * SQRT_2 * constant * constant);
        let density = excess + V::Scalar::of(1.0);
        let root = squared.sqrt() * eddies / density + V::Scalar::of(self.time * self.time);
        // Of both roots the one above zero, as a rate.
        excess.splat_like(V::Scalar::of(2.0)) / (root.sqrt() + V::Scalar::of(self.time))
    }
}

#[cfg(test)]
mod tests {
    use finegrain_framework::pack::PackF64;
    use pulp::Scalar;

    use super::*;
    use crate::lattice::D3Q19;

    /// The stress that the whole viscosity makes of a rate of strain tells both apart again.
    #[test]
    fn the_time_from_the_stress_is_that_of_the_strain() {
        let strain = [[2e-3, 1e-3, -3e-3], [1e-3, -1.5e-3, 5e-4], [-3e-3, 5e-4, -5e-4]];
        let relaxation = Relaxation { time: 0.51, smagorinsky: Some(0.17) };
        let time = relaxation.time_at(&strain);
        // 1/2 + 3 (nu + C^2 |S|), with |S| from the squares of the components.
        let s = (2.0f64 * (4.0 + 2.25 + 0.25 + 2.0 * (1.0 + 9.0 + 0.25)) * 1e-6).sqrt();
        assert!((time - (0.51 + 3.0 * 0.17 * 0.17 * s)).abs() < 1e-15);
        // -2 rho c_s^2 tau S, at rest and at a density of 1.02, in second Hermite polynomials.
        let f: [f64; 19] = std::array::from_fn(|q| {
            let c = D3Q19::VELOCITIES[q].map(f64::from);
            let mut sum = 0.02;
            for a in 0..3 {
                for b in 0..3 {
                    let delta = if a == b { 1.0 / 3.0 } else { 0.0 };
                    sum -= 4.5 * (c[a] * c[b] - delta) * 2.0 / 3.0 * 1.02 * time * strain[a][b];
                }
            }
            D3Q19::WEIGHTS[q] * sum
        });
        let packs = f.map(|f| PackF64::splat(Scalar, f));
        let rate = relaxation.rate::<D3Q19, _, 19>(&packs).vector();
        assert!((1.0 / rate - time).abs() < 1e-14, "{} {time}", 1.0 / rate);
        let alone = Relaxation { smagorinsky: None, ..relaxation };
        assert_eq!(alone.rate::<D3Q19, _, 19>(&packs).vector(), 1.0 / 0.51);
    }
}
