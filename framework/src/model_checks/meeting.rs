//! A meeting: nobody leaves before all have arrived, all see what all did.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use loom::cell::UnsafeCell;
use loom::sync::Arc;
use loom::thread;

use super::check;
use crate::dispatch::Meeting;

struct Room {
    meeting: Meeting,
    seats: Vec<UnsafeCell<usize>>,
    minutes: UnsafeCell<usize>,
}

// SAFETY: that these accesses are ordered is what is checked.
unsafe impl Sync for Room {}
// SAFETY: as for `Sync`.
unsafe impl Send for Room {}

impl Room {
    /// A meeting whose last to arrive panics once it has written the minutes; whether that was this one.
    fn attend_panic(&self, round: usize) -> bool {
        let arrive = || {
            self.meeting.arrive(|| {
                // SAFETY: all others wait.
                self.minutes.with_mut(|minutes| unsafe { *minutes += 1 });
                resume_unwind(Box::new(round));
            });
        };
        let panicked = catch_unwind(AssertUnwindSafe(arrive)).is_err();
        // SAFETY: nobody writes before the next meeting.
        let minutes = self.minutes.with(|minutes| unsafe { *minutes });
        assert_eq!(minutes, round);
        self.meeting.arrive(|| {});
        panicked
    }

    /// In every round each member writes its seat, the last to arrive writes the minutes, and
    /// then all read everything.
    fn attend(&self, member: usize, rounds: usize) {
        for round in 1..=rounds {
            // SAFETY: its own seat, which others read only between the two meetings.
            self.seats[member].with_mut(|seat| unsafe { *seat = round });
            self.meeting.arrive(|| {
                // SAFETY: all others wait.
                self.minutes.with_mut(|minutes| unsafe { *minutes += 1 });
            });
            // SAFETY: nobody writes before the next meeting.
            let minutes = self.minutes.with(|minutes| unsafe { *minutes });
            assert_eq!(minutes, round, "the action runs once, before anybody leaves");
            for seat in &self.seats {
                // SAFETY: as above.
                assert_eq!(seat.with(|seat| unsafe { *seat }), round);
            }
            self.meeting.arrive(|| {});
        }
    }
}

fn room(members: usize) -> Arc<Room> {
    Arc::new(Room {
        meeting: Meeting::new(members),
        seats: (0..members).map(|_| UnsafeCell::new(0)).collect(),
        minutes: UnsafeCell::new(0),
    })
}

fn meet(members: usize, rounds: usize) {
    let room = room(members);
    let others: Vec<_> = (1..members)
        .map(|member| {
            let room = room.clone();
            thread::spawn(move || room.attend(member, rounds))
        })
        .collect();
    room.attend(0, rounds);
    others.into_iter().for_each(|other| other.join().unwrap());
}

#[test]
fn two_members_again_and_again() {
    check(Some(3), || meet(2, 2));
}

#[test]
fn three_members() {
    check(Some(2), || meet(3, 1));
}

/// The others leave as if nothing had happened, and meet again.
#[test]
fn a_last_that_panics() {
    check(Some(3), || {
        let room = room(2);
        let other = {
            let room = room.clone();
            thread::spawn(move || [1, 2].map(|round| room.attend_panic(round)))
        };
        let here = [1, 2].map(|round| room.attend_panic(round));
        let there = other.join().unwrap();
        assert!((0..2).all(|round| here[round] != there[round]), "one a round");
    });
}

/// By the time it arrives, the other has gone to sleep.
#[test]
fn a_slow_member() {
    check(Some(2), || {
        let room = room(2);
        let other = {
            let room = room.clone();
            thread::spawn(move || room.attend(1, 1))
        };
        (0..4).for_each(|_| thread::yield_now());
        room.attend(0, 1);
        other.join().unwrap();
    });
}
