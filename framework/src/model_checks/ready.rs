//! Dispatch of values that become ready: all are handed out, nobody sleeps through the end.

use loom::sync::atomic::{AtomicUsize, Ordering};
use loom::sync::{Arc, Mutex};
use loom::thread;

use super::check;
use crate::dispatch::{ReadyDispatch, Server};

struct Round {
    dispatch: ReadyDispatch,
    /// How often a value has been handed out.
    served: Vec<AtomicUsize>,
}

/// Values `0..at_start` are ready; each of them makes `value + at_start` ready, if there is one.
fn work(round: &Round, mut server: Server, at_start: usize) {
    while let Some(value) = round.dispatch.request(&mut server, |place| place as u32) {
        let value = value as usize;
        round.served[value].fetch_add(1, Ordering::Relaxed);
        if value < at_start && value + at_start < round.served.len() {
            round.dispatch.offer(&mut server, (value + at_start) as u32);
        } else {
            round.dispatch.finish();
        }
    }
}

fn distribute(workers: usize, at_start: usize, values: usize) {
    let (mut dispatch, servers) = ReadyDispatch::new(workers);
    dispatch.open(at_start);
    let served = (0..values).map(|_| AtomicUsize::new(0)).collect();
    let round = Arc::new(Round { dispatch, served });
    let workers: Vec<_> = servers
        .into_iter()
        .map(|server| {
            let round = round.clone();
            thread::spawn(move || work(&round, server, at_start))
        })
        .collect();
    workers.into_iter().for_each(|worker| worker.join().unwrap());
    assert!(round.served.iter().all(|count| count.load(Ordering::Relaxed) == 1));
}

#[test]
fn all_ready_at_the_start() {
    check(Some(3), || distribute(2, 3, 3));
}

/// With one value at the start, the other worker can only wait for what comes of it, or steal it.
#[test]
fn a_value_that_arrives_while_all_wait() {
    check(Some(3), || distribute(2, 1, 2));
}

#[test]
fn values_that_arrive_while_others_are_processed() {
    check(Some(2), || distribute(2, 2, 4));
}

#[test]
fn three_workers_and_one_value() {
    check(Some(2), || distribute(3, 1, 1));
}

/// Closed in the middle of it: everybody comes back, whatever is still to come.
#[test]
fn closed_before_the_end() {
    check(Some(3), || {
        let (mut dispatch, servers) = ReadyDispatch::new(2);
        dispatch.open(2);
        let shared = Arc::new((dispatch, Mutex::new(0)));
        let workers: Vec<_> = servers
            .into_iter()
            .map(|mut server| {
                let shared = shared.clone();
                thread::spawn(move || {
                    let dispatch = &shared.0;
                    while let Some(value) = dispatch.request(&mut server, |place| place as u32) {
                        *shared.1.lock().unwrap() += 1;
                        match value {
                            0 => dispatch.close(),
                            // Never finished: without the closing, all would wait for it.
                            _ => dispatch.offer(&mut server, 7),
                        }
                        if value == 7 {
                            return;
                        }
                    }
                })
            })
            .collect();
        workers.into_iter().for_each(|worker| worker.join().unwrap());
        assert!(*shared.1.lock().unwrap() >= 1);
    });
}
