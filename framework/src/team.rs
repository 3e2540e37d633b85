//! A team of worker threads that lives as long as the run.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::PoisonError;

use crate::dispatch::{Dispatch, Meeting};
use crate::sync::{Arc, Builder, JoinHandle, Mutex, UnsafeCell};

/// What the team is to do: a closure on the caller's stack, its lifetime erased.
type Task = *const (dyn Fn(usize) + Sync);

struct Shared {
    task: UnsafeCell<Option<Task>>,
    begin: Meeting,
    end: Meeting,
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

// SAFETY: `task` is written by the caller of `Team::run` (or by drop) only while all other
// members wait in `begin`, and read by them only between `begin` and `end`; the two meetings
// order these accesses. The closure it points to is `Sync`.
unsafe impl Sync for Shared {}
// SAFETY: as for `Sync`.
unsafe impl Send for Shared {}

impl Shared {
    /// Runs the present task as worker `worker`; false if there is none: the team is dissolved.
    fn work(&self, worker: usize) -> bool {
        // SAFETY: between `begin` and `end` nobody writes `task` (see `Sync` above).
        let Some(task) = self.task.with(|task| unsafe { *task }) else {
            return false;
        };
        // SAFETY: `Team::run` keeps the closure alive until all members have met in `end`.
        let task = unsafe { &*task };
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| task(worker))) {
            let mut first = self.panic.lock().unwrap_or_else(PoisonError::into_inner);
            match *first {
                None => *first = Some(panic),
                // Dropping a payload might panic once more, past the meeting.
                Some(_) => std::mem::forget(panic),
            }
        }
        true
    }
}

/// Worker threads: the caller is worker 0, the others sleep between tasks.
pub struct Team {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

impl std::fmt::Debug for Team {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Team({})", self.workers())
    }
}

impl Team {
    /// A team of `workers`, the caller included.
    ///
    /// # Errors
    /// If the system refuses a thread. Those it has granted before sleep until the process ends.
    ///
    /// # Panics
    /// If `workers` is 0.
    pub fn new(workers: usize) -> std::io::Result<Self> {
        assert!(workers > 0, "a team needs at least one worker");
        let shared = Arc::new(Shared {
            task: UnsafeCell::new(None),
            begin: Meeting::new(workers),
            end: Meeting::new(workers),
            panic: Mutex::new(None),
        });
        let threads = (1..workers)
            .map(|worker| {
                let shared = Arc::clone(&shared);
                Builder::new().name(format!("finegrain-{worker}")).spawn(move || {
                    loop {
                        shared.begin.arrive(|| {});
                        if !shared.work(worker) {
                            break;
                        }
                        shared.end.arrive(|| {});
                    }
                })
            })
            .collect::<std::io::Result<Vec<_>>>()?;
        Ok(Self { shared, threads })
    }

    /// Number of workers, the caller included.
    pub fn workers(&self) -> usize {
        self.threads.len() + 1
    }

    /// Runs `task(worker)` on every worker at once and returns when all have returned.
    ///
    /// # Panics
    /// With a worker's panic, after all have returned; the team stays usable.
    pub fn run(&mut self, task: impl Fn(usize) + Sync) {
        self.run_dyn(&task);
    }

    /// [`Team::run`], compiled once and not for every task.
    fn run_dyn(&mut self, task: &(dyn Fn(usize) + Sync)) {
        // SAFETY: only the lifetime is erased. Nobody uses the pointer after `end`, which this
        // function awaits before `task` goes away; nothing between here and there can unwind.
        let task = unsafe { std::mem::transmute::<&(dyn Fn(usize) + Sync), Task>(task) };
        // SAFETY: all other members wait in `begin`; `&mut self` excludes a second caller.
        self.shared.task.with_mut(|present| unsafe { *present = Some(task) });
        self.shared.begin.arrive(|| {});
        self.shared.work(0);
        self.shared.end.arrive(|| {});
        let panic = self.shared.panic.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(panic) = panic {
            resume_unwind(panic);
        }
    }

    /// Runs `task(i)` for every `i` below `values`, `chunk` at a time to whoever asks.
    ///
    /// # Panics
    /// As [`Team::run`].
    pub fn for_each(&mut self, values: usize, chunk: usize, task: impl Fn(usize) + Sync) {
        let dispatch = Dispatch::new(values, chunk.max(1), self.workers());
        self.run(|_| {
            while let Some(range) = dispatch.request() {
                range.for_each(&task);
            }
        });
    }

    /// Runs `task(k, chunk)` for every chunk of `length` consecutive elements of `data`.
    ///
    /// # Panics
    /// As [`Team::run`]; if `length` is 0.
    pub fn for_each_chunk<T: Send>(
        &mut self,
        data: &mut [T],
        length: usize,
        task: impl Fn(usize, &mut [T]) + Sync,
    ) {
        let mut nothing = vec![(); self.workers()];
        self.for_each_chunk_with(&mut nothing, data, length, |(), k, chunk| task(k, chunk));
    }

    /// As [`Team::for_each_chunk`], with working memory: of the elements of `scratch`, every worker has
    /// its own.
    ///
    /// # Panics
    /// As [`Team::for_each_chunk`]; if there are fewer elements of `scratch` than workers.
    pub fn for_each_chunk_with<S: Send, T: Send>(
        &mut self,
        scratch: &mut [S],
        data: &mut [T],
        length: usize,
        task: impl Fn(&mut S, usize, &mut [T]) + Sync,
    ) {
        assert!(scratch.len() >= self.workers(), "every worker needs a scratch");
        struct Base<T>(*mut T);
        // SAFETY: the address is used for disjoint elements only, each by one worker; `T: Send`.
        unsafe impl<T: Send> Sync for Base<T> {}
        impl<T> Base<T> {
            fn get(&self) -> *mut T {
                self.0
            }
        }

        let total = data.len();
        let (base, scratch) = (Base(data.as_mut_ptr()), Base(scratch.as_mut_ptr()));
        let dispatch = Dispatch::new(total.div_ceil(length), 1, self.workers());
        self.run(|worker| {
            // SAFETY: `scratch` is borrowed exclusively until `run` returns and has an element for
            // every worker, none of whom is run twice.
            let scratch = unsafe { &mut *scratch.get().add(worker) };
            for k in std::iter::from_fn(|| dispatch.request()).flatten() {
                let start = k * length;
                let length = length.min(total - start);
                // SAFETY: `start..start + length` lies in `data`, which is borrowed exclusively until
                // `run` returns, and dispatch hands every `k` to exactly one worker.
                let chunk =
                    unsafe { std::slice::from_raw_parts_mut(base.get().add(start), length) };
                task(scratch, k, chunk);
            }
        });
    }
}

impl Drop for Team {
    fn drop(&mut self) {
        // SAFETY: all other members wait in `begin` (a `run` always completes its `end`).
        self.shared.task.with_mut(|present| unsafe { *present = None });
        self.shared.begin.arrive(|| {});
        for thread in self.threads.drain(..) {
            // A worker catches every panic of its task; there is nothing left to report here.
            let _ = thread.join();
        }
    }
}

#[cfg(all(test, not(loom)))]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn every_worker_runs_every_task_once() {
        for workers in [1, 2, 3, 8] {
            let mut team = Team::new(workers).unwrap();
            let ran: Vec<_> = (0..workers).map(|_| AtomicUsize::new(0)).collect();
            for _ in 0..200 {
                team.run(|w| {
                    ran[w].fetch_add(1, Ordering::Relaxed);
                });
            }
            assert!(ran.iter().all(|r| r.load(Ordering::Relaxed) == 200));
        }
    }

    #[test]
    fn chunks_cover_all_elements_once() {
        let mut team = Team::new(3).unwrap();
        for (total, length) in [(0, 4), (1, 4), (4, 4), (1001, 10)] {
            let mut data = vec![0usize; total];
            team.for_each_chunk(&mut data, length, |k, chunk| {
                for (i, x) in chunk.iter_mut().enumerate() {
                    *x += k * length + i;
                }
            });
            assert!(data.iter().enumerate().all(|(i, &x)| x == i));
        }
    }

    #[test]
    fn every_worker_has_a_scratch_of_its_own() {
        let mut team = Team::new(3).unwrap();
        let (mut sums, mut data) = ([0usize; 3], vec![0usize; 1001]);
        team.for_each_chunk_with(&mut sums, &mut data, 10, |sum, k, chunk| {
            *sum += chunk.len();
            chunk.fill(k);
        });
        assert_eq!(sums.iter().sum::<usize>(), 1001);
        assert!(data.iter().enumerate().all(|(i, &k)| k == i / 10));
        let few = AssertUnwindSafe(|| {
            team.for_each_chunk_with(&mut sums[..2], &mut data, 1, |_, _, _| {})
        });
        assert!(catch_unwind(few).is_err());
    }

    #[test]
    fn a_panic_reaches_the_caller_and_the_team_survives() {
        let mut team = Team::new(3).unwrap();
        for who in 0..3 {
            let panic = catch_unwind(AssertUnwindSafe(|| {
                team.run(|w| assert_ne!(w, who, "worker {who}"));
            }));
            assert!(panic.is_err());
        }
        team.for_each(10, 1, |_| {});
    }
}
