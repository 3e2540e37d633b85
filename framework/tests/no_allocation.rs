//! A steady step allocates nothing, under any schedule that is ours; sorting into cells included.
//!
//! rayon's own loops are measured but not held to it: they queue jobs in blocks from the heap.
//!
//! One test alone in its binary: see `counting`.

mod counting;
mod models;

use counting::allocations;
use finegrain_framework::*;
use models::heat::heat;
use models::particles::Swarm;
use models::plate::plate;

#[test]
fn steady_steps_allocate_nothing() {
    let (size, periodic) = ([2.0, 1.0], [true, true]);
    let swarm = Swarm { points: 1000, size, periodic, range: 0.08, block_points: 10 };
    let mut found = Vec::new();
    for schedule in Schedule::ALL {
        for workers in [1, 3] {
            for hand_out in [HandOut::Natural, HandOut::Shuffled { seed: 1 }] {
                let settings =
                    Settings { schedule, workers, hand_out, trace: 100, ..Settings::default() };
                // So many tiles that hundreds are ready at once.
                let counts = [
                    allocations(heat([9, 601], true, [1, 1], 1), &settings),
                    allocations(plate([9, 301], 2, Integrator::Leapfrog), &settings),
                    allocations(swarm.model(), &settings),
                ];
                if schedule == Schedule::ForkJoin {
                    println!("rayon: {counts:?} allocations by {workers}");
                } else if counts != [0; 3] {
                    found.push(format!("{counts:?} under {settings:?}"));
                }
            }
        }
    }
    assert!(found.is_empty(), "heat, plate, particles:\n{}", found.join("\n"));
}
