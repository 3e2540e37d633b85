//! A team: every member runs every task, the caller comes back after all, and it ends.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use loom::sync::atomic::{AtomicUsize, Ordering};

use super::check;
use crate::team::Team;

#[test]
fn every_member_runs_every_task() {
    check(Some(3), || {
        let mut team = Team::new(2).unwrap();
        for _ in 0..2 {
            let ran = [AtomicUsize::new(0), AtomicUsize::new(0)];
            team.run(|worker| {
                ran[worker].fetch_add(1, Ordering::Relaxed);
            });
            // The task is gone after this; relaxed is enough, since `run` has ordered it all.
            assert!(ran.iter().all(|ran| ran.load(Ordering::Relaxed) == 1));
        }
    });
}

#[test]
fn chunks_of_a_slice() {
    check(Some(2), || {
        let mut team = Team::new(2).unwrap();
        let mut data = [0; 3];
        team.for_each_chunk(&mut data, 2, |k, chunk| chunk.fill(k + 1));
        assert_eq!(data, [1, 1, 2]);
    });
}

#[test]
fn three_members() {
    check(Some(1), || {
        let mut team = Team::new(3).unwrap();
        let ran = AtomicUsize::new(0);
        team.run(|_| {
            ran.fetch_add(1, Ordering::Relaxed);
        });
        assert_eq!(ran.load(Ordering::Relaxed), 3);
    });
}

/// Whoever panics, the caller hears of it when all have come back, and the team goes on.
#[test]
fn a_task_that_panics() {
    for panics in [[true, false], [false, true], [true, true]] {
        check(Some(2), move || {
            let mut team = Team::new(2).unwrap();
            let ran = AtomicUsize::new(0);
            let task = |worker: usize| {
                ran.fetch_add(1, Ordering::Relaxed);
                if panics[worker] {
                    // Without the message that a `panic!` prints, in every interleaving.
                    resume_unwind(Box::new(worker));
                }
            };
            let panic = catch_unwind(AssertUnwindSafe(|| team.run(task))).unwrap_err();
            assert!(panic.downcast_ref::<usize>().is_some_and(|&worker| panics[worker]));
            assert_eq!(ran.load(Ordering::Relaxed), 2);
            team.run(|_| {
                ran.fetch_add(1, Ordering::Relaxed);
            });
            assert_eq!(ran.load(Ordering::Relaxed), 4);
        });
    }
}
