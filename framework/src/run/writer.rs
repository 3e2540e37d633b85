//! The writer thread, seen from the stepping thread.

use std::convert::Infallible;
use std::thread::JoinHandle;

use super::snapshot::Snapshot;
use super::store::{Row, Store};
use super::{OutputError, RunFailure};
use crate::port::{Arbiter, Choice, Ended, Failure, Interleave, Port};
use crate::simulation::Position;

/// Snapshots that there are at most: one being written, one waiting or being taken.
const SNAPSHOTS: usize = 2;

/// A thread that writes what is posted to it, in order.
pub(super) struct Writer {
    rows: Port<Row>,
    dumps: Port<(usize, Snapshot)>,
    checkpoints: Port<(Position, Snapshot)>,
    finish: Port<()>,
    events: Choice<'static, Event, Infallible>,
    /// Snapshots that came back, to be used again.
    spare: Vec<Snapshot>,
    /// Snapshots that were made.
    made: usize,
    thread: JoinHandle<Ended<Store>>,
}

/// What the writer thread tells.
enum Event {
    /// A snapshot is no longer needed.
    Returned(Snapshot),
    /// Something could not be written.
    Failed(Failure<OutputError>),
}

impl Writer {
    /// Starts the thread around `store`.
    pub fn start(store: Store) -> Result<Self, RunFailure> {
        // Unbounded, because the number of snapshots bounds what can wait; rows are small.
        let (rows, row_inbox) = Port::unbounded("monitor rows");
        let (dumps, dump_inbox) = Port::unbounded("dumps");
        let (checkpoints, checkpoint_inbox) = Port::unbounded("checkpoints");
        let (finish, finish_inbox) = Port::unbounded("finish");
        let (returned, returned_inbox) = Port::unbounded("written snapshots");
        let (failures, failure_inbox) = Port::unbounded("failures");
        let dumped = returned.clone();
        // A snapshot comes back whether it could be written or not. (Nobody minds if the stepping
        // thread takes none back any more.)
        let interleave = Interleave::new(store, failures)
            .exclusive(row_inbox, |store: &mut Store, row| store.log(&row))
            .exclusive(dump_inbox, move |store, (series, snapshot)| {
                let outcome = store.dump(series, &snapshot);
                let _ = dumped.post(snapshot);
                outcome
            })
            .exclusive(checkpoint_inbox, move |store, (position, snapshot)| {
                let outcome = store.checkpoint(position, &snapshot);
                let _ = returned.post(snapshot);
                outcome
            })
            .teardown(finish_inbox, |store, ()| Ok(store));
        let thread = std::thread::Builder::new()
            .name("finegrain-writer".to_owned())
            .spawn(|| interleave.run())
            .map_err(RunFailure::Thread)?;
        let events = Choice::new()
            .on(returned_inbox, |snapshot| Ok(Event::Returned(snapshot)))
            .on(failure_inbox, |failure| Ok(Event::Failed(failure)));
        let spare = Vec::new();
        Ok(Self { rows, dumps, checkpoints, finish, events, spare, made: 0, thread })
    }

    /// A snapshot to be filled and posted; waits for one if all are under way.
    pub fn snapshot(&mut self) -> Result<Snapshot, RunFailure> {
        self.look()?;
        loop {
            if let Some(snapshot) = self.spare.pop() {
                return Ok(snapshot);
            }
            if self.made < SNAPSHOTS {
                self.made += 1;
                return Ok(Snapshot::default());
            }
            let event = self.events.wait().ok_or_else(ended)?;
            self.note(event)?;
        }
    }

    pub fn log(&self, row: Row) -> Result<(), RunFailure> {
        self.rows.post(row).map_err(|_| ended())
    }

    pub fn dump(&self, series: usize, snapshot: Snapshot) -> Result<(), RunFailure> {
        self.dumps.post((series, snapshot)).map_err(|_| ended())
    }

    pub fn checkpoint(&self, position: Position, snapshot: Snapshot) -> Result<(), RunFailure> {
        self.checkpoints.post((position, snapshot)).map_err(|_| ended())
    }

    /// Takes note of what the thread has told, without waiting.
    ///
    /// # Errors
    /// If something could not be written.
    pub fn look(&mut self) -> Result<(), RunFailure> {
        while let Some(event) = self.events.try_wait() {
            self.note(event)?;
        }
        Ok(())
    }

    /// Waits until all that was posted is written; the store, and the first failure that nobody
    /// has been told yet.
    pub fn finish(mut self) -> (Option<Store>, Result<(), RunFailure>) {
        // If the thread has ended before, joining it says so.
        let _ = self.finish.post(());
        let store = self.thread.join().ok().and_then(|ended| ended.result);
        let mut outcome = Ok(());
        for event in self.events.pending() {
            if let (Ok(()), Err(failure)) = (&outcome, told(event)) {
                outcome = Err(failure);
            }
        }
        if store.is_none() && outcome.is_ok() {
            outcome = Err(ended());
        }
        (store, outcome)
    }

    fn note(&mut self, event: Result<Event, Failure<Infallible>>) -> Result<(), RunFailure> {
        self.spare.extend(told(event)?);
        Ok(())
    }
}

/// The snapshot that came back, or the failure.
fn told(event: Result<Event, Failure<Infallible>>) -> Result<Option<Snapshot>, RunFailure> {
    match event {
        Ok(Event::Returned(snapshot)) => Ok(Some(snapshot)),
        Ok(Event::Failed(Failure::Handler { source, .. })) => Err(source.into()),
        Ok(Event::Failed(failure)) => Err(RunFailure::Writer(failure.to_string())),
        Err(failure) => Err(RunFailure::Writer(failure.to_string())),
    }
}

fn ended() -> RunFailure {
    RunFailure::Writer("it has ended before the run".to_owned())
}
