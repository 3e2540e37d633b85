//! Scalar quantities of the flow, as deterministic reductions.

use finegrain_framework::space::Cells;
use finegrain_framework::{Near, Real, State, Whole};

use crate::fields::Fields;
use crate::kernel::Kernel;
use crate::physics::Fluid;

/// Integrals over the fluid, without the particles that fill bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Totals {
    /// Volume, m^3 (m^2 in 2-D).
    pub volume: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Integral of the velocity over the volume, m^4/s (m^3/s in 2-D).
    pub flow: [f64; 3],
    /// Momentum, kg m/s.
    pub momentum: [f64; 3],
    /// Kinetic energy, J.
    pub kinetic_energy: f64,
    /// Internal energy, J; 0 without energy equation.
    pub internal_energy: f64,
}

/// Sums up the fluid.
pub fn totals<T: Real, P: Real>(
    whole: &mut Whole<'_, Cells<P>>,
    fields: &Fields<T, P>,
    particle_mass: f64,
) -> Totals {
    let sums = whole.sum(|near| {
        let density = near.state(fields.density).own().whole();
        let depth = fields.wall_depth.map(|d| near.state(d).own().whole());
        let energy = fields.energy.map(|e| near.state(e).own().whole());
        let mut sums = [0.0; 10];
        for i in 0..density.len() {
            if depth.is_some_and(|d| d[i] > T::zero()) {
                continue;
            }
            let volume = particle_mass / density[i].as_f64();
            sums[0] += volume;
            sums[1] += 1.0;
            sums[9] += energy.map_or(0.0, |e| particle_mass * e[i].as_f64());
            for (a, &v) in fields.velocity.iter().enumerate() {
                let v = near.state(v).own().whole()[i].as_f64();
                sums[2 + a] += volume * v;
                sums[5 + a] += particle_mass * v;
                sums[8] += 0.5 * particle_mass * v * v;
            }
        }
        sums
    });
    Totals {
        volume: sums[0],
        mass: sums[1] * particle_mass,
        flow: [sums[2], sums[3], sums[4]],
        momentum: [sums[5], sums[6], sums[7]],
        kinetic_energy: sums[8],
        internal_energy: sums[9],
    }
}

/// Force of the fluid on a body, N (N/m in 2-D), pressure and friction: the sum of what the particles
/// of bodies feel for which `belongs` says that they are of this body, of their position. What they
/// exert on each other cancels; 0 where the model does not know forces on bodies, see
/// [`Physics::forces_on_bodies`](crate::Physics::forces_on_bodies).
pub fn force_on_body<T: Real, P: Real>(
    whole: &mut Whole<'_, Cells<P>>,
    fields: &Fields<T, P>,
    particle_mass: f64,
    belongs: impl Fn([f64; 3]) -> bool + Sync,
) -> [f64; 3] {
    let Some(depth) = fields.wall_depth else { return [0.0; 3] };
    let sums = whole.sum(|near| {
        let depth = near.state(depth).own().whole();
        let mut sums = [0.0; 3];
        for i in (0..depth.len()).filter(|&i| depth[i] > T::zero()) {
            let mut x = [0.0; 3];
            for (x, &position) in x.iter_mut().zip(&fields.position) {
                *x = near.state(position).own().whole()[i].as_f64();
            }
            if belongs(x) {
                for (sum, &reaction) in sums.iter_mut().zip(&fields.reaction) {
                    *sum += near.rate(reaction).own().whole()[i].as_f64();
                }
            }
        }
        sums
    });
    sums.map(|sum| sum * particle_mass)
}

/// Energy of the fluid, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energies {
    /// Of the motion.
    pub kinetic: f64,
    /// In the body force.
    pub potential: f64,
    /// Of compression, from the reference density on.
    pub elastic: f64,
}

impl Energies {
    /// All together.
    pub fn total(&self) -> f64 {
        self.kinetic + self.potential + self.elastic
    }
}

/// Sums up the energies of the fluid; `potential` is that of the body force per mass, J/kg.
pub fn energies<T: Real, P: Real>(
    whole: &mut Whole<'_, Cells<P>>,
    fields: &Fields<T, P>,
    fluid: &Fluid,
    particle_mass: f64,
    potential: impl Fn([f64; 3]) -> f64 + Sync,
) -> Energies {
    let [kinetic, potential, elastic] = whole.sum(|near| {
        let density = near.state(fields.density).own().whole();
        let depth = fields.wall_depth.map(|d| near.state(d).own().whole());
        let mut sums = [0.0; 3];
        for i in 0..density.len() {
            if depth.is_some_and(|d| d[i] > T::zero()) {
                continue;
            }
            let mut x = [0.0; 3];
            for (a, (&position, &velocity)) in
                fields.position.iter().zip(&fields.velocity).enumerate()
            {
                x[a] = near.state(position).own().whole()[i].as_f64();
                sums[0] += 0.5 * near.state(velocity).own().whole()[i].as_f64().powi(2);
            }
            sums[1] += potential(x);
            let ratio = density[i].as_f64() / fluid.density;
            sums[2] += fluid.state_equation.elastic_energy(ratio, fluid.sound_speed);
        }
        sums
    });
    Energies {
        kinetic: kinetic * particle_mass,
        potential: potential * particle_mass,
        elastic: elastic * particle_mass,
    }
}

/// Largest speed of any particle, m/s.
pub fn largest_speed<T: Real, P: Real>(
    whole: &mut Whole<'_, Cells<P>>,
    fields: &Fields<T, P>,
) -> f64 {
    let [squared] = whole.max(|near| {
        let mut most = 0.0f64;
        for i in 0..near.spans()[0].len() {
            let squared: f64 = fields
                .velocity
                .iter()
                .map(|&v| near.state(v).own().whole()[i].as_f64().powi(2))
                .sum();
            most = if squared > most || squared.is_nan() { squared } else { most };
        }
        [most]
    });
    squared.sqrt()
}

/// Number of neighbours within the range of interaction that a particle has on average, itself not
/// counted; images through which a particle is seen several times count each.
pub fn mean_neighbours<T: Real>(whole: &mut Whole<'_, Cells<T>>) -> f64 {
    let range = T::of(whole.domain.range()) * Kernel::<T>::cut();
    let points = whole.columns.points() as f64;
    let positions = whole.domain.positions().to_vec();
    let [pairs] = whole.sum(|near| {
        let mut pairs = 0;
        for_each_pair(near, &positions, |squared| pairs += u64::from(squared < range * range));
        [pairs as f64]
    });
    pairs / points - 1.0
}

/// What a search for all neighbours looks at, a particle.
#[derive(Clone, Copy, Debug)]
pub struct SearchEffort {
    /// Particles that sub-domains see, their own included.
    pub seen: f64,
    /// Those that are tested against the box around the particles of a cell.
    pub tested: f64,
    /// Those near the box, which are tested against every particle in it.
    pub candidates: f64,
}

/// What a search for all neighbours looks at.
pub fn search_effort<T: Real>(whole: &mut Whole<'_, Cells<T>>) -> SearchEffort {
    let range = T::of(whole.domain.range());
    let points = whole.columns.points() as f64;
    let positions = whole.domain.positions().to_vec();
    let sums = whole.sum(|near| {
        let block = near.sub_domain();
        let mut runs = Vec::new();
        block.surroundings(&mut runs);
        let count = runs.iter().map(|run| run.span.len()).sum::<usize>() as f64;
        let (mut cells, mut candidates) = (0.0, 0.0);
        for cell in block.cells() {
            let mut is_near = Vec::new();
            for (a, &position) in positions.iter().enumerate() {
                let position = near.state(position);
                let own = position.at(near.reach(near.id(), cell.span)).iter();
                let bounds = (T::infinity(), T::neg_infinity());
                let (low, high) = own.fold(bounds, |(low, high), &x| (low.min(x), high.max(x)));
                let seen = runs.iter().flat_map(|run| {
                    let shift = T::of(run.shift[a]);
                    position.at(near.reach(run.owner, run.span)).iter().map(move |&x| x + shift)
                });
                let squares =
                    seen.map(|x| (low - x).max(x - high).max(T::zero()).powi(2)).enumerate();
                is_near.resize(count as usize, T::zero());
                squares.for_each(|(j, square)| is_near[j] += square);
            }
            let found = is_near.iter().filter(|&&squared| squared < range * range).count();
            candidates += (found * cell.span.len()) as f64;
            cells += 1.0;
        }
        [count, count * cells, candidates]
    });
    let [seen, tested, candidates] = sums.map(|sum| sum / points);
    SearchEffort { seen, tested, candidates }
}

/// Distance of the two particles that are closest to each other, m; infinite if no two are within
/// the range of interaction.
pub fn closest_pair<T: Real>(whole: &mut Whole<'_, Cells<T>>) -> f64 {
    let positions = whole.domain.positions().to_vec();
    let range = T::of(whole.domain.range());
    let [nearness] = whole.max(|near| {
        let mut least = range * range;
        let mut at_once = 0;
        for_each_pair(near, &positions, |squared| {
            // Every particle once meets itself.
            if squared == T::zero() {
                at_once += 1;
            } else {
                least = least.min(squared);
            }
        });
        let coincide = at_once > near.spans()[0].len();
        [if coincide { f64::INFINITY } else { 1.0 / least.as_f64() }]
    });
    let closest = nearness.recip().sqrt();
    if closest < range.as_f64() { closest } else { f64::INFINITY }
}

/// Calls `with` with the squared distances of all pairs of a particle of the sub-domain and a
/// particle in a cell around it, itself included.
fn for_each_pair<T: Real>(
    near: &Near<'_, Cells<T>>,
    positions: &[State<T>],
    mut with: impl FnMut(T),
) {
    let block = near.sub_domain();
    let mut runs = Vec::new();
    let own: Vec<_> = positions.iter().map(|&x| near.state(x).own().whole()).collect();
    let first = near.spans()[0].start;
    for cell in block.cells() {
        block.candidates(cell, &mut runs);
        for run in &runs {
            let reach = near.reach(run.owner, run.span);
            let seen: Vec<_> = positions.iter().map(|&x| near.state(x).at(reach)).collect();
            for i in cell.span.range() {
                for j in 0..run.span.len() {
                    let squared = own.iter().zip(&seen).enumerate().map(|(a, (own, seen))| {
                        let d = own[i - first] - (seen[j] + T::of(run.shift[a]));
                        d * d
                    });
                    with(squared.sum());
                }
            }
        }
    }
}
