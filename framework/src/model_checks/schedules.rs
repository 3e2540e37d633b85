//! Whole legs under every schedule that is not rayon's.

use super::check;
use super::row::Row;
use crate::schedule::{Executor, HandOut, Schedule};

fn run(schedule: Schedule, workers: usize, row: Row) -> Row {
    let mut executor = Executor::new(schedule, workers, HandOut::Natural).unwrap();
    executor.run(&row);
    row
}

#[test]
fn lockstep() {
    check(Some(3), || run(Schedule::Lockstep, 2, Row::new(3, 2, None)).assert_done());
}

#[test]
fn fixed() {
    check(Some(3), || run(Schedule::Fixed, 2, Row::new(3, 2, None)).assert_done());
}

#[test]
fn peer_to_peer() {
    check(Some(3), || run(Schedule::PeerToPeer, 2, Row::new(3, 1, None)).assert_done());
    check(Some(2), || run(Schedule::PeerToPeer, 2, Row::new(3, 2, None)).assert_done());
}

/// A sub-domain may be two parts ahead of one that it does not see.
#[test]
fn peer_to_peer_on_a_longer_row() {
    check(Some(2), || run(Schedule::PeerToPeer, 2, Row::new(4, 2, None)).assert_done());
}

#[test]
fn peer_to_peer_with_more_workers() {
    check(Some(1), || run(Schedule::PeerToPeer, 3, Row::new(2, 1, None)).assert_done());
}

/// Two legs with the same executor: nothing of the first is left to disturb the second.
#[test]
fn peer_to_peer_again() {
    check(Some(2), || {
        let mut executor = Executor::new(Schedule::PeerToPeer, 2, HandOut::Natural).unwrap();
        for _ in 0..2 {
            let row = Row::new(2, 1, None);
            executor.run(&row);
            row.assert_done();
        }
    });
}

/// Whoever fails, wherever, everybody comes back; and the next leg is not disturbed.
#[test]
fn failures() {
    for schedule in [Schedule::Lockstep, Schedule::Fixed, Schedule::PeerToPeer] {
        for part in 0..2 {
            check(Some(2), move || {
                let mut executor = Executor::new(schedule, 2, HandOut::Natural).unwrap();
                executor.run(&Row::new(2, 2, Some((0, part, 0))));
                let row = Row::new(2, 1, None);
                executor.run(&row);
                row.assert_done();
            });
        }
    }
}

/// Whoever is slow, the other waits for it, or does its share.
#[test]
fn a_slow_worker() {
    for schedule in [Schedule::Lockstep, Schedule::Fixed, Schedule::PeerToPeer] {
        for worker in 0..2 {
            check(Some(1), move || {
                run(schedule, 2, Row::new(3, 1, None).slowed(worker)).assert_done();
            });
        }
    }
}
