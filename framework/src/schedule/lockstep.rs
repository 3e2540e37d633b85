//! Slave time loops with a common meeting (Fig. 4b): a part ends when Dispatch completes.

use super::order::Order;
use super::work::Work;
use crate::dispatch::Dispatch;
use crate::sync::{AtomicBool, Ordering};
use crate::team::Team;

pub(super) struct Lockstep {
    dispatch: Dispatch,
}

impl Lockstep {
    pub fn new(workers: usize) -> Self {
        Self { dispatch: Dispatch::new(0, 1, workers) }
    }

    pub fn run(&mut self, team: &mut Team, work: &dyn Work, order: &Order) {
        let sub_domains = work.partition().len();
        self.dispatch.reset(sub_domains, chunk(sub_domains, team.workers()));
        let dispatch = &self.dispatch;
        // Decided by one worker for all, inside the meeting: if each looked for itself, one could
        // leave while another waits for it.
        let stop = AtomicBool::new(false);
        team.run(|worker| {
            for step in work.steps() {
                for part in 0..work.parts() {
                    let fence = work.fence();
                    while let Some(places) = dispatch.request() {
                        for place in places {
                            work.run(worker, &fence, step, part, order.at(place));
                        }
                    }
                    drop(fence);
                    dispatch.complete(|| stop.store(work.failed(), Ordering::Relaxed));
                    if stop.load(Ordering::Relaxed) {
                        return;
                    }
                }
            }
        });
    }
}

/// Sub-domains per hand-out: one, unless there are so many that a worker would still ask a
/// hundred times if it took several at once. The imbalance at the end of a part stays within 1 %.
fn chunk(sub_domains: usize, workers: usize) -> usize {
    (sub_domains / (100 * workers)).clamp(1, 16)
}
