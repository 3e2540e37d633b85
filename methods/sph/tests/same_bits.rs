//! The same flow gives the same bits for any number of workers, schedule and hand-out order.

mod flow;

use finegrain_framework::{HandOut, Real, Schedule, Settings};
use finegrain_sph::{Scheme, Viscosity};

fn hash<T: Real>(dims: usize, viscosity: Viscosity, scheme: &Scheme, settings: Settings) -> u64 {
    let (mut simulation, _, _) = flow::flow::<T>(dims, viscosity, scheme, true, settings);
    // Several paces, so that particles are sorted anew more than once.
    simulation.advance(30).unwrap();
    simulation.state_hash()
}

fn same_bits<T: Real>(dims: usize, viscosity: Viscosity, scheme: &Scheme) {
    let serial = Settings { schedule: Schedule::Serial, workers: 1, ..Settings::default() };
    let expected = hash::<T>(dims, viscosity, scheme, serial);
    for schedule in Schedule::ALL {
        for workers in [1, 2, 3, 8] {
            for hand_out in [HandOut::Natural, HandOut::Shuffled { seed: 3 }] {
                let settings = Settings { schedule, workers, hand_out, ..Settings::default() };
                assert_eq!(
                    hash::<T>(dims, viscosity, scheme, settings.clone()),
                    expected,
                    "{dims}-D {viscosity:?} {settings:?}"
                );
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
