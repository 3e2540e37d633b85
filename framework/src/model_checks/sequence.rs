//! Dispatch of known values: each is handed out once a round, and all are processed before the
//! next.

use loom::cell::UnsafeCell;
use loom::sync::Arc;
use loom::thread;

use super::check;
use crate::dispatch::Dispatch;

struct Values {
    dispatch: Dispatch,
    processed: Vec<UnsafeCell<usize>>,
}

// SAFETY: that these accesses are ordered is what is checked.
unsafe impl Sync for Values {}
// SAFETY: as for `Sync`.
unsafe impl Send for Values {}

impl Values {
    fn work(&self, rounds: usize) {
        for round in 0..rounds {
            while let Some(values) = self.dispatch.request() {
                for value in values {
                    // SAFETY: a value is handed out once a round.
                    self.processed[value].with_mut(|count| unsafe { *count += 1 });
                }
            }
            self.dispatch.complete(|| {
                for count in &self.processed {
                    // SAFETY: everybody came back unserved.
                    assert_eq!(count.with(|count| unsafe { *count }), round + 1);
                }
            });
        }
    }
}

fn rounds(workers: usize, values: usize, chunk: usize, rounds: usize) {
    let shared = Arc::new(Values {
        dispatch: Dispatch::new(values, chunk, workers),
        processed: (0..values).map(|_| UnsafeCell::new(0)).collect(),
    });
    let others: Vec<_> = (1..workers)
        .map(|_| {
            let shared = shared.clone();
            thread::spawn(move || shared.work(rounds))
        })
        .collect();
    shared.work(rounds);
    others.into_iter().for_each(|other| other.join().unwrap());
}

#[test]
fn two_rounds() {
    check(Some(3), || rounds(2, 2, 1, 2));
}

#[test]
fn chunks_that_do_not_divide() {
    check(Some(3), || rounds(2, 3, 2, 1));
}

#[test]
fn more_workers_than_values() {
    check(Some(2), || rounds(3, 1, 1, 1));
}
