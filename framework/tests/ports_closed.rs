//! A dead partner is noticed, not waited for: no arbiter hangs, no poster posts into the void.

use std::convert::Infallible;
use std::num::NonZeroUsize;
use std::thread;

use finegrain_framework::port::{
    Arbiter, Choice, Interleave, Join, MultipleItemReceive, Port, PostError, Receive,
};

#[test]
fn every_arbiter_ends_when_all_ports_are_dropped() {
    fn port() -> finegrain_framework::port::Inbox<u32> {
        Port::unbounded("dropped").1
    }
    let fine = |_| Ok::<_, Infallible>(());
    assert!(Receive::new(port(), fine).wait().is_none());
    assert!(Choice::new().on(port(), fine).on(port(), fine).wait().is_none());
    assert!(Join::new(port(), port(), |_, _| Ok::<_, Infallible>(())).wait().is_none());
    let three = NonZeroUsize::new(3).unwrap();
    let items = |_: Vec<u32>| Ok::<_, Infallible>(());
    assert!(MultipleItemReceive::new(port(), three, items).wait().is_none());

    let (failures, _inbox) = Port::unbounded("failures");
    let ended = Interleave::new((), failures)
        .threads(2)
        .concurrent(port(), |(), _| Ok::<_, Infallible>(()))
        .exclusive(port(), |(), _| Ok(()))
        .teardown(port(), |(), _| Ok(()))
        .run();
    assert_eq!((ended.handled, ended.failed, ended.result), (0, 0, None));
}

#[test]
fn messages_outlive_their_port() {
    let (port, inbox) = Port::unbounded("numbers");
    port.post(1).unwrap();
    port.clone().post(2).unwrap();
    drop(port);
    let mut receive = Receive::new(inbox, Ok::<u32, Infallible>);
    let numbers: Vec<_> = receive.events().map(Result::unwrap).collect();
    assert_eq!(numbers, [1, 2]);
}

#[test]
fn an_arbiter_that_sleeps_wakes_up_when_the_last_port_is_dropped() {
    let (port, inbox) = Port::<u32>::unbounded("numbers");
    let sleeper =
        thread::spawn(move || Receive::new(inbox, Ok::<u32, Infallible>).wait().is_none());
    drop(port);
    assert!(sleeper.join().unwrap());
}

#[test]
fn a_closed_inbox_refuses_but_keeps_what_it_accepted() {
    let (port, mut inbox) = Port::unbounded("numbers");
    port.post(1).unwrap();
    inbox.close();
    let refused = port.post(2).unwrap_err();
    assert_eq!(refused.to_string(), "port `numbers` is closed");
    assert_eq!(refused.into_message(), 2);
    assert_eq!(inbox.take(), Some(1));
    assert_eq!(inbox.take(), None);
}

#[test]
fn a_dropped_inbox_gives_the_message_back() {
    let (port, inbox) = Port::unbounded("numbers");
    drop(inbox);
    assert!(matches!(port.post(5), Err(PostError::Closed { message: 5, .. })));
    assert!(matches!(port.try_post(6), Err(PostError::Closed { message: 6, .. })));
}

#[test]
fn a_bounded_port_holds_its_poster_back() {
    let (port, mut inbox) = Port::bounded("dumps", 2);
    port.post(1).unwrap();
    port.post(2).unwrap();
    let full = port.try_post(3).unwrap_err();
    assert_eq!(full.to_string(), "port `dumps` is full");
    let poster = thread::spawn(move || port.post(full.into_message()));
    assert_eq!([inbox.take(), inbox.take(), inbox.take()], [Some(1), Some(2), Some(3)]);
    poster.join().unwrap().unwrap();
}
