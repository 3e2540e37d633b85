//! A join waits for a message on each of its two ports.

use std::convert::Infallible;
use std::thread;

use finegrain_framework::port::{Arbiter, Failure, Join, Port};

#[test]
fn a_pair_needs_both() {
    let (numbers, number_inbox) = Port::unbounded("numbers");
    let (words, word_inbox) = Port::unbounded("words");
    let mut join = Join::new(number_inbox, word_inbox, |n: u32, word: &str| {
        Ok::<_, Infallible>(format!("{n} {word}"))
    });
    assert!(join.try_wait().is_none());
    numbers.post(1).unwrap();
    numbers.post(2).unwrap();
    assert!(join.try_wait().is_none(), "one side only");
    words.post("one").unwrap();
    assert_eq!(join.try_wait().unwrap().unwrap(), "1 one");
    assert!(join.try_wait().is_none(), "2 still waits for its word");
    words.post("two").unwrap();
    assert_eq!(join.wait().unwrap().unwrap(), "2 two");
}

#[test]
fn a_sleeping_join_wakes_up_whichever_comes_last() {
    let (left, left_inbox) = Port::unbounded("left");
    let (right, right_inbox) = Port::unbounded("right");
    let (sums, mut sum_inbox) = Port::unbounded("sums");
    let joiner = thread::spawn(move || {
        let mut join = Join::new(left_inbox, right_inbox, |a: u32, b: u32| {
            sums.post(a + b).unwrap();
            Ok::<_, Infallible>(())
        });
        join.events().map(Result::unwrap).count()
    });
    left.post(1).unwrap();
    right.post(2).unwrap();
    assert_eq!(sum_inbox.take(), Some(3));
    right.post(3).unwrap();
    left.post(4).unwrap();
    assert_eq!(sum_inbox.take(), Some(7));
    drop((left, right));
    assert_eq!(joiner.join().unwrap(), 2);
}

#[test]
fn a_pair_that_can_never_be_is_a_failure() {
    let (numbers, number_inbox) = Port::unbounded("numbers");
    let (words, word_inbox) = Port::<&str>::unbounded("words");
    let mut join = Join::new(number_inbox, word_inbox, |_: u32, _| Ok::<_, Infallible>(()));
    numbers.post(1).unwrap();
    drop(words);
    let failure = join.wait().unwrap().unwrap_err();
    assert!(matches!(failure, Failure::Incomplete { ref port, .. } if port == "words"));
    assert!(join.wait().is_none());
    assert!(numbers.post(2).is_err());
}

/// The port that is still open may never get a message: the join must not wait for it.
#[test]
fn a_closed_side_ends_a_join_that_waits_for_the_other() {
    let (numbers, number_inbox) = Port::<u32>::unbounded("numbers");
    let (words, word_inbox) = Port::<&str>::unbounded("words");
    let mut join = Join::new(number_inbox, word_inbox, |_, _| Ok::<_, Infallible>(()));
    drop(words);
    assert!(join.wait().is_none());
    assert!(numbers.post(1).is_err());
}
