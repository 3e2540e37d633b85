//! A leg: what the workers run without coming back to the caller, a number of steps or a stretch of one.

use std::any::Any;
use std::cell::Cell;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, TryLockError};

use crate::activity::Activities;
use crate::clock::Clock;
use crate::columns::{ColumnId, Columns, Role};
use crate::domain::{Domain, Partition};
use crate::pack::Fence;
use crate::stage::Fault;
use crate::step::{Entry, Step, Stretch};
use crate::trace::{Event, Trace};
use crate::view::{Near, Own, Place, Rates, Shifts, Slot, slots_of};

/// What went wrong in a leg, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Number of the step.
    pub step: u64,
    /// Place of the part in the step.
    pub part: usize,
    /// Name of the stage.
    pub stage: String,
    /// Number of the sub-domain; `None` for whole-domain work.
    pub sub_domain: Option<usize>,
    /// Why.
    pub cause: Cause,
}

/// Why a stage of a sub-domain ended a run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Cause {
    /// The stage said so.
    #[error("{0}")]
    Fault(#[from] Fault),
    /// The stage panicked.
    #[error("the stage panicked: {0}")]
    Panic(String),
    /// A state column holds NaN or infinity.
    #[error("column {column:?} holds a value that is not finite")]
    NotFinite {
        /// Name of the column.
        column: String,
    },
}

/// Work cut into parts and sub-domains: all that a schedule knows.
pub(crate) trait Work: Sync {
    /// Number of parts of a step.
    fn parts(&self) -> usize;
    /// Ownership and neighbourhood.
    fn partition(&self) -> &Partition;
    /// Numbers of the steps to run.
    fn steps(&self) -> Range<u64>;
    /// Runs one part of one step of one sub-domain; never unwinds.
    fn run(&self, worker: usize, step: u64, part: usize, sub_domain: usize);
    /// Whether something failed, so that the rest need not be run.
    fn failed(&self) -> bool;
}

/// Working memory of one worker, for every stage of a step.
type Scratch = Vec<Box<dyn Any + Send>>;

fn scratch_for<D: Domain>(step: &Step<D>) -> Scratch {
    step.stages.iter().map(|stage| stage.scratch()).collect()
}

/// Memory that legs reuse, so that a leg does not allocate.
pub(crate) struct Desk {
    /// Every worker has its own: the locks are never contended.
    scratch: Vec<Mutex<Scratch>>,
    slots: Vec<Slot>,
    /// Per set of swapped pairs that occurs, the slots in that order.
    tables: Vec<(u64, Vec<Slot>)>,
    checked: Vec<ColumnId>,
    pub activities: Activities,
}

impl Desk {
    /// Memory for the legs of `step` on `workers` workers.
    ///
    /// # Panics
    /// If the step swaps columns of different types: its handles belong to other columns.
    pub fn new<D: Domain>(step: &Step<D>, columns: &Columns, workers: usize) -> Self {
        for &(a, b) in &step.pairs {
            let kinds = [a, b].map(|id| columns.column(id).kind());
            assert_eq!(kinds[0], kinds[1], "columns {a:?} and {b:?} are swapped");
        }
        let scratch = (0..workers).map(|_| Mutex::new(scratch_for(step))).collect();
        let mut keys = Vec::new();
        for stretch in &step.stretches {
            let Stretch::Parts(parts) = stretch else { continue };
            let base = step.swapped_before_part(parts.start);
            for parity in [0, step.swapped] {
                let entries = (0..step.entries.len()).map(Some).chain([None]);
                keys.extend(entries.map(|e| base ^ parity ^ step.swapped_before(e)));
            }
        }
        keys.sort_unstable();
        keys.dedup();
        Self {
            scratch,
            slots: Vec::new(),
            tables: keys.into_iter().map(|key| (key, Vec::new())).collect(),
            checked: columns
                .iter()
                .filter(|(_, c)| c.role() == Role::State)
                .map(|(id, _)| id)
                .collect(),
            activities: Activities::new(workers),
        }
    }

    fn lay_out<D: Domain>(&mut self, step: &Step<D>, columns: &mut Columns) {
        slots_of(columns, &mut self.slots);
        for (key, table) in &mut self.tables {
            table.clone_from(&self.slots);
            for (k, (a, b)) in step.pairs.iter().enumerate() {
                if *key >> k & 1 == 1 {
                    table.swap(a.0 as usize, b.0 as usize);
                }
            }
        }
    }
}

/// What is looked at while a leg runs.
#[derive(Clone, Copy, Default)]
pub(crate) struct Watch<'a> {
    /// State columns are checked to be finite after every step whose number (from 1) divides by this.
    pub check_every: Option<u64>,
    /// Where it is written down what the workers do.
    pub trace: Option<&'a Trace>,
}

/// Which parts of which steps a leg runs.
pub(crate) struct Stint {
    pub steps: Range<u64>,
    /// All parts; or, of one step, a stretch.
    pub parts: Range<usize>,
}

/// One leg, ready to be run by a schedule.
pub(crate) struct Leg<'a, D: Domain> {
    domain: &'a D,
    partition: &'a Partition,
    columns: &'a mut Columns,
    step: &'a Step<D>,
    desk: &'a Desk,
    clock: &'a Clock,
    stint: Stint,
    watch: Watch<'a>,
    past_caches: bool,
    failed: AtomicBool,
    failure: Mutex<Option<Failure>>,
}

impl<'a, D: Domain> Leg<'a, D> {
    /// A leg of some steps, or of a stretch of one.
    ///
    /// # Panics
    /// If the partition is not sealed or has other points than the columns.
    pub fn new(
        domain: &'a D,
        columns: &'a mut Columns,
        step: &'a Step<D>,
        desk: &'a mut Desk,
        clock: &'a Clock,
        stint: Stint,
        watch: Watch<'a>,
    ) -> Self {
        let partition = domain.partition();
        assert!(partition.is_sealed(), "the domain's partition is not sealed");
        assert_eq!(
            partition.points(),
            columns.points(),
            "the domain and the columns have different numbers of points"
        );
        desk.lay_out(step, columns);
        columns.notebook_mut().resize(partition.len());
        Self {
            domain,
            partition,
            columns,
            step,
            desk,
            clock,
            stint,
            watch,
            past_caches: false,
            failed: AtomicBool::new(false),
            failure: Mutex::new(None),
        }
    }

    /// Lets rate stages write past the caches, or not.
    pub fn past_caches(mut self, pays: bool) -> Self {
        self.past_caches = pays;
        self
    }

    /// Ends the leg after the schedule has run it: the columns' memory is brought in the order
    /// that the last step's swaps left.
    ///
    /// # Errors
    /// The first failure, in order of step, part and sub-domain, among those that happened.
    pub fn finish(self) -> Result<(), Failure> {
        let Self { columns, step, stint: Stint { steps, parts }, failure, .. } = self;
        if (steps.end - steps.start) % 2 == 1 {
            let [before, after] =
                [parts.start, parts.end].map(|part| step.swapped_before_part(part));
            step.exchange(columns, before ^ after);
        }
        match failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some(failure) => Err(failure),
            None => Ok(()),
        }
    }

    fn place(&self, worker: usize, step: u64, entry: Option<usize>, id: usize) -> Place<'_, D> {
        let odd = (step - self.stint.steps.start) % 2 == 1;
        let parity = if odd { self.step.swapped } else { 0 };
        let base = self.step.swapped_before_part(self.stint.parts.start);
        let key = base ^ parity ^ self.step.swapped_before(entry);
        let tables = &self.desk.tables;
        let table = tables.iter().find(|(k, _)| *k == key).expect("all keys are laid out");
        let shifts = match entry {
            Some(entry) => self.step.stages[self.step.entries[entry].stage].shifts(),
            None => Shifts::NONE,
        };
        Place {
            domain: self.domain,
            partition: self.partition,
            id,
            slots: &table.1,
            shifts,
            displaced: self.step.displaced,
            notebook: self.columns.notebook(),
            activity: self.desk.activities.of(worker),
        }
    }

    /// Hands `task` the worker's scratch, one for each stage.
    fn with_scratch<R>(&self, worker: usize, task: impl FnOnce(&mut Scratch) -> R) -> R {
        match self.desk.scratch[worker].try_lock() {
            Ok(mut scratch) => task(&mut scratch),
            Err(TryLockError::Poisoned(scratch)) => task(&mut scratch.into_inner()),
            // A stage that is itself parallel waits, and rayon runs another sub-domain on its
            // thread meanwhile: that one needs a scratch of its own.
            Err(TryLockError::WouldBlock) => task(&mut scratch_for(self.step)),
        }
    }

    /// Runs a part; `at` tells which stage it has come to.
    fn run_part(
        &self,
        worker: usize,
        step: u64,
        part: usize,
        sub_domain: usize,
        at: &Cell<usize>,
    ) -> Result<(), Cause> {
        self.with_scratch(worker, |scratch| {
            for entry in self.step.part_start[part]..self.step.part_start[part + 1] {
                at.set(entry);
                self.run_entry(worker, scratch, step, entry, sub_domain)?;
            }
            Ok::<_, Fault>(())
        })?;
        let is_checked = self.watch.check_every.is_some_and(|n| (step + 1).is_multiple_of(n));
        if is_checked && Some(part) == self.step.last_of_workers() {
            self.check_finite(worker, step, part, sub_domain)?;
        }
        Ok(())
    }

    fn run_entry(
        &self,
        worker: usize,
        scratch: &mut Scratch,
        step: u64,
        entry: usize,
        sub_domain: usize,
    ) -> Result<(), Fault> {
        let &Entry { stage, c, .. } = &self.step.entries[entry];
        let moment = self.clock.moment(step, c);
        let place = self.place(worker, step, Some(entry), sub_domain);
        let scratch = scratch[stage].as_mut();
        let stage = &self.step.stages[stage];
        if stage.is_rate() {
            let writes = stage.writes();
            let fence = Fence::new(self.past_caches);
            // SAFETY: the schedule runs this part of this sub-domain once, on this worker, and
            // whatever runs beside it within sight is the same part (module `view`); the leg's
            // exclusive borrow of the columns keeps their memory in place.
            let (near, mut rates) =
                unsafe { (Near::new(place, writes), Rates::new(place, writes, fence.bypass())) };
            self.domain.check(&near)?;
            let outcome = stage.run_rate(&near, &mut rates, scratch, &moment);
            near.activity().begin(0);
            outcome
        } else {
            // SAFETY: as above; in an update part everybody touches only what it owns.
            let mut own = unsafe { Own::new(place) };
            stage.run_update(&mut own, scratch, &moment)
        }
    }

    fn check_finite(
        &self,
        worker: usize,
        step: u64,
        part: usize,
        sub_domain: usize,
    ) -> Result<(), Cause> {
        let next = self.step.part_start[part + 1];
        let next = Some(next).filter(|&next| next < self.step.entries.len());
        let place = self.place(worker, step, next, sub_domain);
        // SAFETY: as an update part; the workers' last part has just been run here, and what it owned is
        // looked at.
        let own = unsafe { Own::new(Place { shifts: &self.step.last_shifts, ..place }) };
        match self.desk.checked.iter().find(|&&id| !own.is_finite(id)) {
            Some(&id) => {
                Err(Cause::NotFinite { column: self.columns.column(id).name().to_owned() })
            }
            None => Ok(()),
        }
    }

    fn fail(&self, failure: Failure) {
        let place = |f: &Failure| (f.step, f.part, f.sub_domain);
        let mut first = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        if first.as_ref().is_none_or(|f| place(&failure) < place(f)) {
            *first = Some(failure);
        }
        self.failed.store(true, Ordering::Release);
    }
}

impl<D: Domain> Work for Leg<'_, D> {
    fn parts(&self) -> usize {
        self.stint.parts.len()
    }

    fn partition(&self) -> &Partition {
        self.partition
    }

    fn steps(&self) -> Range<u64> {
        self.stint.steps.clone()
    }

    fn run(&self, worker: usize, step: u64, part: usize, sub_domain: usize) {
        if self.failed() {
            return;
        }
        let part = self.stint.parts.start + part;
        let begin = self.watch.trace.map(Trace::now);
        // One net under everything: a worker that unwound would leave the others waiting for it.
        let at = Cell::new(self.step.part_start[part]);
        let outcome =
            catch_unwind(AssertUnwindSafe(|| self.run_part(worker, step, part, sub_domain, &at)));
        if let (Some(trace), Some(begin)) = (self.watch.trace, begin) {
            let (part, sub_domain) = (part as u32, sub_domain as u32);
            trace.record(worker, Event { begin, end: trace.now(), step, part, sub_domain });
        }
        let cause = match outcome {
            Ok(Ok(())) => return,
            Ok(Err(cause)) => cause,
            Err(panic) => Cause::Panic(panic_message(panic)),
        };
        let stage = match &cause {
            Cause::NotFinite { .. } => self.step.part_name(part),
            _ => self.step.stages[self.step.entries[at.get()].stage].name().to_owned(),
        };
        self.fail(Failure { step, part, stage, sub_domain: Some(sub_domain), cause });
    }

    fn failed(&self) -> bool {
        self.failed.load(Ordering::Acquire)
    }
}

/// What a panic said.
pub(crate) fn panic_message(panic: Box<dyn Any + Send>) -> String {
    let message = match panic.downcast::<String>() {
        Ok(message) => return *message,
        Err(panic) => panic,
    };
    match message.downcast::<&str>() {
        Ok(message) => (*message).to_owned(),
        Err(payload) => {
            // Whatever it is, dropping it might panic once more.
            std::mem::forget(payload);
            "no message".to_owned()
        }
    }
}
