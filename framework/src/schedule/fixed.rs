//! Equal shares of sub-domains, decided beforehand: predictive balance, to compare with.

use super::order::Order;
use super::work::Work;
use crate::dispatch::Meeting;
use crate::sync::{AtomicBool, Ordering};
use crate::team::Team;

pub(super) struct Fixed {
    meeting: Meeting,
}

impl Fixed {
    pub fn new(workers: usize) -> Self {
        Self { meeting: Meeting::new(workers) }
    }

    pub fn run(&mut self, team: &mut Team, work: &dyn Work, order: &Order) {
        let (sub_domains, workers) = (work.partition().len(), team.workers());
        let stop = AtomicBool::new(false);
        let meeting = &self.meeting;
        team.run(|worker| {
            let share = sub_domains * worker / workers..sub_domains * (worker + 1) / workers;
            for step in work.steps() {
                for part in 0..work.parts() {
                    let fence = work.fence();
                    for place in share.clone() {
                        work.run(worker, &fence, step, part, order.at(place));
                    }
                    drop(fence);
                    meeting.arrive(|| stop.store(work.failed(), Ordering::Relaxed));
                    if stop.load(Ordering::Relaxed) {
                        return;
                    }
                }
            }
        });
    }
}
