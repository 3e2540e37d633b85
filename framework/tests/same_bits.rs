//! Worker count, schedule, order of hand-out, how far sub-domains may run ahead and how a run is
//! cut into calls never change a bit.
//!
//! Every model is run under all of them and compared with the serial reference: each kept
//! column's bytes, their hash, and the time. Sizes are such that neither tiles nor blocks divide
//! evenly.

mod models;

use finegrain_framework::*;
use models::heat::heat;
use models::particles::Swarm;
use models::plate::plate;

/// Steps of the two calls that a run is cut into; with uneven lengths swapped columns come to
/// lie either way round in between.
const CALLS: [u64; 2] = [5, 8];

/// All that must not matter.
fn settings() -> Vec<Settings> {
    let mut all = Vec::new();
    let hand_outs = [1, 2, 3].map(|seed| HandOut::Shuffled { seed });
    for hand_out in [HandOut::Natural].into_iter().chain(hand_outs) {
        for schedule in Schedule::ALL {
            for workers in [1, 2, 3, 8] {
                let ahead: &[_] = match schedule {
                    Schedule::PeerToPeer => &[None, Some(1), Some(2), Some(3), Some(64)],
                    _ => &[None],
                };
                for &steps_ahead in ahead {
                    let hand_out = hand_out.clone();
                    let trace = if matches!(hand_out, HandOut::Natural) { 0 } else { 16 };
                    let check_every = Some(3);
                    all.push(Settings {
                        schedule,
                        workers,
                        hand_out,
                        check_every,
                        steps_ahead,
                        trace,
                    });
                }
            }
        }
    }
    all
}

/// All that must stay the same.
#[derive(PartialEq)]
struct Bits {
    columns: Vec<(String, Vec<u8>)>,
    hash: u64,
    time: u64,
}

fn bits<D: Domain>(simulation: &Simulation<D>) -> Bits {
    let columns = simulation.columns();
    Bits {
        columns: columns
            .iter()
            .filter(|(_, column)| column.is_kept())
            .map(|(id, column)| (column.name().to_owned(), columns.bytes(id).to_vec()))
            .collect(),
        hash: simulation.state_hash(),
        time: simulation.clock().time().to_bits(),
    }
}

fn assert_same(found: &Bits, expected: &Bits, settings: &Settings) {
    for ((name, found), (_, expected)) in found.columns.iter().zip(&expected.columns) {
        let first = found.iter().zip(expected).position(|(a, b)| a != b);
        assert_eq!(first, None, "first byte of {name:?} that differs under {settings:?}");
    }
    assert!(found == expected, "hash or time differs under {settings:?}");
}

/// Runs `model` under all settings; the reference is serial and uncut.
fn same_bits_whatever_runs<D: Domain>(model: impl Fn() -> Model<D>) {
    let serial = Settings { schedule: Schedule::Serial, ..Settings::default() };
    let mut reference = Simulation::new(model(), serial).unwrap();
    let begin = bits(&reference);
    reference.advance(CALLS[0]).unwrap();
    let middle = bits(&reference);
    let mut reference = Simulation::new(model(), reference.settings().clone()).unwrap();
    reference.advance(CALLS.iter().sum()).unwrap();
    let end = bits(&reference);
    assert!(begin != middle && middle != end, "nothing happens in this model");
    for settings in settings() {
        let mut simulation = Simulation::new(model(), settings.clone()).unwrap();
        simulation.advance(CALLS[0]).unwrap();
        assert_same(&bits(&simulation), &middle, &settings);
        simulation.advance(CALLS[1]).unwrap();
        assert_same(&bits(&simulation), &end, &settings);
    }
}

#[test]
fn heat_in_a_periodic_plane() {
    same_bits_whatever_runs(|| heat([17, 31], true, [2, 1], 1));
}

#[test]
fn heat_in_a_bounded_plane() {
    same_bits_whatever_runs(|| heat([5, 64], false, [3, 1], 1));
}

#[test]
fn heat_in_a_periodic_volume() {
    same_bits_whatever_runs(|| heat([6, 11, 13], true, [2, 3], 1));
}

#[test]
fn heat_in_a_bounded_volume() {
    same_bits_whatever_runs(|| heat([6, 10, 7], false, [3, 2], 1));
}

/// The state lies in either column's memory after every other part and every other step.
#[test]
fn three_stencils_and_swaps_a_step() {
    same_bits_whatever_runs(|| heat([9, 29], true, [2, 1], 3));
}

#[test]
fn one_tile() {
    same_bits_whatever_runs(|| heat([9, 9], true, [9, 1], 1));
}

/// The second rate stage reads what neighbours' first one wrote.
#[test]
fn rates_of_rates() {
    same_bits_whatever_runs(|| plate([11, 37], 2, Integrator::Euler));
}

#[test]
fn runge_kutta() {
    same_bits_whatever_runs(|| plate([11, 23], 2, Integrator::Rk4));
}

#[test]
fn runge_kutta_strong_stability_preserving() {
    same_bits_whatever_runs(|| plate([11, 23], 3, Integrator::SspRk3));
}

/// Its rates are kept from step to step and swapped.
#[test]
fn leapfrog() {
    same_bits_whatever_runs(|| plate([11, 23], 2, Integrator::Leapfrog));
}

/// Thinner than the range: a particle meets several images of itself.
#[test]
fn particles_in_a_thin_periodic_box() {
    let (size, periodic) = ([2.0, 0.08], [true, true]);
    let swarm = Swarm { points: 203, size, periodic, range: 0.1, block_points: 8 };
    same_bits_whatever_runs(|| swarm.model());
}

#[test]
fn particles_in_the_open() {
    let (size, periodic) = ([1.0, 1.0], [false, false]);
    let swarm = Swarm { points: 301, size, periodic, range: 0.12, block_points: 10 };
    same_bits_whatever_runs(|| swarm.model());
}

#[test]
fn particles_in_a_volume_open_in_one_direction() {
    let (size, periodic) = ([1.0, 0.7, 0.3], [true, false, true]);
    let swarm = Swarm { points: 401, size, periodic, range: 0.2, block_points: 12 };
    same_bits_whatever_runs(|| swarm.model());
}

/// Without this the particle models would not show that sorting keeps the bits.
#[test]
fn particles_change_cells_on_the_way() {
    let (size, periodic) = ([2.0, 0.08], [true, true]);
    let swarm = Swarm { points: 203, size, periodic, range: 0.1, block_points: 8 };
    let mut simulation = Simulation::new(swarm.model(), Settings::default()).unwrap();
    let number = |simulation: &Simulation<_>| {
        let columns: &Columns = simulation.columns();
        let (id, _) = columns.iter().find(|(_, column)| column.name() == "number").unwrap();
        columns.bytes(id).to_vec()
    };
    simulation.begin().unwrap();
    let sorted = number(&simulation);
    simulation.advance(CALLS.iter().sum()).unwrap();
    assert_ne!(number(&simulation), sorted);
}
