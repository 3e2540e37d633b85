//! Scalar quantities of the flow, as deterministic reductions.

use finegrain_framework::Real;
use finegrain_framework::Whole;
use finegrain_framework::space::Grid;

use crate::around::Around;
use crate::model::Parts;

/// Integrals over the sites of the fluid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals {
    /// Volume, m^3 (m^2 in 2-D): that of the cells of all sites in the fluid.
    pub volume: f64,
    /// Mass, kg (kg/m).
    pub mass: f64,
    /// Mass beyond that of the reference density: what is kept to round-off, where `mass` rounds.
    pub excess_mass: f64,
    /// Integral of the velocity over the volume, m^4/s (m^3/s).
    pub flow: [f64; 3],
    /// Momentum, kg m/s.
    pub momentum: [f64; 3],
    /// Kinetic energy, J.
    pub kinetic_energy: f64,
}

/// Sums up the fluid. The derived fields must be up to date
/// ([`finegrain_framework::Simulation::derive`]).
pub fn totals<T: Real>(whole: &mut Whole<'_, Grid>, parts: &Parts<T>) -> Totals {
    let Parts { fields, mesh, lattice, density, streaming, .. } = parts;
    let velocities = lattice.velocities();
    let sums = whole.sum(|near| {
        let views: Vec<_> = fields.populations.iter().map(|&f| near.state(f)).collect();
        let velocity: Vec<_> = fields.velocity.iter().map(|&v| near.rate_rows(v)).collect();
        let solid = near.rows(fields.solid);
        let mut sums = [0.0; 9];
        for (j, k) in near.sub_domain().rows() {
            let at = (j as isize, k as isize);
            let solid = solid.row(at.0, at.1);
            let around = Around::new(near, &views, velocities, *streaming, (j, k));
            for x in (0..solid.len()).filter(|&x| solid[x] == 0) {
                let leaving = |q| around.at(q, x, [0; 3]).as_f64();
                let excess: f64 = (0..velocities.len()).map(leaving).sum();
                sums[0] += 1.0;
                sums[1] += excess;
                for (a, velocity) in velocity.iter().enumerate() {
                    let u = velocity.row(at.0, at.1)[x].as_f64();
                    sums[2 + a] += u;
                    sums[5 + a] += (1.0 + excess) * u;
                    sums[8] += 0.5 * (1.0 + excess) * u * u;
                }
            }
        }
        sums
    });
    let cell = mesh.cell_volume(lattice.dims());
    Totals {
        volume: sums[0] * cell,
        mass: (sums[0] + sums[1]) * density * cell,
        excess_mass: sums[1] * density * cell,
        flow: [sums[2], sums[3], sums[4]].map(|u| u * cell),
        momentum: [sums[5], sums[6], sums[7]].map(|u| u * density * cell),
        kinetic_energy: sums[8] * density * cell,
    }
}

/// Largest speed of any site, m/s; the derived fields must be up to date.
pub fn largest_speed<T: Real>(whole: &mut Whole<'_, Grid>, parts: &Parts<T>) -> f64 {
    let [squared] = whole.max(|near| {
        let velocity: Vec<_> = parts.fields.velocity.iter().map(|&v| near.rate_rows(v)).collect();
        let mut most = 0.0f64;
        for (j, k) in near.sub_domain().rows() {
            for x in 0..near.domain().shape()[0] {
                let speed: f64 = velocity
                    .iter()
                    .map(|v| v.row(j as isize, k as isize)[x].as_f64().powi(2))
                    .sum();
                most = if speed > most || speed.is_nan() { speed } else { most };
            }
        }
        [most]
    });
    squared.sqrt()
}

/// Pressures of sites, Pa; 0 in bodies. The derived fields must be up to date.
pub fn pressures<T: Real, const N: usize>(
    whole: &mut Whole<'_, Grid>,
    parts: &Parts<T>,
    sites: &[[usize; 3]; N],
) -> [f64; N] {
    whole.sum(|near| {
        let pressure = near.rate_rows(parts.fields.pressure);
        let mut found = [0.0; N];
        for (j, k) in near.sub_domain().rows() {
            for (found, [x, ..]) in found.iter_mut().zip(sites).filter(|(_, s)| s[1..] == [j, k]) {
                *found = pressure.row(j as isize, k as isize)[*x].as_f64();
            }
        }
        found
    })
}

/// Force of the fluid on body number `body`, N (N/m in 2-D), in the step to come: the momentum of the
/// populations that go into it, less that of those that come out (Ladd 1994). Pressure counts from
/// that of the reference density on.
pub fn force_on_body<T: Real>(
    whole: &mut Whole<'_, Grid>,
    parts: &Parts<T>,
    body: usize,
) -> [f64; 3] {
    let Parts { fields, mesh, lattice, streaming, density, sites } = parts;
    let velocities = lattice.velocities();
    let ny = mesh.shape[1];
    let force = whole.sum(|near| {
        let views: Vec<_> = fields.populations.iter().map(|&f| near.state(f)).collect();
        let mut force = [0.0; 3];
        for (j, k) in near.sub_domain().rows() {
            let around = Around::new(near, &views, velocities, *streaming, (j, k));
            for single in sites.singles(k * ny + j) {
                for link in sites.links(single).iter().filter(|l| usize::from(l.body) == body) {
                    let x = single.x as usize;
                    let exchanged =
                        around.entering(link, x).as_f64() + around.returned(link, x).as_f64();
                    for a in 0..3 {
                        let c = velocities[usize::from(link.q)][a];
                        force[a] -= f64::from(c) * exchanged;
                    }
                }
            }
        }
        force
    });
    let unit = density * mesh.cell_volume(lattice.dims()) * mesh.unit_acceleration();
    force.map(|f| f * unit)
}
