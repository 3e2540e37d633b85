//! A multiple-item receive runs its handler once exactly n messages are there.

use std::convert::Infallible;
use std::num::NonZeroUsize;
use std::thread;

use finegrain_framework::port::{Arbiter, Failure, MultipleItemReceive, Port};

const THREE: NonZeroUsize = NonZeroUsize::new(3).unwrap();

#[test]
fn fires_exactly_at_n() {
    let (port, inbox) = Port::unbounded("reports");
    let mut all = MultipleItemReceive::new(inbox, THREE, Ok::<Vec<u32>, Infallible>);
    port.post(0).unwrap();
    port.post(1).unwrap();
    assert!(all.try_wait().is_none(), "two of three");
    (2..7).for_each(|n| port.post(n).unwrap());
    assert_eq!(all.try_wait().unwrap().unwrap(), [0, 1, 2]);
    assert_eq!(all.wait().unwrap().unwrap(), [3, 4, 5]);
    assert!(all.try_wait().is_none(), "one of the next three");
}

#[test]
fn waits_until_all_workers_have_reported() {
    let (port, inbox) = Port::unbounded("reports");
    for worker in 0..3 {
        let port = port.clone();
        thread::spawn(move || port.post(worker).unwrap());
    }
    let mut all = MultipleItemReceive::new(inbox, THREE, Ok::<Vec<u32>, Infallible>);
    let mut workers = all.wait().unwrap().unwrap();
    workers.sort_unstable();
    assert_eq!(workers, [0, 1, 2]);
}

#[test]
fn a_worker_that_died_is_noticed() {
    let (port, inbox) = Port::unbounded("reports");
    for worker in 0..3 {
        let port = port.clone();
        thread::spawn(move || {
            if worker != 1 {
                port.post(worker).unwrap();
            }
        });
    }
    drop(port);
    let mut all = MultipleItemReceive::new(inbox, THREE, Ok::<Vec<u32>, Infallible>);
    let failure = all.wait().unwrap().unwrap_err();
    assert!(matches!(failure, Failure::Incomplete { expected: 3, found: 2, .. }));
    assert_eq!(failure.to_string(), "port `reports` closed with 2 of the 3 messages waited for");
    assert!(all.wait().is_none());
}
