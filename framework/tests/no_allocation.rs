//! A steady step allocates nothing, under any schedule that is ours; sorting into cells included.
//!
//! rayon's own loops are measured but not held to it: they queue jobs in blocks from the heap.
//!
//! One test alone in its binary, because the allocator counts for the whole process.

mod models;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};

use finegrain_framework::*;
use models::heat::heat;
use models::particles::Swarm;
use models::plate::plate;

struct Counting;

static ALLOCATIONS: AtomicU64 = AtomicU64::new(0);

// SAFETY: everything is passed on to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as the caller promised.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, address: *mut u8, layout: Layout) {
        // SAFETY: as the caller promised.
        unsafe { System.dealloc(address, layout) }
    }

    unsafe fn realloc(&self, address: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as the caller promised.
        unsafe { System.realloc(address, layout, size) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Steps until all memory has grown to its size.
const WARM_UP: u64 = 200;
const STEPS: u64 = 100;

/// Allocations of `STEPS` steady steps, called for in several goes; the least of some such stretches,
/// because a worker that the system has let sleep until then has its memory still to grow.
fn allocations<D: Domain>(model: Model<D>, settings: &Settings) -> u64 {
    let mut simulation = Simulation::new(model, settings.clone()).unwrap();
    simulation.advance(WARM_UP).unwrap();
    let mut least = u64::MAX;
    for _ in 0..5 {
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        for _ in 0..10 {
            simulation.advance(STEPS / 10).unwrap();
        }
        least = least.min(ALLOCATIONS.load(Ordering::Relaxed) - before);
        if least == 0 {
            break;
        }
    }
    least
}

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
                    println!("rayon: {counts:?} allocations in {STEPS} steps by {workers}");
                } else if counts != [0; 3] {
                    found.push(format!("{counts:?} under {settings:?}"));
                }
            }
        }
    }
    assert!(found.is_empty(), "heat, plate, particles:\n{}", found.join("\n"));
}
