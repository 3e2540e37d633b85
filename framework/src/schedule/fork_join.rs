//! Master time loop with slave functions (Fig. 4a): one rayon loop a part.

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::order::Order;
use super::work::Work;

pub(super) struct ForkJoin {
    pool: ThreadPool,
}

impl ForkJoin {
    pub fn new(workers: usize) -> std::io::Result<Self> {
        let pool =
            ThreadPoolBuilder::new().num_threads(workers).build().map_err(std::io::Error::other)?;
        Ok(Self { pool })
    }

    pub fn run(&mut self, work: &dyn Work, order: &Order) {
        for step in work.steps() {
            for part in 0..work.parts() {
                self.pool.install(|| {
                    (0..work.partition().len()).into_par_iter().for_each(|place| {
                        let worker = rayon::current_thread_index().unwrap_or(0);
                        work.run(worker, &work.fence(), step, part, order.at(place));
                    });
                });
                if work.failed() {
                    return;
                }
            }
        }
    }
}
