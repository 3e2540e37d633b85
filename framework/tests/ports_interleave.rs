//! An interleave runs exclusive handlers alone, concurrent ones beside one another, and its
//! teardown last.

use std::convert::Infallible;
use std::sync::Barrier;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::thread;

use finegrain_framework::port::{Interleave, Port};

#[test]
fn exclusive_never_overlaps() {
    const ROUNDS: usize = 2000;
    let (failures, mut reports) = Port::unbounded("failures");
    let (reads, read_inbox) = Port::unbounded("reads");
    let (writes, write_inbox) = Port::unbounded("writes");
    let (readers, writers) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let interleave: Interleave<u64, (), Infallible> = Interleave::new(0, failures)
        .threads(4)
        .concurrent(read_inbox, |&writes_so_far, writes_posted| {
            readers.fetch_add(1, Ordering::SeqCst);
            assert_eq!(writers.load(Ordering::SeqCst), 0);
            assert_eq!(writes_so_far, writes_posted, "taken in the order of posting");
            readers.fetch_sub(1, Ordering::SeqCst);
            Ok(())
        })
        .exclusive(write_inbox, |count, ()| {
            assert_eq!(writers.fetch_add(1, Ordering::SeqCst), 0);
            assert_eq!(readers.load(Ordering::SeqCst), 0);
            *count += 1;
            writers.fetch_sub(1, Ordering::SeqCst);
            Ok(())
        });
    let ended = thread::scope(|scope| {
        scope.spawn(move || {
            for round in 0..ROUNDS {
                (0..3).for_each(|_| reads.post(round as u64).unwrap());
                writes.post(()).unwrap();
            }
        });
        interleave.run()
    });
    assert!(reports.try_take().is_none());
    assert_eq!(ended.handled, 4 * ROUNDS as u64);
}

/// Two handlers that wait for each other can only both finish if they run side by side.
#[test]
fn concurrent_handlers_do_run_beside_one_another() {
    let (failures, _reports) = Port::unbounded("failures");
    let (meetings, inbox) = Port::unbounded("meetings");
    let barrier = Barrier::new(2);
    (0..10).for_each(|_| meetings.post(()).unwrap());
    drop(meetings);
    let ended = Interleave::<_, (), Infallible>::new((), failures)
        .threads(2)
        .concurrent(inbox, |(), ()| {
            barrier.wait();
            Ok(())
        })
        .run();
    assert_eq!((ended.handled, ended.failed), (10, 0));
}

#[test]
fn teardown_runs_last_and_consumes_the_state() {
    let (failures, _reports) = Port::unbounded("failures");
    let (dumps, dump_inbox) = Port::unbounded("dumps");
    let (ticks, tick_inbox) = Port::unbounded("ticks");
    let (finish, finish_inbox) = Port::unbounded("finish");
    let ticked = AtomicU64::new(0);
    (0..5).for_each(|n| dumps.post(n).unwrap());
    (0..7).for_each(|n| ticks.post(n).unwrap());
    finish.post("done").unwrap();
    // Still accepted, as the interleave has not begun: so it is handled, before the teardown.
    dumps.post(5).unwrap();
    let ended = Interleave::new(Vec::new(), failures)
        .threads(3)
        .teardown(finish_inbox, |written: Vec<u32>, word| {
            Ok((word, written, ticked.load(Ordering::SeqCst)))
        })
        .exclusive(dump_inbox, |written, n| {
            written.push(n);
            Ok::<_, Infallible>(())
        })
        .concurrent(tick_inbox, |_, _: i32| {
            ticked.fetch_add(1, Ordering::SeqCst);
            Ok(())
        })
        .run();
    assert_eq!(ended.result, Some(("done", vec![0, 1, 2, 3, 4, 5], 7)));
    assert_eq!((ended.handled, ended.failed), (14, 0));
    assert!(dumps.post(6).is_err() && ticks.post(8).is_err() && finish.post("again").is_err());
}

/// Posters that race with the teardown: what they were told was accepted, was handled.
#[test]
fn nothing_accepted_is_lost_at_teardown() {
    for capacity in [None, Some(1)] {
        let (failures, _reports) = Port::unbounded("failures");
        let (work, work_inbox) = capacity
            .map_or_else(|| Port::unbounded("work"), |capacity| Port::bounded("work", capacity));
        let (finish, finish_inbox) = Port::unbounded("finish");
        let interleave = Interleave::new(0, failures)
            .exclusive(work_inbox, |done, ()| {
                *done += 1;
                Ok::<_, Infallible>(())
            })
            .teardown(finish_inbox, |done, ()| Ok(done));
        let (accepted, ended) = thread::scope(|scope| {
            let posters = [(); 3].map(|()| {
                let work = work.clone();
                scope.spawn(move || (0_u64..).find(|_| work.post(()).is_err()).unwrap_or(0))
            });
            scope.spawn(move || {
                (0..100).for_each(|_| work.post(()).unwrap());
                finish.post(()).unwrap();
            });
            let ended = interleave.run();
            let accepted: u64 = posters.into_iter().map(|poster| poster.join().unwrap()).sum();
            (accepted + 100, ended)
        });
        assert_eq!(ended.result, Some(accepted));
    }
}
