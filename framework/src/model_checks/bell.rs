//! Nobody sleeps through the bell.

use loom::sync::Arc;
use loom::sync::atomic::{AtomicUsize, Ordering};
use loom::thread;

use super::check;
use crate::dispatch::waiting::Bell;

/// The event is stored with no ordering stronger than release: the bell itself must make sure
/// that a waiter that has just looked is woken. A lost wake-up is a deadlock, which loom reports.
#[test]
fn a_waiter_wakes() {
    check(None, || {
        let shared = Arc::new((Bell::new(), AtomicUsize::new(0)));
        let ringer = {
            let shared = shared.clone();
            thread::spawn(move || {
                shared.1.store(1, Ordering::Release);
                shared.0.ring();
            })
        };
        shared.0.wait(false, || shared.1.load(Ordering::Acquire) == 1);
        ringer.join().unwrap();
    });
}

#[test]
fn two_waiters_wake() {
    check(Some(3), || {
        let shared = Arc::new((Bell::new(), AtomicUsize::new(0)));
        let waiters = [(); 2].map(|()| {
            let shared = shared.clone();
            thread::spawn(move || shared.0.wait(true, || shared.1.load(Ordering::Acquire) == 1))
        });
        shared.1.store(1, Ordering::Release);
        shared.0.ring();
        waiters.into_iter().for_each(|waiter| waiter.join().unwrap());
    });
}

/// The first ring is not the waiter's event; the second is.
#[test]
fn a_ring_for_somebody_else() {
    check(Some(3), || {
        let shared = Arc::new((Bell::new(), AtomicUsize::new(0)));
        let waiter = {
            let shared = shared.clone();
            thread::spawn(move || shared.0.wait(false, || shared.1.load(Ordering::Acquire) == 2))
        };
        for count in 1..=2 {
            shared.1.store(count, Ordering::Release);
            shared.0.ring();
        }
        waiter.join().unwrap();
    });
}
