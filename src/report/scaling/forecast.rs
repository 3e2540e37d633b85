//! How long a step would take on more workers: Dispatch simulated event by event with the measured cost of
//! every sub-domain, of a hand-out and of a meeting.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, VecDeque};

use finegrain_framework::{PartCost, Schedule, Workload};

/// What scheduling itself costs, measured with some workers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overheads {
    /// Number of workers of the measurement.
    pub workers: usize,
    /// Time of a worker from one sub-domain to the next, s.
    pub hand_out: f64,
    /// Time of a meeting of these workers, s.
    pub meeting: f64,
}

impl Overheads {
    /// A meeting of so many workers: all count themselves in one place, one after the other.
    fn meeting_of(&self, workers: usize) -> f64 {
        if workers == 1 { 0.0 } else { self.meeting * workers as f64 / self.workers as f64 }
    }

    /// Time for which one hand-out keeps others from Dispatch's one counter.
    fn counter(&self) -> f64 {
        self.hand_out / self.workers as f64
    }
}

/// Seconds a step takes on `workers` workers, whole-domain work between legs apart; `None` for schedules
/// that are not ours.
pub fn seconds_per_step(
    load: &Workload,
    schedule: Schedule,
    workers: usize,
    overheads: &Overheads,
) -> Option<f64> {
    let meeting = overheads.meeting_of(workers);
    let by_parts = |time_of: &dyn Fn(&[f64]) -> f64| {
        let part = |part: &PartCost| match part {
            PartCost::SubDomains(costs) => time_of(costs) + meeting,
            PartCost::Whole(cost) => *cost,
        };
        load.parts.iter().map(part).sum()
    };
    match schedule {
        Schedule::Serial => Some(by_parts(&|costs| costs.iter().sum())),
        Schedule::Lockstep => Some(by_parts(&|costs| dispatched(costs, workers, overheads))),
        Schedule::Fixed => Some(by_parts(&|costs| in_equal_shares(costs, workers))),
        Schedule::PeerToPeer => Some(peer_to_peer(load, workers, overheads)),
        Schedule::ForkJoin => None,
    }
}

/// Time until all sub-domains are done, each handed to whoever comes first, in order.
fn dispatched(costs: &[f64], workers: usize, overheads: &Overheads) -> f64 {
    // As `Lockstep` does it.
    let chunk = (costs.len() / (100 * workers)).clamp(1, 16);
    let mut free: BinaryHeap<_> = (0..workers).map(|_| Reverse(Time(0.0))).collect();
    let (mut counter, mut end) = (0.0, 0.0f64);
    for chunk in costs.chunks(chunk) {
        let Some(Reverse(Time(asked))) = free.pop() else { break };
        let served = f64::max(asked, counter);
        counter = served + overheads.counter();
        let done = served + overheads.hand_out + chunk.iter().sum::<f64>();
        end = end.max(done);
        free.push(Reverse(Time(done)));
    }
    end
}

/// Time until all sub-domains are done, of which every worker has as many, decided beforehand.
fn in_equal_shares(costs: &[f64], workers: usize) -> f64 {
    let count = costs.len();
    let share = |worker| &costs[count * worker / workers..count * (worker + 1) / workers];
    (0..workers).map(|worker| share(worker).iter().sum()).fold(0.0, f64::max)
}

/// Time of a step where a sub-domain goes on as soon as its neighbours have.
fn peer_to_peer(load: &Workload, workers: usize, overheads: &Overheads) -> f64 {
    let parts: Vec<Option<&[f64]>> = load
        .parts
        .iter()
        .map(|part| match part {
            PartCost::SubDomains(costs) => Some(costs.as_slice()),
            PartCost::Whole(_) => None,
        })
        .collect();
    let meeting = overheads.meeting_of(workers);
    if parts.iter().all(Option::is_some) {
        let steps = load.steps_per_leg.round().clamp(1.0, 64.0);
        let once: Vec<_> = parts.into_iter().flatten().collect();
        let leg = once.repeat(steps as usize);
        return (Leg::new(&leg, &load.neighbours, workers).run(overheads) + meeting) / steps;
    }
    // Whole-domain stages cut a step into stretches.
    let stretches = parts.split(Option::is_none).filter(|stretch| !stretch.is_empty());
    let stretch = |stretch: &[Option<&[f64]>]| {
        let parts: Vec<_> = stretch.iter().copied().flatten().collect();
        Leg::new(&parts, &load.neighbours, workers).run(overheads) + meeting
    };
    let whole = load.parts.iter().map(|part| match part {
        PartCost::Whole(cost) => *cost,
        PartCost::SubDomains(_) => 0.0,
    });
    stretches.map(stretch).sum::<f64>() + whole.sum::<f64>()
}

/// A leg of `PeerToPeer`, as its module in the framework tells it.
struct Leg<'a> {
    /// Costs of every sub-domain, part after part.
    parts: &'a [&'a [f64]],
    neighbours: &'a [Vec<u32>],
    /// Parts that each sub-domain has finished.
    finished: Vec<usize>,
    /// Neighbours, itself included, that have yet to finish the part before its next even and odd one.
    missing: Vec<[usize; 2]>,
    /// What each worker has made ready, and the sub-domains that it begins with.
    ready: Vec<Vec<usize>>,
    stretches: Vec<VecDeque<usize>>,
}

impl<'a> Leg<'a> {
    fn new(parts: &'a [&'a [f64]], neighbours: &'a [Vec<u32>], workers: usize) -> Self {
        let count = neighbours.len();
        let stretch = |worker| count * worker / workers..count * (worker + 1) / workers;
        Self {
            parts,
            neighbours,
            finished: vec![0; count],
            missing: neighbours.iter().map(|near| [near.len() + 1; 2]).collect(),
            ready: vec![Vec::new(); workers],
            stretches: (0..workers).map(|worker| stretch(worker).collect()).collect(),
        }
    }

    /// Time until it is done.
    fn run(mut self, overheads: &Overheads) -> f64 {
        let workers = self.ready.len();
        // When whom is done with which sub-domain.
        let mut busy: BinaryHeap<Reverse<(Time, usize, usize)>> = BinaryHeap::new();
        let mut idle: Vec<usize> = (0..workers).rev().collect();
        let mut now = 0.0;
        loop {
            let mut waiting = Vec::new();
            while let Some(worker) = idle.pop() {
                match self.take(worker) {
                    Some(id) => {
                        let cost = self.parts[self.finished[id]][id] + overheads.hand_out;
                        busy.push(Reverse((Time(now + cost), worker, id)));
                    }
                    None => waiting.push(worker),
                }
            }
            idle = waiting;
            let Some(Reverse((Time(time), worker, id))) = busy.pop() else { return now };
            now = time;
            self.finish(worker, id);
            idle.push(worker);
        }
    }

    /// What a worker is handed: what it made ready last, its next place, the oldest of another, the far
    /// end of another's stretch.
    fn take(&mut self, worker: usize) -> Option<usize> {
        let workers = self.ready.len();
        if let Some(id) = self.ready[worker].pop().or_else(|| self.stretches[worker].pop_front()) {
            return Some(id);
        }
        let mut others = (1..workers).map(|k| (worker + k) % workers);
        if let Some(other) = others.clone().find(|&other| !self.ready[other].is_empty()) {
            return Some(self.ready[other].remove(0));
        }
        let other = others.find(|&other| !self.stretches[other].is_empty())?;
        self.stretches[other].pop_back()
    }

    fn finish(&mut self, worker: usize, id: usize) {
        self.finished[id] += 1;
        let next = self.finished[id];
        if next == self.parts.len() {
            return;
        }
        let neighbours = self.neighbours;
        for to in neighbours[id].iter().map(|&to| to as usize).chain([id]) {
            let missing = &mut self.missing[to][next % 2];
            *missing -= 1;
            if *missing == 0 {
                *missing = neighbours[to].len() + 1;
                self.ready[worker].push(to);
            }
        }
    }
}

/// A time, s, that can be put in order.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Time(f64);

impl Eq for Time {}

impl Ord for Time {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Time {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FREE: Overheads = Overheads { workers: 2, hand_out: 0.0, meeting: 0.0 };

    /// A ring of sub-domains with two parts a step.
    fn ring(costs: Vec<f64>) -> Workload {
        let count = costs.len() as u32;
        let neighbours = (0..count).map(|i| {
            let mut near = vec![(i + count - 1) % count, (i + 1) % count];
            near.sort_unstable();
            near
        });
        Workload {
            neighbours: neighbours.collect(),
            parts: vec![PartCost::SubDomains(costs.clone()), PartCost::SubDomains(costs)],
            between: 0.0,
            steps_per_leg: 8.0,
            bytes: 0,
        }
    }

    fn step(load: &Workload, schedule: Schedule, workers: usize, overheads: &Overheads) -> f64 {
        seconds_per_step(load, schedule, workers, overheads).unwrap()
    }

    const OURS: [Schedule; 3] = [Schedule::Lockstep, Schedule::Fixed, Schedule::PeerToPeer];

    #[test]
    fn equal_costs_are_shared_evenly() {
        let load = ring(vec![1.0; 64]);
        for schedule in OURS {
            for workers in [1, 2, 4, 8, 16] {
                let time = step(&load, schedule, workers, &FREE);
                assert!(
                    (time * workers as f64 / 128.0 - 1.0).abs() < 0.13,
                    "{schedule} {workers}: {time}"
                );
            }
        }
        assert_eq!(step(&load, Schedule::Lockstep, 64, &FREE), 2.0);
        assert_eq!(step(&load, Schedule::Lockstep, 128, &FREE), 2.0);
    }

    #[test]
    fn no_worker_does_two_things_at_once_and_nothing_begins_too_early() {
        let costs: Vec<f64> = (0..50).map(|i| 1.0 + f64::from(i * 37 % 11)).collect();
        let (all, largest) = (2.0 * costs.iter().sum::<f64>(), 2.0 * 11.0);
        let load = ring(costs);
        for schedule in OURS {
            let mut before = f64::INFINITY;
            for workers in [1, 2, 3, 5, 8, 40, 60] {
                let time = step(&load, schedule, workers, &FREE);
                assert!(time >= (all / workers as f64).max(largest) - 1e-9, "{schedule} {workers}");
                assert!(time <= before * 1.01, "{schedule} {workers}: {time} after {before}");
                before = time;
            }
        }
        assert!((step(&load, Schedule::Fixed, 1, &FREE) - all).abs() < 1e-9);
    }

    #[test]
    fn events_balance_what_equal_shares_do_not() {
        // The first quarter is ten times as expensive.
        let load = ring((0..64).map(|i| if i < 16 { 10.0 } else { 1.0 }).collect());
        let [lockstep, fixed, peers] = OURS.map(|schedule| step(&load, schedule, 4, &FREE));
        assert_eq!(fixed, 320.0);
        assert!(lockstep < 0.36 * fixed && peers < 0.36 * fixed, "{lockstep} {peers} {fixed}");
    }

    #[test]
    fn without_meetings_a_slow_part_is_overtaken() {
        // One sub-domain of as many as there are workers is slow: the others' next parts are not, but
        // for its neighbours'.
        let mut costs = vec![1.0; 8];
        costs[0] = 1.5;
        let load = ring(costs);
        let overheads = Overheads { meeting: 0.5, ..FREE };
        let [lockstep, _, peers] = OURS.map(|schedule| step(&load, schedule, 8, &overheads));
        assert!((lockstep - 2.0 * (1.5 + 2.0)).abs() < 1e-9, "{lockstep}");
        assert!(peers < lockstep - 2.0, "{peers} {lockstep}");
    }

    #[test]
    fn scheduling_costs_what_it_costs() {
        let load = ring(vec![1.0; 64]);
        let overheads = Overheads { workers: 2, hand_out: 0.25, meeting: 0.5 };
        let on_one = step(&load, Schedule::Lockstep, 1, &overheads);
        assert!((on_one - 2.0 * 64.0 * 1.25).abs() < 1e-9, "{on_one}");
        // All want one at the same time, of which every one keeps the counter for an eighth.
        let on_all = step(&load, Schedule::Lockstep, 64, &overheads);
        assert!((on_all - 2.0 * (63.0 * 0.125 + 1.25 + 16.0)).abs() < 1e-9, "{on_all}");
    }

    #[test]
    fn whole_domain_stages_keep_all_workers() {
        let mut load = ring(vec![1.0; 64]);
        load.parts.insert(1, PartCost::Whole(5.0));
        for schedule in OURS {
            let time = step(&load, schedule, 4, &FREE);
            assert!((time - (32.0 + 5.0)).abs() < 1e-9, "{schedule}: {time}");
        }
        assert_eq!(seconds_per_step(&load, Schedule::ForkJoin, 4, &FREE), None);
    }
}
