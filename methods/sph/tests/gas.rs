//! Gas dynamics against what it stands for: sums over all pairs, derivatives of the energy, and
//! conservation.

mod gas_box;

use finegrain_framework::{Handle, Settings, Simulation};
use finegrain_sph::{Dimension, Kernel, ShockCapturing, measure};
use gas_box::{HEAT_RATIO, KERNEL, RATIO, gas_box};

/// Particles of a gas with their rates, and the box they are in.
struct Gas {
    dims: usize,
    lengths: Vec<f64>,
    mass: f64,
    position: Vec<[f64; 3]>,
    velocity: Vec<[f64; 3]>,
    acceleration: Vec<[f64; 3]>,
    density: Vec<f64>,
    energy: Vec<f64>,
    energy_rate: Vec<f64>,
    smoothing_length: Vec<f64>,
    grad_h: Vec<f64>,
    signal_speed: Vec<f64>,
}

const NO_CONDUCTION: ShockCapturing =
    ShockCapturing { viscosity: 1.3, approach: 3.0, conductivity: 0.0 };
const NO_VISCOSITY: ShockCapturing =
    ShockCapturing { viscosity: 0.0, approach: 3.0, conductivity: 0.7 };

/// The gas box at its first evaluation, after `change` has had its way with the positions.
fn gas(dims: usize, shocks: Option<ShockCapturing>, change: impl Fn(&mut [f64], usize)) -> Gas {
    let mut sph = gas_box::<f64>(dims, shocks);
    let fields = sph.fields.clone();
    for (a, &x) in fields.position.iter().enumerate() {
        change(sph.model.columns.values_mut(x), a);
    }
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    simulation.begin().unwrap();
    let lengths = simulation.domain().region().upper.clone();
    let columns = simulation.columns();
    // In the order of their identities, whatever the cells they are in.
    let identity = columns.values(fields.identity);
    let mut order: Vec<usize> = (0..identity.len()).collect();
    order.sort_by_key(|&i| identity[i]);
    fn sorted<H: Handle<Element = f64>>(
        columns: &finegrain_framework::Columns,
        order: &[usize],
        of: Option<H>,
    ) -> Vec<f64> {
        of.map_or(Vec::new(), |of| order.iter().map(|&i| columns.values(of)[i]).collect())
    }
    fn vectors<H: Handle<Element = f64>>(
        columns: &finegrain_framework::Columns,
        order: &[usize],
        of: &[H],
    ) -> Vec<[f64; 3]> {
        let component = |i: usize, a: usize| of.get(a).map_or(0.0, |&c| columns.values(c)[i]);
        order.iter().map(|&i| std::array::from_fn(|a| component(i, a))).collect()
    }
    Gas {
        dims,
        lengths,
        mass: sph.particle_mass,
        position: vectors(columns, &order, &fields.position),
        velocity: vectors(columns, &order, &fields.velocity),
        acceleration: vectors(columns, &order, &fields.acceleration),
        density: sorted(columns, &order, Some(fields.density)),
        energy: sorted(columns, &order, fields.energy),
        energy_rate: sorted(columns, &order, fields.energy_rate),
        smoothing_length: sorted(columns, &order, fields.smoothing_length),
        grad_h: sorted(columns, &order, fields.grad_h),
        signal_speed: sorted(columns, &order, fields.signal_speed),
    }
}

impl Gas {
    /// `x_i - x_j` for the nearest image, which is the only one near enough.
    fn difference(&self, i: usize, j: usize) -> [f64; 3] {
        std::array::from_fn(|a| {
            let d = self.position[i][a] - self.position[j][a];
            if a < self.dims { d - self.lengths[a] * (d / self.lengths[a]).round() } else { 0.0 }
        })
    }

    /// `W` and `F` of a pair with the smoothing length `h`.
    fn kernel(&self, i: usize, j: usize, h: f64) -> (f64, f64) {
        let dimension = [Dimension::One, Dimension::Two, Dimension::Three][self.dims - 1];
        let (mut w, mut f) = ([0.0], [0.0]);
        Kernel::new(KERNEL, dimension, h).evaluate(&[self.squared(i, j)], &mut w, &mut f);
        (w[0], f[0])
    }

    fn squared(&self, i: usize, j: usize) -> f64 {
        self.difference(i, j).iter().map(|d| d * d).sum()
    }

    /// The sum that is the density, with any smoothing length.
    fn summed_density(&self, i: usize, h: f64) -> f64 {
        self.mass * (0..self.position.len()).map(|j| self.kernel(i, j, h).0).sum::<f64>()
    }

    /// Mean of `F` with the two smoothing lengths.
    fn mean_factor(&self, i: usize, j: usize) -> f64 {
        let h = &self.smoothing_length;
        0.5 * (self.kernel(i, j, h[i]).1 + self.kernel(i, j, h[j]).1)
    }

    /// `v_ij . x_ij`.
    fn jump(&self, i: usize, j: usize) -> f64 {
        let d = self.difference(i, j);
        (0..3).map(|a| (self.velocity[i][a] - self.velocity[j][a]) * d[a]).sum()
    }

    fn pressure(&self, i: usize) -> f64 {
        (HEAT_RATIO - 1.0) * self.density[i] * self.energy[i]
    }

    fn sound_speed(&self, i: usize) -> f64 {
        (HEAT_RATIO * self.pressure(i) / self.density[i]).sqrt()
    }
}

fn unchanged(_: &mut [f64], _: usize) {}

fn close(a: f64, b: f64, scale: f64, tolerance: f64) {
    assert!((a - b).abs() < tolerance * scale, "{a} for {b}");
}

#[test]
fn density_is_the_sum_with_the_smoothing_length_that_follows_from_it() {
    for dims in [1, 2, 3] {
        let gas = gas(dims, None, unchanged);
        let step = 1e-6;
        for i in (0..gas.position.len()).step_by(7) {
            let (h, density) = (gas.smoothing_length[i], gas.density[i]);
            close(RATIO * (gas.mass / density).powf(1.0 / dims as f64), h, h, 1e-12);
            close(gas.summed_density(i, h), density, density, 1e-10);
            // Omega = 1 - dh/drho drho/dh.
            let slope =
                gas.summed_density(i, h * (1.0 + step)) - gas.summed_density(i, h * (1.0 - step));
            let omega = 1.0 + slope / (2.0 * step) / (dims as f64 * density);
            close(gas.grad_h[i], omega, 1.0, 1e-7);
        }
        let (least, most) =
            gas.density.iter().fold((9.0, 0.0), |(l, m), &d| (f64::min(l, d), f64::max(m, d)));
        assert!(most > 1.15 * least, "{dims}-D: too even to show anything");
    }
}

/// At constant entropy the force on a particle is the derivative of the internal energy of all with
/// its position: only so if the terms for the varying smoothing length are right.
#[test]
fn force_is_the_derivative_of_the_energy() {
    for dims in [1, 2, 3] {
        let here = gas(dims, None, unchanged);
        let step = 1e-6;
        for i in [0, here.position.len() / 2] {
            for a in 0..dims {
                let energy = |step: f64| {
                    let moved = gas(dims, None, |x, b| x[i] += if a == b { step } else { 0.0 });
                    let ratios = moved.density.iter().zip(&here.density);
                    let energies = ratios.zip(&here.energy);
                    energies.map(|((d, d0), e)| e * (d / d0).powf(HEAT_RATIO - 1.0)).sum::<f64>()
                };
                let force = -(energy(step) - energy(-step)) / (2.0 * step);
                close(here.acceleration[i][a], force, 1.0, 1e-4);
                assert!(force.abs() > 0.01, "{force} shows nothing");
            }
        }
    }
}

#[test]
fn viscosity_is_its_sum_over_all_pairs() {
    for dims in [1, 2, 3] {
        let (with, without) =
            (gas(dims, Some(NO_CONDUCTION), unchanged), gas(dims, None, unchanged));
        let mut largest = 0.0f64;
        for i in (0..with.position.len()).step_by(11) {
            let (mut acceleration, mut heat, mut fastest) = ([0.0; 3], 0.0, 0.0f64);
            for j in 0..with.position.len() {
                let (jump, factor) = (with.jump(i, j), with.mean_factor(i, j));
                if i != j && factor < 0.0 {
                    let w = jump.min(0.0) / with.squared(i, j).sqrt();
                    let signal = with.sound_speed(i) + with.sound_speed(j) - 3.0 * w;
                    fastest = fastest.max(signal);
                    let mean = 0.5 * (with.density[i] + with.density[j]);
                    let pi = -0.5 * 1.3 * signal * w / mean;
                    let d = with.difference(i, j);
                    for a in 0..3 {
                        acceleration[a] -= with.mass * pi * factor * d[a];
                    }
                    heat += 0.5 * with.mass * pi * factor * jump;
                }
            }
            for a in 0..dims {
                let change = with.acceleration[i][a] - without.acceleration[i][a];
                close(change, acceleration[a], 10.0, 1e-11);
            }
            close(with.energy_rate[i] - without.energy_rate[i], heat, 10.0, 1e-11);
            close(with.signal_speed[i], fastest.max(2.0 * with.sound_speed(i)), 1.0, 1e-11);
            assert!(heat >= 0.0);
            largest = largest.max(heat);
        }
        assert!(largest > 0.1, "{largest} shows nothing");
    }
}

#[test]
fn conductivity_is_its_sum_over_all_pairs() {
    for dims in [1, 2, 3] {
        let (with, without) =
            (gas(dims, Some(NO_VISCOSITY), unchanged), gas(dims, None, unchanged));
        let mut largest = 0.0f64;
        for i in (0..with.position.len()).step_by(11) {
            let mut heat = 0.0;
            for j in 0..with.position.len() {
                let mean = 0.5 * (with.density[i] + with.density[j]);
                let speed = ((with.pressure(i) - with.pressure(j)).abs() / mean).sqrt();
                let slope = with.mean_factor(i, j) * with.squared(i, j).sqrt();
                let difference = with.energy[i] - with.energy[j];
                heat += 0.7 * with.mass * speed * difference / mean * slope;
            }
            close(with.energy_rate[i] - without.energy_rate[i], heat, 10.0, 1e-11);
            largest = largest.max(heat.abs());
        }
        assert!(largest > 0.01, "{largest} shows nothing");
    }
}

#[test]
fn momentum_and_energy_are_exchanged_without_loss() {
    for dims in [1, 2, 3] {
        let gas = gas(dims, Some(ShockCapturing::default()), unchanged);
        let (mut force, mut power, mut scale) = ([0.0; 3], 0.0, 0.0);
        for i in 0..gas.position.len() {
            for a in 0..dims {
                force[a] += gas.acceleration[i][a];
                power += gas.acceleration[i][a] * gas.velocity[i][a];
                scale += gas.acceleration[i][a].abs();
            }
            power += gas.energy_rate[i];
        }
        for loss in force.into_iter().chain([power]) {
            assert!(loss.abs() < 1e-13 * scale, "{dims}-D: {loss:e} of {scale}");
        }
    }
}

#[test]
fn momentum_to_round_off_and_energy_to_the_order_of_time_stepping() {
    for dims in [1, 2] {
        let sph = gas_box::<f64>(dims, Some(ShockCapturing::default()));
        let (fields, mass) = (sph.fields, sph.particle_mass);
        let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
        simulation.begin().unwrap();
        let mut totals = || measure::totals(&mut simulation.whole(), &fields, mass);
        let before = totals();
        let scale = (2.0 * before.kinetic_energy * before.mass).sqrt();
        simulation.advance(60).unwrap();
        let now = measure::totals(&mut simulation.whole(), &fields, mass);
        for a in 0..dims {
            let change = (now.momentum[a] - before.momentum[a]).abs() / scale;
            assert!(change < 1e-13, "{dims}-D: {change:e}");
        }
        let energy = |t: measure::Totals| t.kinetic_energy + t.internal_energy;
        let change = energy(now) / energy(before) - 1.0;
        assert!(change.abs() < 1e-4, "{dims}-D: {change:e}");
        assert!(now.internal_energy != before.internal_energy);
    }
}

#[test]
fn a_restart_goes_on_with_the_same_bits() {
    let start = || {
        let sph = gas_box::<f64>(2, Some(ShockCapturing::default()));
        Simulation::new(sph.model, Settings::default()).unwrap()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gas");
    let mut whole = start();
    whole.advance(13).unwrap();
    whole.save(&path, 1).unwrap();
    whole.advance(20).unwrap();
    let mut second = start();
    second.restore(&path, 1).unwrap();
    second.advance(20).unwrap();
    assert_eq!(second.state_hash(), whole.state_hash());
}

#[test]
fn gas_that_is_too_thin_is_named() {
    let mut sph = gas_box::<f64>(2, None);
    // Far from all others but those at its own place, in one direction.
    for (i, x) in sph.model.columns.values_mut(sph.fields.position[0]).iter_mut().enumerate() {
        *x = if i == 17 { 0.625 } else { 0.25 * *x };
    }
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    let said = simulation.begin().unwrap_err().to_string();
    assert!(said.contains("particle 17 needs a smoothing length of about"), "{said}");
    assert!(said.contains("at most 1.500e-1 m"), "{said}");
}
