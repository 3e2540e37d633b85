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
    pub fn new(members: usize) -> Self {
        Self {
            members,
            spin: members <= super::cores(),
            arrived: CachePadded::new(AtomicUsize::new(0)),
            held: CachePadded::new(AtomicUsize::new(0)),
            bell: Bell::new(),
        }
    }

    /// Arrives and waits for the others; the last to arrive runs `last` first.
    pub fn arrive(&self, last: impl FnOnce()) {
        let held = self.held.load(Ordering::Relaxed);
        // AcqRel: the last to arrive acquires what all others released.
        if self.arrived.fetch_add(1, Ordering::AcqRel) + 1 == self.members {
            last();
            self.arrived.store(0, Ordering::Relaxed);
            self.held.store(held.wrapping_add(1), Ordering::Release);
            self.bell.ring();
        } else {
            self.bell.wait(self.spin, || self.held.load(Ordering::Acquire) != held);
        }
    }
}
