//! A small periodic box of uneven gas in motion, for tests of what must hold for any gas.

use std::f64::consts::TAU;

use finegrain_framework::Real;
use finegrain_framework::space::cells::Region;
use finegrain_sph::{
    Fluid, Packing, Physics, Scheme, ShockCapturing, Smoothing, SmoothingFunction, Sph, Start,
    StateEquation,
};

/// Ratio of the specific heats.
pub const HEAT_RATIO: f64 = 1.4;
/// `eta`.
pub const RATIO: f64 = 1.5;
/// The kernel.
pub const KERNEL: SmoothingFunction = SmoothingFunction::WendlandC4;

/// Gas in a unit box (3-D: a box 0.8 high), with its particles' mass.
pub fn gas_box<T: Real>(dims: usize, shock_capturing: Option<ShockCapturing>) -> Sph<T> {
    let spacing = [0.02, 0.05, 0.1][dims - 1];
    let (packing, sides) = match dims {
        3 => (Packing::Cubic, [1.0, 1.0, 0.8]),
        _ => (Packing::Square, [1.0, if dims == 1 { spacing } else { 1.0 }, 1.0]),
    };
    let lattice = packing.fit(sides, spacing).unwrap();
    let wave = |x: f64| 0.02 * (TAU * x).sin();
    // Denser in the middle.
    let positions: Vec<[f64; 3]> = lattice
        .displaced_positions(0.1, 5)
        .map(|x| [x[0] + wave(x[0]), if dims == 1 { 0.0 } else { x[1] }, x[2]])
        .map(|x| x.map(|x| x.rem_euclid(1.0)))
        .collect();
    let velocity = |x: &[f64; 3]| {
        let along = [-(TAU * x[0]).sin(), (TAU * (x[0] + x[1])).sin(), (TAU * x[1]).cos()];
        let along = along.map(|v| 0.5 * v);
        std::array::from_fn(|a| if a < dims { along[a] } else { 0.0 })
    };
    let start = Start {
        region: Region {
            lower: vec![0.0; dims],
            upper: lattice.lengths()[..dims].to_vec(),
            periodic: vec![true; dims],
        },
        spacing,
        particle_volume: spacing.powi(dims as i32),
        velocities: positions.iter().map(velocity).collect(),
        positions,
    };
    let fluid = Fluid {
        density: 2.0,
        sound_speed: 1.0,
        kinematic_viscosity: 0.0,
        state_equation: StateEquation::IdealGas { heat_ratio: HEAT_RATIO },
    };
    let physics = Physics { energy: true, shock_capturing, ..Physics::default() };
    let scheme = Scheme {
        kernel: KERNEL,
        smoothing_ratio: RATIO,
        smoothing: Smoothing::Adaptive { longest: 2.0 * RATIO * spacing },
        ..Scheme::default()
    };
    let mut sph = Sph::<T>::new(&start, &fluid, &physics, &scheme).unwrap();
    let energy = sph.fields.energy.unwrap();
    for (energy, x) in sph.model.columns.values_mut(energy).iter_mut().zip(&start.positions) {
        *energy = T::of(1.0 + 0.5 * (TAU * x[0]).cos());
    }
    sph
}
