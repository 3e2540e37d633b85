//! What workers are doing inside a stage, for a sampler to see.
//!
//! Parts of a stage that are too short to be timed can still be told apart: the stage says what it begins
//! to do, which is one store to memory of the worker's own, and somebody looks now and then.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering::Relaxed};
use std::time::Duration;

use crossbeam_utils::CachePadded;

/// What one worker is doing now: a number that its stage chooses, 0 outside of stages that say.
#[derive(Debug, Default)]
pub struct Activity(CachePadded<AtomicU8>);

/// For whom nobody watches.
pub(crate) static UNWATCHED: Activity = Activity(CachePadded::new(AtomicU8::new(0)));

impl Activity {
    /// Says that what is called `number` begins.
    #[inline(always)]
    pub fn begin(&self, number: u8) {
        self.0.store(number, Relaxed);
    }
}

/// What all workers of a simulation are doing, see [`Simulation::activities`].
///
/// [`Simulation::activities`]: crate::Simulation::activities
#[derive(Clone, Debug)]
pub struct Activities(Arc<[Activity]>);

impl Activities {
    pub(crate) fn new(workers: usize) -> Self {
        Self((0..workers).map(|_| Activity::default()).collect())
    }

    pub(crate) fn of(&self, worker: usize) -> &Activity {
        &self.0[worker]
    }

    fn look(&self, seen: &mut [u64; 256]) {
        for Activity(number) in &*self.0 {
            seen[usize::from(number.load(Relaxed))] += 1;
        }
    }

    /// Does `work` while another thread looks, every `interval`, at what each worker is doing. Returns
    /// how often each number was seen.
    pub fn sample<R>(&self, interval: Duration, work: impl FnOnce() -> R) -> (R, [u64; 256]) {
        let is_done = AtomicBool::new(false);
        // Also if `work` panics: the scope waits for the sampler.
        struct Done<'a>(&'a AtomicBool);
        impl Drop for Done<'_> {
            fn drop(&mut self) {
                self.0.store(true, Relaxed);
            }
        }
        std::thread::scope(|scope| {
            let sampler = scope.spawn(|| {
                let mut seen = [0; 256];
                while !is_done.load(Relaxed) {
                    self.look(&mut seen);
                    std::thread::sleep(interval);
                }
                seen
            });
            let done = Done(&is_done);
            let result = work();
            drop(done);
            let seen = sampler.join();
            (result, seen.unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_begun_is_seen_until_something_else_begins() {
        let activities = Activities::new(2);
        let mut seen = [0; 256];
        for number in [3, 3, 7, 0] {
            activities.of(1).begin(number);
            activities.look(&mut seen);
        }
        // The other worker was idle all the time.
        assert_eq!([seen[0], seen[3], seen[7]], [5, 2, 1]);
        assert_eq!(seen.iter().sum::<u64>(), 8);
    }

    #[test]
    fn sampling_ends_with_the_work_even_if_it_panics() {
        let activities = Activities::new(1);
        let (result, _) = activities.sample(Duration::from_micros(20), || "done");
        assert_eq!(result, "done");
        let panics = || activities.sample(Duration::from_micros(20), || panic!("on purpose"));
        assert!(std::panic::catch_unwind(panics).is_err());
    }
}
