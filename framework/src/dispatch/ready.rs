//! Dispatch of values that become ready while others are processed.

use crossbeam_utils::CachePadded;

use super::deque::{Deque, Steal};
use super::waiting::Bell;
use crate::sync::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

/// Hands out values that arrive while others are being processed.
///
/// Places `0..n` of some order are ready from the start; every worker begins with its own stretch
/// of them. What becomes ready later goes to the worker that made it ready, last in, first out
/// (it is warmest in its cache), and is taken before the next place. A worker without work takes
/// the oldest ready value of another, or the far end of its stretch. The end is not when no value
/// waits but when [`ReadyDispatch::finish`] has been called for all that were announced.
#[derive(Debug)]
pub struct ReadyDispatch {
    /// What became ready, by the worker that made it so.
    ready: Vec<Deque>,
    stretches: Vec<CachePadded<Stretch>>,
    /// Finished sub-domains still missing.
    missing: CachePadded<AtomicUsize>,
    closed: AtomicBool,
    spin: bool,
    bell: Bell,
}

/// One worker's end of a [`ReadyDispatch`]: whoever has it may put ready values in the worker's
/// deque and take them out again at the same end.
#[derive(Debug)]
pub struct Server {
    worker: usize,
}

impl ReadyDispatch {
    /// A dispatch and the ends for `workers` workers.
    pub fn new(workers: usize) -> (Self, Vec<Server>) {
        let servers = (0..workers).map(|worker| Server { worker }).collect();
        let dispatch = Self {
            ready: (0..workers).map(|_| Deque::default()).collect(),
            stretches: (0..workers).map(|_| CachePadded::default()).collect(),
            missing: CachePadded::new(AtomicUsize::new(0)),
            closed: AtomicBool::new(true),
            spin: workers <= super::cores(),
            bell: Bell::new(),
        };
        (dispatch, servers)
    }

    /// Places `0..values` are ready, and [`ReadyDispatch::finish`] will be called `values` times
    /// before the end. Nobody may be requesting meanwhile.
    pub fn open(&mut self, values: usize) {
        let workers = self.stretches.len();
        self.ready.iter_mut().for_each(|ready| ready.reset(values));
        for (worker, stretch) in self.stretches.iter().enumerate() {
            stretch.set(values * worker / workers, values * (worker + 1) / workers);
        }
        self.missing.store(values, Ordering::Relaxed);
        self.closed.store(values == 0, Ordering::Relaxed);
    }

    /// Puts a ready value where `server`'s worker will take it first. No more values may be ready at
    /// once than were announced to [`ReadyDispatch::open`]: there is room for so many.
    ///
    /// # Panics
    /// In debug builds, if there are more; in others, values are lost.
    #[inline]
    pub fn offer(&self, server: &mut Server, value: u32) {
        self.ready[server.worker].push(value);
        if self.ready.len() > 1 {
            self.bell.ring();
        }
    }

    /// One announced value is done for good; the last one ends the distribution.
    pub fn finish(&self) {
        if self.missing.fetch_sub(1, Ordering::AcqRel) == 1 {
            self.close();
        }
    }

    /// Ends the distribution now, whatever is still to come.
    pub fn close(&self) {
        self.closed.store(true, Ordering::Release);
        self.bell.ring();
    }

    /// The next value for a worker, where `value_at` tells the value at a place; waits for one to
    /// arrive, `None` at the end.
    #[inline]
    pub fn request(&self, server: &mut Server, value_at: impl Fn(usize) -> u32) -> Option<u32> {
        loop {
            if self.closed.load(Ordering::Acquire) {
                return None;
            }
            if let Some(value) = self.ready[server.worker].pop() {
                return Some(value);
            }
            if let Some(place) = self.stretches[server.worker].first() {
                return Some(value_at(place));
            }
            if let Some(value) = self.steal(server) {
                return Some(value);
            }
            if let Some(place) = self.stretches.iter().find_map(|s| s.last()) {
                return Some(value_at(place));
            }
            self.bell.wait(self.spin, || {
                self.closed.load(Ordering::Acquire)
                    || self.ready.iter().any(|ready| !ready.is_empty())
            });
        }
    }

    fn steal(&self, server: &Server) -> Option<u32> {
        let workers = self.ready.len();
        (1..workers).find_map(|k| {
            let victim = &self.ready[(server.worker + k) % workers];
            loop {
                match victim.steal() {
                    Steal::Value(value) => return Some(value),
                    Steal::Empty => return None,
                    Steal::Retry => {}
                }
            }
        })
    }
}

/// What is left of a worker's stretch of places: its first in the low half, its end in the high.
#[derive(Debug)]
struct Stretch(AtomicU64);

impl Default for Stretch {
    fn default() -> Self {
        Self(AtomicU64::new(0))
    }
}

impl Stretch {
    fn set(&self, first: usize, end: usize) {
        let packed = first as u64 | (end as u64) << 32;
        self.0.store(packed, Ordering::Relaxed);
    }

    /// Takes the first place: the owner's side.
    fn first(&self) -> Option<usize> {
        self.take(|first, end| (first, (first + 1, end)))
    }

    /// Takes the last place: the others' side.
    fn last(&self) -> Option<usize> {
        self.take(|first, end| (end - 1, (first, end - 1)))
    }

    fn take(&self, split: impl Fn(u64, u64) -> (u64, (u64, u64))) -> Option<usize> {
        // Relaxed: a place carries no data; what it reads was made visible by the team's meeting.
        let mut packed = self.0.load(Ordering::Relaxed);
        loop {
            let (first, end) = (packed & 0xffff_ffff, packed >> 32);
            if first >= end {
                return None;
            }
            let (place, (first, end)) = split(first, end);
            match self.0.compare_exchange_weak(
                packed,
                first | end << 32,
                Ordering::Relaxed,
                Ordering::Relaxed,
            ) {
                Ok(_) => return Some(place as usize),
                Err(now) => packed = now,
            }
        }
    }
}
