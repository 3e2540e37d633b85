//! How a worker waits: spin briefly, then give way, then sleep.

use std::time::{Duration, Instant};

use crate::sync::{AtomicUsize, Condvar, Mutex, Ordering, fence, spin_loop, yield_now};

/// How long a worker spins: longer than a meeting of running workers takes, far shorter than a time
/// slice that somebody else could use. Measured, not counted in hints: a hint takes from 5 to 40 ns.
const SPIN: Duration = Duration::from_micros(10);
/// Checks of the condition between two looks at the time.
const CHECKS: u32 = 32;
/// Times a worker offers its core to others before it sleeps.
const YIELDS: u32 = if cfg!(loom) { 1 } else { 16 };

/// A place to sleep until an event.
///
/// The event itself is an atomic variable elsewhere; `Bell` only promises that nobody sleeps
/// through it. Waiter: announce oneself in `sleepers`, then look at the event. Ringer: change
/// the event, then look at `sleepers`. With a sequentially consistent fence between the two
/// steps on both sides, at least one of them sees the other ("store buffering" is excluded),
/// and because the waiter checks under the lock that the ringer takes, it cannot fall asleep
/// between the ringer's look and the notification.
#[derive(Debug, Default)]
pub(crate) struct Bell {
    sleepers: AtomicUsize,
    lock: Mutex<()>,
    wake: Condvar,
}

impl Bell {
    pub fn new() -> Self {
        Self { sleepers: AtomicUsize::new(0), lock: Mutex::new(()), wake: Condvar::new() }
    }

    /// Waits until `happened`; spins first only if `spin`.
    pub fn wait(&self, spin: bool, happened: impl Fn() -> bool) {
        // A model checker has no time to look at.
        let begun = (spin && !cfg!(loom)).then(Instant::now);
        while begun.is_some_and(|begun| begun.elapsed() < SPIN) {
            for _ in 0..CHECKS {
                if happened() {
                    return;
                }
                spin_loop();
            }
        }
        for _ in 0..YIELDS {
            if happened() {
                return;
            }
            yield_now();
        }
        self.sleepers.fetch_add(1, Ordering::Relaxed);
        fence(Ordering::SeqCst);
        let mut guard = self.lock.lock().unwrap_or_else(|e| e.into_inner());
        while !happened() {
            guard = self.wake.wait(guard).unwrap_or_else(|e| e.into_inner());
        }
        drop(guard);
        self.sleepers.fetch_sub(1, Ordering::Relaxed);
    }

    /// Wakes all sleepers; the event must have been stored before.
    pub fn ring(&self) {
        fence(Ordering::SeqCst);
        if self.sleepers.load(Ordering::Relaxed) > 0 {
            let _guard = self.lock.lock().unwrap_or_else(|e| e.into_inner());
            self.wake.notify_all();
        }
    }
}
