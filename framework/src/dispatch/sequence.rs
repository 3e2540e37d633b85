//! Dispatch of values that are all known from the start: the sub-domains of one part.

use std::ops::Range;

use crossbeam_utils::CachePadded;

use super::Meeting;
use crate::sync::{AtomicUsize, Ordering};

/// Hands out `0..values` in ascending chunks to `workers` workers, again and again.
///
/// One round: every worker calls [`Dispatch::request`] until it gets `None`, then
/// [`Dispatch::complete`]. After `complete` returns, all values of the round have been
/// processed and the next round may begin.
#[derive(Debug)]
pub struct Dispatch {
    next: CachePadded<AtomicUsize>,
    values: usize,
    chunk: usize,
    meeting: Meeting,
}

impl Dispatch {
    /// Dispatch of `values` values, `chunk` at a time.
    ///
    /// # Panics
    /// If `chunk` or `workers` is 0.
    pub fn new(values: usize, chunk: usize, workers: usize) -> Self {
        assert!(chunk > 0 && workers > 0);
        Self {
            next: CachePadded::new(AtomicUsize::new(0)),
            values,
            chunk,
            meeting: Meeting::new(workers),
        }
    }

    /// Changes the values to hand out, between rounds.
    pub fn reset(&mut self, values: usize, chunk: usize) {
        assert!(chunk > 0);
        self.values = values;
        self.chunk = chunk;
        self.next.store(0, Ordering::Relaxed);
    }

    /// The next values for the worker that asks; `None` once all are handed out.
    #[inline]
    pub fn request(&self) -> Option<Range<usize>> {
        // Relaxed: the values carry no data; what processing them reads was made visible by the
        // meeting before.
        let start = self.next.fetch_add(self.chunk, Ordering::Relaxed);
        (start < self.values).then(|| start..(start + self.chunk).min(self.values))
    }

    /// To be called by every worker that came back unserved; returns once all have. The last
    /// one runs `last` before anybody goes on.
    pub fn complete(&self, last: impl FnOnce()) {
        self.meeting.arrive(|| {
            self.next.store(0, Ordering::Relaxed);
            last();
        });
    }
}
