//! The deque: what is pushed comes out once, whoever takes it.

use loom::sync::Arc;
use loom::thread;

use super::check;
use crate::dispatch::deque::{Deque, Steal};

fn deque(most: usize) -> Arc<Deque> {
    let mut deque = Deque::default();
    deque.reset(most);
    Arc::new(deque)
}

fn steal(deque: &Deque) -> Option<u32> {
    loop {
        match deque.steal() {
            Steal::Value(value) => return Some(value),
            Steal::Empty => return None,
            Steal::Retry => thread::yield_now(),
        }
    }
}

/// The ring has two places, so the fourth value lies where the second was.
#[test]
fn the_owner_and_a_thief() {
    check(None, || {
        let deque = deque(2);
        let thief = {
            let deque = deque.clone();
            thread::spawn(move || [steal(&deque), steal(&deque)])
        };
        deque.push(1);
        deque.push(2);
        let mut taken = vec![deque.pop()];
        deque.push(3);
        taken.extend([deque.pop(), deque.pop(), deque.pop()]);
        taken.extend(thief.join().unwrap());
        let mut taken: Vec<_> = taken.into_iter().flatten().collect();
        taken.sort_unstable();
        assert_eq!(taken, [1, 2, 3]);
    });
}

#[test]
fn two_thieves() {
    check(Some(3), || {
        let deque = deque(2);
        let thieves = [(); 2].map(|()| {
            let deque = deque.clone();
            thread::spawn(move || steal(&deque))
        });
        deque.push(1);
        deque.push(2);
        let mut taken = vec![deque.pop(), deque.pop()];
        taken.extend(thieves.map(|thief| thief.join().unwrap()));
        let mut taken: Vec<_> = taken.into_iter().flatten().collect();
        taken.sort_unstable();
        assert_eq!(taken, [1, 2]);
    });
}
