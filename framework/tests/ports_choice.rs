//! A choice runs the handler of the port on which the message arrived.

use std::convert::Infallible;
use std::thread;

use finegrain_framework::port::{Arbiter, Choice, Port};

#[derive(Debug, PartialEq)]
enum Event {
    Stop,
    Checkpoint(String),
}

#[test]
fn the_port_chooses_the_handler() {
    let (stop, stops) = Port::unbounded("stop");
    let (checkpoint, requests) = Port::unbounded("checkpoint");
    let mut control = Choice::new()
        .on(stops, |()| Ok::<_, Infallible>(Event::Stop))
        .on(requests, |path: &str| Ok(Event::Checkpoint(path.to_string())));

    assert!(control.try_wait().is_none(), "nothing was posted: nothing waits");
    checkpoint.post("first").unwrap();
    stop.post(()).unwrap();
    checkpoint.post("second").unwrap();
    let events: Vec<Event> = control.pending().map(Result::unwrap).collect();
    assert_eq!(
        events,
        [Event::Checkpoint("first".into()), Event::Stop, Event::Checkpoint("second".into())]
    );
}

#[test]
fn a_sleeping_choice_wakes_up_for_any_port() {
    let (numbers, number_inbox) = Port::unbounded("numbers");
    let (words, word_inbox) = Port::unbounded("words");
    let (heard, mut echoes) = Port::unbounded("heard");
    let listener = thread::spawn(move || {
        let mut choice = Choice::new()
            .on(number_inbox, |n: u32| Ok::<_, Infallible>(n.to_string()))
            .on(word_inbox, |word: String| Ok(word));
        for event in choice.events() {
            heard.post(event.unwrap()).unwrap();
        }
    });
    // One message at a time: the listener has gone back to sleep, or is about to.
    for _ in 0..100 {
        words.post("word".to_string()).unwrap();
        assert_eq!(echoes.take().as_deref(), Some("word"));
        numbers.post(7).unwrap();
        assert_eq!(echoes.take().as_deref(), Some("7"));
    }
    drop((numbers, words));
    assert_eq!(echoes.take(), None);
    listener.join().unwrap();
}

#[test]
fn one_closed_port_leaves_the_others_open() {
    let (numbers, number_inbox) = Port::unbounded("numbers");
    let (words, word_inbox) = Port::<&str>::unbounded("words");
    let mut sum = 0;
    let mut choice = Choice::new()
        .on(number_inbox, |n: u32| {
            sum += n;
            Ok::<_, Infallible>(())
        })
        .on(word_inbox, |_| Ok(()));
    drop(words);
    numbers.post(1).unwrap();
    assert!(choice.wait().is_some());
    numbers.post(2).unwrap();
    assert!(choice.wait().is_some());
    drop(numbers);
    assert!(choice.wait().is_none());
    drop(choice);
    assert_eq!(sum, 3);
}
