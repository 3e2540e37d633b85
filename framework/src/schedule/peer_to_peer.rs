//! Slave time loops with peer-to-peer communication (Fig. 4c): no meeting inside a leg.
//!
//! Count a leg's parts through all its steps. Sub-domain `i` may run part `q` once it and all its
//! neighbours have finished part `q - 1`. Its permissions are counted down: `waiting[i]` holds
//! one counter for even and one for odd parts, because a neighbour can be at most one part ahead:
//!
//! * While `i` has not finished `q`, no neighbour can finish `q + 1` (it needs `i`'s part `q` to
//!   begin). So what arrives at `i` before it finishes `q` is permission for `q` or `q + 1`, and
//!   the two have different counters.
//! * Whoever brings a counter to zero offers `i` to Dispatch. `i` resets that counter, to be used
//!   for `q + 2`, before it runs `q`: permission for `q + 2` can come only from a neighbour that
//!   has finished `q + 1`, hence after `i` has finished `q`.
//!
//! The countdown releases what the finishing worker wrote and the last one acquires all of it
//! (read-modify-writes continue a release sequence), so a part sees all its neighbours' writes.

use crossbeam_utils::CachePadded;

use super::order::Order;
use super::work::Work;
use crate::dispatch::{ReadyDispatch, Server};
use crate::domain::Partition;
use crate::sync::{AtomicU32, Mutex, Ordering};
use crate::team::Team;

pub(crate) struct PeerToPeer {
    dispatch: ReadyDispatch,
    servers: Vec<CachePadded<Mutex<Server>>>,
    progress: Progress,
}

impl PeerToPeer {
    pub fn new(workers: usize) -> Self {
        let (dispatch, servers) = ReadyDispatch::new(workers);
        Self {
            dispatch,
            servers: servers.into_iter().map(|s| CachePadded::new(Mutex::new(s))).collect(),
            progress: Progress::default(),
        }
    }

    pub fn run(&mut self, team: &mut Team, work: &dyn Work, order: &Order) {
        let partition = work.partition();
        let parts = work.parts() as u32;
        let steps = work.steps();
        let all_parts = (steps.end - steps.start) as u32 * parts;
        let sub_domains = partition.len();
        if all_parts == 0 || sub_domains == 0 {
            return;
        }
        self.progress.reset(partition);
        self.dispatch.open(sub_domains);
        let (dispatch, progress, servers) = (&self.dispatch, &self.progress, &self.servers);
        team.run(|worker| {
            let mut server = servers[worker].lock().unwrap_or_else(|e| e.into_inner());
            while let Some(id) = dispatch.request(&mut server, |place| order.at(place) as u32) {
                let q = progress.begin(partition, id);
                let step = steps.start + u64::from(q / parts);
                work.run(worker, &work.fence(), step, (q % parts) as usize, id as usize);
                if work.failed() {
                    dispatch.close();
                }
                let is_last = q + 1 == all_parts;
                progress.end(partition, id, is_last, |ready| dispatch.offer(&mut server, ready));
                if is_last {
                    dispatch.finish();
                }
            }
        });
    }
}

/// How far every sub-domain is, and what it still waits for.
#[derive(Default)]
pub(crate) struct Progress {
    sub_domains: Vec<Counters>,
}

struct Counters {
    /// Parts begun.
    begun: AtomicU32,
    /// Permissions still missing for the next even and the next odd part.
    waiting: [AtomicU32; 2],
}

impl Progress {
    /// Everybody is ready for part 0.
    pub fn reset(&mut self, partition: &Partition) {
        self.sub_domains.resize_with(partition.len(), || Counters {
            begun: AtomicU32::new(0),
            waiting: [AtomicU32::new(0), AtomicU32::new(0)],
        });
        for (id, counters) in self.sub_domains.iter_mut().enumerate() {
            let all = permissions(partition, id);
            counters.begun = AtomicU32::new(0);
            counters.waiting = [AtomicU32::new(0), AtomicU32::new(all)];
        }
    }

    /// `id`, which is ready, begins its next part; returns the part.
    pub fn begin(&self, partition: &Partition, id: u32) -> u32 {
        let counters = &self.sub_domains[id as usize];
        // Only the worker that was handed `id` touches `begun`; the hand-out orders it.
        let q = counters.begun.load(Ordering::Relaxed);
        counters.begun.store(q + 1, Ordering::Relaxed);
        let all = permissions(partition, id as usize);
        counters.waiting[(q % 2) as usize].store(all, Ordering::Relaxed);
        q
    }

    /// `id` has finished the part it began: gives permission for the next one to itself and to
    /// its neighbours, and names whoever thereby became ready. After a leg's last part nobody
    /// waits for permission any more.
    pub fn end(&self, partition: &Partition, id: u32, is_last: bool, mut ready: impl FnMut(u32)) {
        if is_last {
            return;
        }
        let q = self.sub_domains[id as usize].begun.load(Ordering::Relaxed);
        let parity = (q % 2) as usize;
        let mut permit = |to: u32| {
            let waiting = &self.sub_domains[to as usize].waiting[parity];
            if waiting.fetch_sub(1, Ordering::AcqRel) == 1 {
                ready(to);
            }
        };
        // Itself last: if that makes it ready, it is taken first, with its data still in cache.
        for &neighbour in partition.neighbours(id as usize) {
            permit(neighbour);
        }
        permit(id);
    }
}

/// Permissions that a sub-domain needs for a part: its own and its neighbours'.
fn permissions(partition: &Partition, id: usize) -> u32 {
    partition.neighbours(id).len() as u32 + 1
}
