//! An error or a panic in a handler reaches the coordinator, and the messages after it are handled.

use std::io;
use std::num::NonZeroUsize;

use finegrain_framework::port::{
    Arbiter, Choice, Ended, Failure, Interleave, Join, MultipleItemReceive, Port, Receive,
};

/// Fails for 1, panics for 2, and doubles the rest.
fn handler(n: u32) -> Result<u32, io::Error> {
    match n {
        1 => Err(io::Error::other("disk full")),
        2 => panic!("no {n}"),
        _ => Ok(2 * n),
    }
}

fn text(outcome: Result<u32, Failure<io::Error>>) -> String {
    outcome.map_or_else(|failure| failure.to_string(), |n| n.to_string())
}

fn texts(mut arbiter: impl Arbiter<Output = u32, Error = io::Error>) -> Vec<String> {
    arbiter.events().map(text).collect()
}

#[test]
fn receive_and_choice_go_on() {
    let expected = [
        "0",
        "the handler of port `jobs` failed",
        "the handler of port `jobs` panicked: no 2",
        "6",
    ];
    let (port, inbox) = Port::unbounded("jobs");
    (0..4).for_each(|n| port.post(n).unwrap());
    drop(port);
    assert_eq!(texts(Receive::new(inbox, handler)), expected);

    let (port, inbox) = Port::unbounded("jobs");
    (0..4).for_each(|n| port.post(n).unwrap());
    drop(port);
    assert_eq!(texts(Choice::new().on(inbox, handler)), expected);
}

#[test]
fn join_and_multiple_item_receive_go_on() {
    let (left, left_inbox) = Port::unbounded("left");
    let (right, right_inbox) = Port::unbounded("right");
    (2..4).for_each(|n| left.post(n).and(right.post(0)).unwrap());
    drop((left, right));
    let join = Join::new(left_inbox, right_inbox, |n, _: u32| handler(n));
    let panicked = "the handler of port `left + right` panicked: no 2";
    assert_eq!(texts(join), [panicked, "6"]);

    let (port, inbox) = Port::unbounded("jobs");
    (0..4).for_each(|n| port.post(n).unwrap());
    drop(port);
    let pairs =
        MultipleItemReceive::new(inbox, NonZeroUsize::new(2).unwrap(), |items: Vec<u32>| {
            handler(items.into_iter().sum())
        });
    assert_eq!(texts(pairs), ["the handler of port `jobs` failed", "10"]);
}

#[test]
fn the_source_of_an_error_is_kept() {
    let (port, inbox) = Port::unbounded("jobs");
    port.post(1).unwrap();
    let failure = Receive::new(inbox, handler).wait().unwrap().unwrap_err();
    let source = std::error::Error::source(&failure).unwrap();
    assert_eq!(source.to_string(), "disk full");
}

#[test]
fn an_interleave_reports_and_goes_on() {
    for threads in [1, 3] {
        let (failures, mut reports) = Port::unbounded("failures");
        let (reads, read_inbox) = Port::unbounded("reads");
        let (writes, write_inbox) = Port::unbounded("writes");
        let (finish, finish_inbox) = Port::unbounded("finish");
        for n in 0..4 {
            reads.post(n).unwrap();
            writes.post(n).unwrap();
        }
        finish.post(()).unwrap();
        let ended = Interleave::new(0, failures)
            .threads(threads)
            .concurrent(read_inbox, |_, n| handler(n).map(drop))
            .exclusive(write_inbox, |sum, n| handler(n).map(|double| *sum += double))
            .teardown(finish_inbox, |sum, ()| Ok(sum))
            .run();
        let expected = Ended { handled: 5, failed: 4, result: Some(6) };
        assert_eq!(ended, expected);
        let mut told = std::iter::from_fn(|| reports.take())
            .map(|failure| failure.to_string())
            .collect::<Vec<_>>();
        told.sort();
        assert_eq!(
            told,
            [
                "the handler of port `reads` failed",
                "the handler of port `reads` panicked: no 2",
                "the handler of port `writes` failed",
                "the handler of port `writes` panicked: no 2",
            ]
        );
    }
}

#[test]
fn a_teardown_that_panics_is_reported_and_counted_when_nobody_listens() {
    let (failures, reports) = Port::unbounded("failures");
    let (finish, finish_inbox) = Port::unbounded("finish");
    finish.post(2).unwrap();
    drop(reports);
    let ended = Interleave::new((), failures).teardown(finish_inbox, |(), n| handler(n)).run();
    assert_eq!((ended.failed, ended.result), (1, None));
}
