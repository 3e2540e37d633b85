//! How fast the stress relaxes: by the viscosity, and by that of eddies which the mesh does not hold.

use finegrain_framework::Real;
use finegrain_framework::pack::Pack;

use crate::flow;
use crate::lattice::Lattice;

/// The relaxation of the stress, in lattice units.
///
/// Eddies have the viscosity `nu_e = C^2 |S|` with `|S| = sqrt(2 S : S)` (Smagorinsky 1963), which goes with that of
/// the fluid to `sqrt(nu^2 + nu_e^2)` (cf. Meyers & Sagaut 2006, J. Fluid Mech. 569): where a mesh holds the flow, so
/// that `|S| / nu`, the Reynolds number of a cell, is small against `1 / C^2`, they add but the part `(nu_e / nu)^2 / 2`
/// of it, which falls with the fourth power of the spacing. The larger of both would add nothing there,
/// but its kink makes layers of shear roll up where there are no vortices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Relaxation {
    /// Relaxation time of the fluid's own viscosity, in time steps.
    pub time: f64,
    /// Smagorinsky's constant, if there are eddies.
    pub smagorinsky: Option<f64>,
}

impl Relaxation {
    /// Relaxation time where the rate of strain is `strain`, per time step.
    pub fn time_at(&self, strain: &[[f64; 3]; 3]) -> f64 {
        let Some(constant) = self.smagorinsky else { return self.time };
        let squared: f64 = strain.iter().flatten().map(|s| s * s).sum();
        let eddies = 3.0 * constant * constant * (2.0 * squared).sqrt();
        0.5 + (self.time - 0.5).hypot(eddies)
    }

    /// Relaxation rate at a pack of sites. With eddies the rate of strain is that of the stress beyond equilibrium,
    /// `|S| = 3 sqrt(Pi : Pi / 2) / (rho tau)` (Hou, Sterling, Chen & Doolen 1996), with the relaxation time of the fluid
    /// alone: where eddies have a viscosity that counts, both times are next to 1/2.
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
        // `(3 nu)^2`, and `(3 nu_e)^2` over `Pi : Pi / rho^2`.
        let viscous = V::Scalar::of((self.time - 0.5).powi(2));
        let eddies = V::Scalar::of((9.0 * constant * constant / self.time).powi(2) / 2.0);
        let [half, one] = [0.5, 1.0].map(V::Scalar::of);
        let per_density = excess.splat_like(one) / (excess + one);
        let time = (squared * per_density * per_density * eddies + viscous).sqrt() + half;
        excess.splat_like(one) / time
    }
}

#[cfg(test)]
mod tests {
    use finegrain_framework::pack::PackF64;
    use pulp::Scalar;

    use super::*;
    use crate::lattice::D3Q19;

    #[test]
    fn the_time_from_the_stress_is_that_of_the_strain() {
        let strain = [[2e-3, 1e-3, -3e-3], [1e-3, -1.5e-3, 5e-4], [-3e-3, 5e-4, -5e-4]];
        let relaxation = Relaxation { time: 0.5002, smagorinsky: Some(0.17) };
        let time = relaxation.time_at(&strain);
        // 1/2 + 3 sqrt(nu^2 + (C^2 |S|)^2), with |S| from the squares of the components.
        let s = (2.0f64 * (4.0 + 2.25 + 0.25 + 2.0 * (1.0 + 9.0 + 0.25)) * 1e-6).sqrt();
        let expected = 0.5 + (2e-4f64.powi(2) + (3.0 * 0.17 * 0.17 * s).powi(2)).sqrt();
        assert!((time - expected).abs() < 1e-15);
        // -2 rho c_s^2 tau S, at rest and at a density of 1.02, in second Hermite polynomials.
        let f: [f64; 19] = std::array::from_fn(|q| {
            let c = D3Q19::VELOCITIES[q].map(f64::from);
            let mut sum = 0.02;
            for a in 0..3 {
                for b in 0..3 {
                    let delta = if a == b { 1.0 / 3.0 } else { 0.0 };
                    sum -= 4.5 * (c[a] * c[b] - delta) * 2.0 / 3.0 * 1.02 * 0.5002 * strain[a][b];
                }
            }
            D3Q19::WEIGHTS[q] * sum
        });
        let packs = f.map(|f| PackF64::splat(Scalar, f));
        let rate = relaxation.rate::<D3Q19, _, 19>(&packs).vector();
        assert!((1.0 / rate - time).abs() < 1e-14, "{} {time}", 1.0 / rate);
        let alone = Relaxation { smagorinsky: None, ..relaxation };
        assert_eq!(alone.rate::<D3Q19, _, 19>(&packs).vector(), 1.0 / 0.5002);
    }
}
