//! What scheduling itself costs here.

use std::hint::black_box;
use std::io;

use finegrain_framework::Team;
use finegrain_framework::dispatch::{Dispatch, Meeting};

use super::samples::best_seconds;

/// Tasks or meetings of a sample.
const COUNT: usize = 2000;

/// Time of a worker, of so many, from one empty task to the next, s.
///
/// # Errors
/// If the system refuses threads.
pub fn hand_out(workers: usize) -> io::Result<f64> {
    let mut team = Team::new(workers)?;
    let dispatch = Dispatch::new(COUNT, 1, workers);
    let best = best_seconds(100, || {
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
    let best = best_seconds(100, || {
        team.run(|_| {
            for _ in 0..COUNT {
                meeting.arrive(|| {});
            }
        });
    });
    Ok(best / COUNT as f64)
}
