//! The same flow gives the same bits for any number of workers, schedule and hand-out order.

mod flow;
mod gas_box;

use finegrain_framework::space::Cells;
use finegrain_framework::{HandOut, Real, Schedule, Settings, Simulation};
use finegrain_sph::{Scheme, ShockCapturing, Viscosity};

fn hash<T: Real>(mut simulation: Simulation<Cells<T>>) -> u64 {
    // Several paces, so that particles are sorted anew more than once.
    simulation.advance(30).unwrap();
    simulation.state_hash()
}

fn same_bits<T: Real>(dims: usize, viscosity: Viscosity, scheme: &Scheme) {
    same_bits_of::<T>(|settings| flow::flow(dims, viscosity, scheme, true, settings).0);
}

fn same_bits_of_gas<T: Real>(dims: usize) {
    same_bits_of::<T>(|settings| {
        let sph = gas_box::gas_box::<T>(dims, Some(ShockCapturing::default()));
        Simulation::new(sph.model, settings).unwrap()
    });
}

fn same_bits_of<T: Real>(start: impl Fn(Settings) -> Simulation<Cells<T>>) {
    let serial = Settings { schedule: Schedule::Serial, workers: 1, ..Settings::default() };
    let expected = hash(start(serial));
    for schedule in Schedule::ALL {
        for workers in [1, 2, 3, 8] {
            for hand_out in [HandOut::Natural, HandOut::Shuffled { seed: 3 }] {
                let settings = Settings { schedule, workers, hand_out, ..Settings::default() };
                assert_eq!(hash(start(settings.clone())), expected, "{settings:?}");
            }
        }
    }
}

#[test]
fn one_sweep_in_2d() {
    same_bits::<f64>(2, Viscosity::Morris, &Scheme::default());
}

#[test]
fn two_sweeps_in_2d() {
    same_bits::<f64>(2, Viscosity::StrainRate, &Scheme::default());
}

#[test]
fn two_sweeps_in_a_thin_3d_box() {
    same_bits::<f64>(3, Viscosity::StrainRate, &Scheme::default());
}

#[test]
fn single_precision() {
    same_bits::<f32>(3, Viscosity::Morris, &Scheme::default());
}

#[test]
fn three_sweeps_with_pressure_transport_and_walls_from_the_fluid() {
    same_bits::<f64>(2, Viscosity::Adami, &flow::edac());
}

#[test]
fn gas_in_1d_and_2d() {
    same_bits_of_gas::<f64>(1);
    same_bits_of_gas::<f64>(2);
}

#[test]
fn gas_in_3d_and_single_precision() {
    same_bits_of_gas::<f32>(3);
}
