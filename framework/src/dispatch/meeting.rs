//! Where all workers meet.

use crossbeam_utils::CachePadded;

use super::waiting::Bell;
use crate::sync::{AtomicUsize, Ordering};

/// A reusable meeting of a fixed number of workers.
///
/// Everything that any worker did before it arrived is visible to every worker that has left.
/// The last to arrive runs an action before anybody leaves: what it changes, all see alike.
#[derive(Debug)]
pub struct Meeting {
    members: usize,
    spin: bool,
    arrived: CachePadded<AtomicUsize>,
    held: CachePadded<AtomicUsize>,
    bell: Bell,
}

impl Meeting {
    /// A meeting of `members` workers. They spin for a moment before they sleep only if every
    /// one of them can have a core of its own.
    ///
    /// # Panics
    /// If `members` is 0.
    pub fn new(members: usize) -> Self {
        assert!(members > 0, "a meeting needs at least one member");
        Self {
            members,
            spin: members <= super::cores(),
            arrived: CachePadded::new(AtomicUsize::new(0)),
            held: CachePadded::new(AtomicUsize::new(0)),
            bell: Bell::new(),
        }
    }

    /// Arrives and waits for the others; the last to arrive runs `last` first.
    ///
    /// # Panics
    /// If `last` does, in the one that ran it; the others leave as if it had returned.
    pub fn arrive(&self, last: impl FnOnce()) {
        let held = self.held.load(Ordering::Relaxed);
        // AcqRel: the last to arrive acquires what all others released.
        if self.arrived.fetch_add(1, Ordering::AcqRel) + 1 == self.members {
            let _door = Door { meeting: self, next: held.wrapping_add(1) };
            last();
        } else {
            self.bell.wait(self.spin, || self.held.load(Ordering::Acquire) != held);
        }
    }
}

/// Lets everybody leave when it is dropped, by a panic too: nobody waits for what never comes.
struct Door<'a> {
    meeting: &'a Meeting,
    next: usize,
}

impl Drop for Door<'_> {
    fn drop(&mut self) {
        self.meeting.arrived.store(0, Ordering::Relaxed);
        self.meeting.held.store(self.next, Ordering::Release);
        self.meeting.bell.ring();
    }
}

#[cfg(all(test, not(loom)))]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use super::*;

    #[test]
    fn a_panic_of_the_last_keeps_nobody() {
        let meeting = Meeting::new(3);
        let panics = std::sync::atomic::AtomicUsize::new(0);
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| {
                    for _ in 0..10 {
                        let arrive = || meeting.arrive(|| panic!("the last"));
                        if catch_unwind(AssertUnwindSafe(arrive)).is_err() {
                            panics.fetch_add(1, Ordering::Relaxed);
                        }
                    }
                });
            }
        });
        assert_eq!(panics.into_inner(), 10, "one a round");
    }
}
