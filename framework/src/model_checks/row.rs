//! Sub-domains in a row, whose memory the model checker watches.

use loom::cell::UnsafeCell;
use loom::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use crate::domain::{Partition, Span};
use crate::pack::Fence;
use crate::schedule::Work;

/// A rate part and an update part on a row of sub-domains of one point each.
///
/// The state is an age, the rate the common age of the neighbourhood plus one. Every access goes
/// through loom's cells: one that is not ordered after the write it should see, or beside a write
/// that it should not meet, is reported.
pub struct Row {
    partition: Partition,
    steps: u64,
    state: Vec<UnsafeCell<u64>>,
    rate: Vec<UnsafeCell<u64>>,
    runs: AtomicUsize,
    /// Which part of which step of which sub-domain fails.
    fails: Option<(u64, usize, usize)>,
    failed: AtomicBool,
    /// A worker that takes long over every part.
    slow: Option<usize>,
}

// SAFETY: that these accesses are ordered is what is checked.
unsafe impl Sync for Row {}

impl Row {
    pub fn new(length: usize, steps: u64, fails: Option<(u64, usize, usize)>) -> Self {
        let mut partition = Partition::new(length);
        for id in 0..length {
            let near = [id.checked_sub(1), (id + 1 < length).then_some(id + 1)];
            let near = near.into_iter().flatten().map(|id| id as u32);
            partition.push([Span { start: id, end: id + 1 }], near);
        }
        partition.seal().unwrap();
        let cells = || (0..length).map(|_| UnsafeCell::new(0)).collect();
        Self {
            partition,
            steps,
            state: cells(),
            rate: cells(),
            runs: AtomicUsize::new(0),
            fails,
            failed: AtomicBool::new(false),
            slow: None,
        }
    }

    /// Worker `worker` takes long over every part.
    pub fn slowed(mut self, worker: usize) -> Self {
        self.slow = Some(worker);
        self
    }

    /// To be asked when the schedule has come back.
    pub fn assert_done(&self) {
        for state in &self.state {
            // SAFETY: nobody works any more.
            assert_eq!(state.with(|age| unsafe { *age }), self.steps);
        }
        let parts = self.partition.len() * self.parts() * self.steps as usize;
        assert_eq!(self.runs.load(Ordering::Relaxed), parts, "every part runs once");
    }
}

impl Work for Row {
    fn parts(&self) -> usize {
        2
    }

    fn partition(&self) -> &Partition {
        &self.partition
    }

    fn steps(&self) -> std::ops::Range<u64> {
        0..self.steps
    }

    fn fence(&self) -> Fence {
        Fence::new(false)
    }

    fn run(&self, worker: usize, _: &Fence, step: u64, part: usize, id: usize) {
        if self.failed() {
            return;
        }
        if self.slow == Some(worker) {
            (0..3).for_each(|_| loom::thread::yield_now());
        }
        self.runs.fetch_add(1, Ordering::Relaxed);
        if self.fails == Some((step, part, id)) {
            self.failed.store(true, Ordering::Release);
            return;
        }
        if part == 0 {
            let near = self.partition.neighbours(id).iter().map(|&n| n as usize);
            for seen in near.chain([id]) {
                // SAFETY: the schedule's promise, which is what is checked.
                let age = self.state[seen].with(|age| unsafe { *age });
                assert_eq!(age, step, "sub-domain {id} sees {seen}");
            }
            // SAFETY: as above.
            self.rate[id].with_mut(|rate| unsafe { *rate = step + 1 });
        } else {
            // SAFETY: as above.
            let rate = self.rate[id].with(|rate| unsafe { *rate });
            assert_eq!(rate, step + 1);
            // SAFETY: as above.
            self.state[id].with_mut(|age| unsafe { *age = rate });
        }
    }

    fn failed(&self) -> bool {
        self.failed.load(Ordering::Acquire)
    }
}
