//! A meeting: nobody leaves before all have arrived, all see what all did.

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

fn meet(members: usize, rounds: usize) {
    let room = Arc::new(Room {
        meeting: Meeting::new(members),
        seats: (0..members).map(|_| UnsafeCell::new(0)).collect(),
        minutes: UnsafeCell::new(0),
    });
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
