//! What scheduling itself costs here.

use std::hint::black_box;
use std::io;
use std::time::Instant;

use finegrain_framework::Team;
use finegrain_framework::dispatch::{Dispatch, Meeting};

/// Tasks or meetings of a sample.
const COUNT: usize = 2000;

/// Time of a worker, of so many, from one empty task to the next, s.
///
/// # Errors
/// If the system refuses threads.
pub fn hand_out(workers: usize) -> io::Result<f64> {
    let mut team = Team::new(workers)?;
    let dispatch = Dispatch::new(COUNT, 1, workers);
    let best = best(100, || {
        team.run(|_| {
            while let Some(tasks) = dispatch.request() {
                for task in tasks {
                    black_box(task);
                }
            }
            dispatch.complete(|| {});
        });
    });
    Ok(best * workers as f64 / COUNT as f64)
}

/// Time of a meeting of so many workers, s.
///
/// # Errors
/// If the system refuses threads.
pub fn meeting(workers: usize) -> io::Result<f64> {
    let mut team = Team::new(workers)?;
    let meeting = Meeting::new(workers);
    let best = best(100, || {
        team.run(|_| {
            for _ in 0..COUNT {
                meeting.arrive(|| {});
            }
        });
    });
    Ok(best / COUNT as f64)
}

/// Bytes a second that so many workers together read from one place and write to another, of arrays that
/// take `bytes` in all.
///
/// # Errors
/// If the system refuses threads.
pub fn copy_bandwidth(bytes: usize, workers: usize) -> io::Result<f64> {
    let mut team = Team::new(workers)?;
    let words = (bytes / (2 * size_of::<u64>() * workers)).max(1024);
    // Short arrays are copied many times, so that the clock's resolution does not matter.
    let times = ((1 << 22) / words).max(1);
    let mut arrays: Vec<[Vec<u64>; 2]> =
        (0..workers).map(|_| [vec![1; words], vec![2; words]]).collect();
    let best = best(20, || {
        team.for_each_chunk(&mut arrays, 1, |_, pairs| {
            for [from, to] in pairs {
                for _ in 0..times {
                    to.copy_from_slice(black_box(from));
                    black_box(&*to);
                }
            }
        });
    });
    Ok((2 * size_of::<u64>() * words * workers * times) as f64 / best)
}

/// The best of some samples: undisturbed even on a shared machine.
fn best(samples: usize, mut sample: impl FnMut()) -> f64 {
    let times = (0..samples).map(|_| {
        let begin = Instant::now();
        sample();
        begin.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min)
}
