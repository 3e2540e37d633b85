//! What a trace says happened is what must have: every part of every sub-domain once, on a worker that
//! did nothing else meanwhile, and after what it depends on.

mod models;

use std::collections::HashMap;

use finegrain_framework::trace::Event;
use finegrain_framework::*;
use models::heat::heat;
use models::particles::Swarm;

const STEPS: u64 = 7;

fn traced(schedule: Schedule, workers: usize, trace: usize) -> Simulation<space::Grid> {
    let settings = Settings { schedule, workers, trace, ..Settings::default() };
    let mut simulation = Simulation::new(heat([40, 33, 12], true, [4, 4], 2), settings).unwrap();
    simulation.advance(3).unwrap();
    simulation.advance(STEPS - 3).unwrap();
    simulation
}

#[test]
fn every_part_is_there_once_and_after_those_it_needs() {
    for schedule in Schedule::ALL {
        let simulation = traced(schedule, 3, 10_000);
        let trace = simulation.trace().unwrap();
        assert_eq!(trace.workers(), if schedule == Schedule::Serial { 1 } else { 3 });
        let parts = trace.parts().len() as u64;
        assert_eq!(parts, 2, "{:?}", trace.parts());
        let mut by_place: HashMap<(u64, u32), Event> = HashMap::new();
        for worker in 0..trace.workers() {
            let events = trace.events(worker);
            assert!(events.iter().all(|event| event.begin <= event.end));
            // rayon may run one part inside another.
            let is_in_turn = events.windows(2).all(|pair| pair[0].end <= pair[1].begin);
            assert!(is_in_turn || schedule == Schedule::ForkJoin);
            for event in events {
                let place = (event.step * parts + u64::from(event.part), event.sub_domain);
                assert!(by_place.insert(place, event).is_none(), "{schedule}: {place:?} twice");
            }
        }
        let partition = simulation.domain().partition();
        assert_eq!(by_place.len() as u64, STEPS * parts * partition.len() as u64, "{schedule}");
        for (&(q, id), event) in by_place.iter().filter(|((q, _), _)| *q > 0) {
            for &neighbour in partition.neighbours(id as usize) {
                let before = by_place[&(q - 1, neighbour)];
                assert!(before.end <= event.begin, "{schedule}: part {q} of {id} came too early");
            }
        }
    }
}

#[test]
fn the_shares_of_a_worker_are_all_of_its_time() {
    for schedule in [Schedule::Lockstep, Schedule::PeerToPeer, Schedule::Fixed] {
        let simulation = traced(schedule, 2, 10_000);
        let trace = simulation.trace().unwrap();
        let summary = trace.summary();
        let legs: f64 = trace.legs().iter().map(|leg| 1e-9 * (leg.end - leg.begin) as f64).sum();
        for (worker, shares) in summary.workers.iter().enumerate() {
            let events = trace.events(worker);
            let busy: f64 = events.iter().map(|s| 1e-9 * (s.end - s.begin) as f64).sum();
            assert!((shares.busy - busy).abs() < 1e-12);
            assert!(shares.hand_out >= 0.0 && shares.waiting >= 0.0);
            let all = shares.busy + shares.hand_out + shares.waiting;
            assert!((all - legs).abs() < 1e-9, "{schedule}: {all} of {legs}");
        }
        assert!((summary.seconds - summary.between - legs).abs() < 1e-9);
        let largest = summary.largest.unwrap();
        assert!(largest.over_mean >= 1.0 && largest.seconds > 0.0);
        assert!((0.0..=1.0 + 1e-12).contains(&summary.balance()));
    }
}

#[test]
fn a_small_ring_remembers_the_last() {
    let simulation = traced(Schedule::Serial, 1, 10);
    let trace = simulation.trace().unwrap();
    let events = trace.events(0);
    assert_eq!(events.len(), 10);
    let last = simulation.domain().partition().len() as u32 - 1;
    for (k, event) in events.iter().rev().enumerate() {
        assert_eq!((event.step, event.part, event.sub_domain), (STEPS - 1, 1, last - k as u32));
    }
    assert_eq!(trace.summary().workers[0].parts, 10);
}

#[test]
fn nothing_is_recorded_unless_asked_for() {
    assert!(traced(Schedule::Lockstep, 2, 0).trace().is_none());
}

#[test]
fn what_sorts_is_traced_by_the_numbers_of_its_time() {
    let (size, periodic) = ([2.0, 1.0], [true, true]);
    let swarm = Swarm { points: 203, size, periodic, range: 0.1, block_points: 8 };
    let settings = Settings { workers: 2, trace: 100_000, ..Settings::default() };
    let mut simulation = Simulation::new(swarm.model(), settings).unwrap();
    simulation.advance(20).unwrap();
    let trace = simulation.trace().unwrap();
    let steps: Vec<u64> = (0..2).flat_map(|w| trace.events(w)).map(|event| event.step).collect();
    assert!((0..20).all(|step| steps.contains(&step)));
    assert!(trace.summary().between > 0.0);
}

#[test]
fn what_a_step_costs_is_known_for_every_part_of_every_sub_domain() {
    let simulation = traced(Schedule::Lockstep, 2, 10_000);
    let workload = Workload::of(&simulation).unwrap();
    let partition = simulation.domain().partition();
    assert_eq!(workload.parts.len(), 2);
    for part in &workload.parts {
        let PartCost::SubDomains(costs) = part else { panic!("{part:?}") };
        assert_eq!(costs.len(), partition.len());
        assert!(costs.iter().all(|&cost| cost > 0.0));
    }
    assert_eq!(workload.neighbours.len(), partition.len());
    assert_eq!(workload.neighbours[3], partition.neighbours(3));
    // Two legs, of which the second begins with step 3.
    assert_eq!(workload.steps_per_leg, 3.0);
    assert!(workload.between > 0.0 && workload.seconds() > workload.between);
    let columns = simulation.columns();
    assert!(workload.bytes >= 8 * columns.points() * columns.iter().count());
}

#[test]
fn without_enough_of_a_trace_nothing_is_known_of_what_a_step_costs() {
    assert_eq!(Workload::of(&traced(Schedule::Lockstep, 2, 0)), None);
    assert_eq!(Workload::of(&traced(Schedule::Lockstep, 2, 5)), None);
}
