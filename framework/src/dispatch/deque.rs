//! A work-stealing deque of sub-domains that never allocates after it is made.

use crossbeam_utils::CachePadded;

use crate::sync::{AtomicU32, AtomicUsize, Ordering, fence};

/// One worker pushes and pops at the bottom, last in, first out; all others steal at the top, the
/// oldest first.
///
/// Chase & Lev (2005) with the orderings of Lê, Pop, Cohen & Zappa Nardelli (2013), figure 1, on
/// a ring of fixed size: a sub-domain is ready at most once at a time, so there is always room. Only
/// that each store to `bottom` releases what came before, instead of a fence that stands for all of
/// them: thieves see as much, and race detectors, which know no fences, see it too.
#[derive(Debug, Default)]
pub(crate) struct Deque {
    top: CachePadded<AtomicUsize>,
    bottom: CachePadded<AtomicUsize>,
    /// A power of two of places.
    ring: Vec<AtomicU32>,
}

/// What came of stealing.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Steal {
    Value(u32),
    Empty,
    /// Somebody else was faster.
    Retry,
}

impl Deque {
    /// Empties it and makes room for `most` values at a time.
    pub fn reset(&mut self, most: usize) {
        self.top = CachePadded::new(AtomicUsize::new(0));
        self.bottom = CachePadded::new(AtomicUsize::new(0));
        self.ring.resize_with(most.next_power_of_two(), || AtomicU32::new(0));
    }

    /// The place of index `i`; indices count up for ever and wrap around both ring and `usize`.
    fn place(&self, i: usize) -> &AtomicU32 {
        &self.ring[i & (self.ring.len() - 1)]
    }

    /// Adds a value; only the owner may.
    pub fn push(&self, value: u32) {
        let bottom = self.bottom.load(Ordering::Relaxed);
        debug_assert!(
            bottom.wrapping_sub(self.top.load(Ordering::Acquire)) < self.ring.len(),
            "more values than sub-domains"
        );
        self.place(bottom).store(value, Ordering::Relaxed);
        self.bottom.store(bottom.wrapping_add(1), Ordering::Release);
    }

    /// Takes the newest value; only the owner may.
    pub fn pop(&self) -> Option<u32> {
        let bottom = self.bottom.load(Ordering::Relaxed);
        // Nobody but the owner adds, so what looks empty to it is.
        if bottom == self.top.load(Ordering::Relaxed) {
            return None;
        }
        let last = bottom.wrapping_sub(1);
        self.bottom.store(last, Ordering::Release);
        fence(Ordering::SeqCst);
        let top = self.top.load(Ordering::Relaxed);
        let left = last.wrapping_sub(top) as isize;
        if left > 0 {
            return Some(self.place(last).load(Ordering::Relaxed));
        }
        // The last value, or none: whoever moves `top` has it.
        let value = self.place(last).load(Ordering::Relaxed);
        let won = left == 0 && self.take_top(top);
        self.bottom.store(bottom, Ordering::Release);
        won.then_some(value)
    }

    /// Takes the oldest value; anybody may.
    pub fn steal(&self) -> Steal {
        let top = self.top.load(Ordering::Acquire);
        fence(Ordering::SeqCst);
        let bottom = self.bottom.load(Ordering::Acquire);
        if bottom.wrapping_sub(top) as isize <= 0 {
            return Steal::Empty;
        }
        // If the owner has put another value there meanwhile, `top` has moved.
        let value = self.place(top).load(Ordering::Relaxed);
        if self.take_top(top) { Steal::Value(value) } else { Steal::Retry }
    }

    fn take_top(&self, top: usize) -> bool {
        let next = top.wrapping_add(1);
        self.top.compare_exchange(top, next, Ordering::SeqCst, Ordering::Relaxed).is_ok()
    }

    /// Whether there was nothing to steal.
    pub fn is_empty(&self) -> bool {
        let top = self.top.load(Ordering::Acquire);
        fence(Ordering::SeqCst);
        self.bottom.load(Ordering::Acquire).wrapping_sub(top) as isize <= 0
    }
}
