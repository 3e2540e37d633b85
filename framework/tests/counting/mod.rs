//! An allocator that counts, and how often steady steps call for it.
//!
//! Its test must be alone in its binary, because the allocator counts for the whole process.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicU64, Ordering};

use finegrain_framework::{Domain, Model, Schedule, Settings, Simulation};

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
const WARM_UP: u64 = 300;
const STEPS: u64 = 100;
const STRETCHES: usize = 5;

/// Allocations of steady steps, called for in several goes.
///
/// Where it is certain who runs what, those of all stretches. Where it is not, those of the best one:
/// a worker that the system has let sleep until then has its memory still to grow.
pub fn allocations<D: Domain>(model: Model<D>, settings: &Settings) -> u64 {
    let is_certain = settings.workers == 1 || settings.schedule == Schedule::Serial;
    let mut simulation = Simulation::new(model, settings.clone()).unwrap();
    simulation.advance(WARM_UP).unwrap();
    let mut stretch = || {
        let before = ALLOCATIONS.load(Ordering::Relaxed);
        (0..10).for_each(|_| simulation.advance(STEPS / 10).unwrap());
        ALLOCATIONS.load(Ordering::Relaxed) - before
    };
    if is_certain {
        (0..STRETCHES).map(|_| stretch()).sum()
    } else {
        let mut least = u64::MAX;
        for _ in 0..STRETCHES {
            least = least.min(stretch());
            if least == 0 {
                break;
            }
        }
        least
    }
}
