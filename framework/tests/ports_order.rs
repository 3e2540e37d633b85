//! Messages come out in the order in which they went in.

use std::convert::Infallible;
use std::iter;
use std::thread;

use finegrain_framework::port::{Arbiter, Choice, Port, Receive};

const MESSAGES: u32 = 100_000;

#[test]
fn one_port_is_first_in_first_out() {
    let (port, inbox) = Port::unbounded("numbers");
    let poster = thread::spawn(move || (0..MESSAGES).for_each(|n| port.post(n).unwrap()));
    let mut expected = 0..;
    let mut receive = Receive::new(inbox, |n| {
        assert_eq!(Some(n), expected.next());
        Ok::<_, Infallible>(())
    });
    let handled = receive.events().map(Result::unwrap).count();
    assert_eq!(handled, MESSAGES as usize);
    poster.join().unwrap();
}

/// One thread posts to two ports in turn: the choice sees its order of posting, even when both
/// messages come while it is looking at its ports. (So it looks without rest, and pair after pair.)
#[test]
fn a_choice_keeps_the_order_of_posting_over_its_ports() {
    let (first, first_inbox) = Port::unbounded("first");
    let (second, second_inbox) = Port::unbounded("second");
    let (next, mut nexts) = Port::unbounded("next");
    let mut choice = Choice::new().on(first_inbox, Ok::<u32, Infallible>).on(second_inbox, Ok);
    let poster = thread::spawn(move || {
        for pair in 0..MESSAGES / 2 {
            first.post(2 * pair).unwrap();
            second.post(2 * pair + 1).unwrap();
            nexts.take().unwrap();
        }
    });
    for n in 0..MESSAGES {
        let seen = iter::repeat_with(|| choice.try_wait()).flatten().next();
        assert_eq!(seen.unwrap().unwrap(), n);
        if n % 2 == 1 {
            next.post(()).unwrap();
        }
    }
    poster.join().unwrap();
}

#[test]
fn every_message_of_many_posters_comes_once() {
    let (port, mut inbox) = Port::bounded("numbers", 3);
    let posters: Vec<_> = (0..4)
        .map(|poster| {
            let port = port.clone();
            thread::spawn(move || (0..1000).for_each(|n| port.post((poster, n)).unwrap()))
        })
        .collect();
    drop(port);
    let mut next = [0; 4];
    while let Some((poster, n)) = inbox.take() {
        assert_eq!(n, next[poster], "each poster's messages keep their order");
        next[poster] += 1;
    }
    assert_eq!(next, [1000; 4]);
    posters.into_iter().for_each(|poster| poster.join().unwrap());
}
