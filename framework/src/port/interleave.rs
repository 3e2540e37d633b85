use std::error::Error;
use std::fmt;
use std::mem;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, PoisonError, RwLock};
use std::thread;

use crossbeam_channel::{Receiver, Sender, bounded};
use crossbeam_utils::sync::WaitGroup;

use super::arbiter::Outcome;
use super::branches::Branches;
use super::failure::guarded;
use super::{Failure, Inbox, Port};

/// Coordinates groups of handlers around one state `S`, which says what each group may do:
///
/// - **concurrent** handlers borrow the state and may run beside one another;
/// - **exclusive** handlers borrow it mutably and run alone;
/// - a **teardown** handler consumes it, runs last and ends the interleave.
///
/// Messages are taken in the order in which they were posted, whichever ports they were posted to.
/// An exclusive handler starts when all earlier ones have finished; concurrent handlers start in
/// order and finish as they may. When a teardown message is taken all ports close, what they had
/// accepted is handled, and then the teardown handler runs; further teardown messages have nothing
/// left to end and are dropped.
///
/// What goes wrong in a handler is posted as a [`Failure`], at once, and the messages that follow
/// are handled all the same. (So let the port of failures be unbounded, or drain it.)
///
/// # Example
/// A writer that works while stepping goes on, and stops when it is told to or when the stepping
/// thread is gone:
/// ```
/// use finegrain_framework::port::{Interleave, Port};
///
/// let (failures, _reports) = Port::unbounded("failures");
/// let (dumps, dump_inbox) = Port::bounded("dumps", 2);
/// let (finish, finish_inbox) = Port::unbounded("finish");
/// let files: Vec<String> = Vec::new();
/// let writer = Interleave::new(files, failures)
///     .exclusive(dump_inbox, |files, step: u64| {
///         files.push(format!("step{step}.vtu"));
///         Ok::<_, std::io::Error>(())
///     })
///     .teardown(finish_inbox, |files, ()| Ok(files.len()));
/// let writer = std::thread::spawn(|| writer.run());
/// for step in 0..3 {
///     dumps.post(step)?;
/// }
/// finish.post(())?;
/// let ended = writer.join().expect("handlers' panics do not end an interleave");
/// assert_eq!(ended.result, Some(3));
/// assert!(dumps.post(3).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Interleave<'h, S, R, E: Error + 'static> {
    state: S,
    failures: Port<Failure<E>>,
    threads: usize,
    branches: Branches<'h, Job<'h, S, R, E>>,
}

/// How an interleave ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ended<R> {
    /// How many messages were handled without failure.
    pub handled: u64,
    /// How many failed, and so were posted as a [`Failure`].
    pub failed: u64,
    /// What the teardown handler returned; `None` if it failed, or if all ports closed without a
    /// teardown message.
    pub result: Option<R>,
}

type Concurrent<'h, S, E> = Box<dyn FnOnce(&S) -> Outcome<(), E> + Send + 'h>;
type Exclusive<'h, S, E> = Box<dyn FnOnce(&mut S) -> Outcome<(), E> + Send + 'h>;
type Teardown<'h, S, R, E> = Box<dyn FnOnce(S) -> Outcome<R, E> + Send + 'h>;

/// A message bound to its handler.
enum Job<'h, S, R, E: Error + 'static> {
    Concurrent(Concurrent<'h, S, E>),
    Exclusive(Exclusive<'h, S, E>),
    Teardown(Teardown<'h, S, R, E>),
}

impl<'h, S, R, E> Interleave<'h, S, R, E>
where
    S: Send + Sync + 'h,
    R: 'h,
    E: Error + Send + 'static,
{
    /// An interleave of nothing around `state`, which posts what goes wrong to `failures`.
    pub fn new(state: S, failures: Port<Failure<E>>) -> Self {
        Self { state, failures, threads: 1, branches: Branches::new() }
    }

    /// Lets up to `threads` concurrent handlers run beside one another. With 0 or 1, which is how
    /// an interleave starts, they run one by one on the thread that runs the interleave.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
        self
    }

    /// Runs `handler` for the messages of `inbox`, possibly beside other concurrent handlers.
    #[must_use]
    pub fn concurrent<T: Send + 'h>(
        mut self,
        inbox: Inbox<T>,
        handler: impl Fn(&S, T) -> Result<(), E> + Send + Sync + 'h,
    ) -> Self {
        let handler = Arc::new(handler);
        self.branches.add(inbox, move |port, message| {
            let (port, handler) = (port.to_string(), Arc::clone(&handler));
            Job::Concurrent(Box::new(move |state| guarded(&port, || handler(state, message))))
        });
        self
    }

    /// Runs `handler` for the messages of `inbox`, with no other handler beside it.
    #[must_use]
    pub fn exclusive<T: Send + 'h>(
        mut self,
        inbox: Inbox<T>,
        handler: impl Fn(&mut S, T) -> Result<(), E> + Send + Sync + 'h,
    ) -> Self {
        let handler = Arc::new(handler);
        self.branches.add(inbox, move |port, message| {
            let (port, handler) = (port.to_string(), Arc::clone(&handler));
            Job::Exclusive(Box::new(move |state| guarded(&port, || handler(state, message))))
        });
        self
    }

    /// Ends the interleave at the first message of `inbox`, with `handler` as the last thing run.
    #[must_use]
    pub fn teardown<T: Send + 'h>(
        mut self,
        inbox: Inbox<T>,
        handler: impl Fn(S, T) -> Result<R, E> + Send + Sync + 'h,
    ) -> Self {
        let handler = Arc::new(handler);
        self.branches.add(inbox, move |port, message| {
            let (port, handler) = (port.to_string(), Arc::clone(&handler));
            Job::Teardown(Box::new(move |state| guarded(&port, || handler(state, message))))
        });
        self
    }

    /// Handles messages until a teardown message comes or all ports are closed and empty.
    pub fn run(self) -> Ended<R> {
        let tally = Tally::new(self.failures);
        let state = RwLock::new(self.state);
        let mut branches = self.branches;
        let teardown = thread::scope(|scope| {
            // No room for tasks to wait here: they wait in their port, where a bound is felt.
            let (hand_out, tasks) = bounded(0);
            let (tally, state) = (&tally, &state);
            let wanted = if self.threads > 1 { self.threads } else { 0 };
            let started = (0..wanted)
                .map_while(|_| {
                    let tasks = tasks.clone();
                    thread::Builder::new()
                        .name("interleave".to_string())
                        .spawn_scoped(scope, move || serve(&tasks, state, tally))
                        .ok()
                })
                .count();
            // Fewer threads than asked for, even none, only means fewer handlers at once.
            let hand_out = (started > 0).then_some(hand_out);
            coordinate(&mut branches, hand_out.as_ref(), state, tally)
        });
        let state = state.into_inner().unwrap_or_else(PoisonError::into_inner);
        let result = teardown.and_then(|last| tally.count(last(state)));
        Ended { handled: tally.handled.into_inner(), failed: tally.failed.into_inner(), result }
    }
}

/// A concurrent task; its member of the group of tasks under way is dropped when it is done.
type Task<'h, S, E> = (Concurrent<'h, S, E>, WaitGroup);

fn serve<S, E: Error + 'static>(
    tasks: &Receiver<Task<'_, S, E>>,
    state: &RwLock<S>,
    tally: &Tally<E>,
) {
    for (task, under_way) in tasks {
        run_concurrent(task, state, tally);
        drop(under_way);
    }
}

/// Runs or hands out job after job; returns the teardown to run last, if one was asked for.
fn coordinate<'h, S, R, E: Error + 'static>(
    branches: &mut Branches<'h, Job<'h, S, R, E>>,
    hand_out: Option<&Sender<Task<'h, S, E>>>,
    state: &RwLock<S>,
    tally: &Tally<E>,
) -> Option<Teardown<'h, S, R, E>> {
    let mut teardown = None;
    let mut under_way = WaitGroup::new();
    while let Some(job) = branches.take() {
        match job {
            Job::Concurrent(task) => match hand_out {
                None => run_concurrent(task, state, tally),
                Some(hand_out) => {
                    // The threads outlive `hand_out`; were they gone, the task runs here.
                    if let Err(refused) = hand_out.send((task, under_way.clone())) {
                        run_concurrent(refused.0.0, state, tally);
                    }
                }
            },
            Job::Exclusive(task) => {
                mem::take(&mut under_way).wait();
                let mut state = state.write().unwrap_or_else(PoisonError::into_inner);
                tally.count(task(&mut state));
            }
            Job::Teardown(last) => {
                branches.close();
                teardown.get_or_insert(last);
            }
        }
    }
    teardown
}

fn run_concurrent<S, E: Error + 'static>(
    task: Concurrent<'_, S, E>,
    state: &RwLock<S>,
    tally: &Tally<E>,
) {
    // The lock is never waited for: exclusive tasks start when no concurrent one is under way. It
    // is what proves that to the compiler.
    let state = state.read().unwrap_or_else(PoisonError::into_inner);
    tally.count(task(&state));
}

/// Counts outcomes and posts failures.
struct Tally<E: Error + 'static> {
    handled: AtomicU64,
    failed: AtomicU64,
    failures: Port<Failure<E>>,
}

impl<E: Error + 'static> Tally<E> {
    fn new(failures: Port<Failure<E>>) -> Self {
        Self { handled: AtomicU64::new(0), failed: AtomicU64::new(0), failures }
    }

    fn count<R>(&self, outcome: Outcome<R, E>) -> Option<R> {
        match outcome {
            Ok(result) => {
                self.handled.fetch_add(1, Ordering::Relaxed);
                Some(result)
            }
            Err(failure) => {
                self.failed.fetch_add(1, Ordering::Relaxed);
                // If nobody receives failures any more, the count alone still tells.
                let _ = self.failures.post(failure);
                None
            }
        }
    }
}

impl<S: fmt::Debug, R, E: Error + 'static> fmt::Debug for Interleave<'_, S, R, E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Interleave")
            .field("state", &self.state)
            .field("threads", &self.threads)
            .finish_non_exhaustive()
    }
}
