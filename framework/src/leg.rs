//! A leg: what the workers run without coming back to the caller, a number of steps or a stretch of one.

use std::cell::Cell;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::clock::Clock;
use crate::columns::Columns;
use crate::desk::{Desk, Scratch};
use crate::domain::{Domain, Partition};
use crate::failure::{Cause, Failure};
use crate::pack::Fence;
use crate::panic_message::panic_message;
use crate::schedule::Work;
use crate::stage::Fault;
use crate::step::{Entry, Step};
use crate::trace::{Event, Trace};
use crate::view::{Near, Own, Place, Rates, Shifts};

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
    /// # Errors
    /// If the partition is not sealed or has other points than the columns: whoever divided space
    /// did not notice that it had failed.
    pub fn new(
        domain: &'a D,
        columns: &'a mut Columns,
        step: &'a Step<D>,
        desk: &'a mut Desk,
        clock: &'a Clock,
        stint: Stint,
        watch: Watch<'a>,
    ) -> Result<Self, Fault> {
        let partition = domain.partition();
        if !partition.is_sealed() {
            return Err(Fault::new("the domain's partition is not sealed"));
        }
        if partition.points() != columns.points() {
            return Err(Fault::new(format!(
                "the domain has {} points, the columns have {}",
                partition.points(),
                columns.points()
            )));
        }
        desk.lay_out(step, columns);
        columns.notebook_mut().resize(partition.len());
        Ok(Self {
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
        })
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
        let swapped = base ^ parity ^ self.step.swapped_before(entry);
        let shifts = match entry {
            Some(entry) => self.step.stages[self.step.entries[entry].stage].shifts(),
            None => Shifts::NONE,
        };
        Place {
            domain: self.domain,
            partition: self.partition,
            id,
            columns: self.columns,
            slots: self.desk.slots(swapped),
            shifts,
            displaced: self.step.displaced,
            notebook: self.columns.notebook(),
            activity: self.desk.activities.of(worker),
        }
    }

    /// Runs a part; `at` tells which stage it has come to.
    fn run_part(
        &self,
        worker: usize,
        fence: &Fence,
        step: u64,
        part: usize,
        sub_domain: usize,
        at: &Cell<usize>,
    ) -> Result<(), Cause> {
        self.desk.with_scratch(self.step, worker, |scratch| {
            for entry in self.step.part_start[part]..self.step.part_start[part + 1] {
                at.set(entry);
                self.run_entry(worker, fence, scratch, step, entry, sub_domain)?;
            }
            Ok::<_, Fault>(())
        })?;
        let is_checked = self.watch.check_every.is_some_and(|n| (step + 1).is_multiple_of(n));
        if is_checked && Some(part) == self.step.last_of_workers() {
            self.check_values(worker, step, part, sub_domain)?;
        }
        Ok(())
    }

    fn run_entry(
        &self,
        worker: usize,
        fence: &Fence,
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

    fn check_values(
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
        let mut columns = self.desk.checked.iter().map(|&id| (id, self.columns.column(id)));
        match columns.find(|(id, column)| !own.is_valid(*id, column.most())) {
            Some((_, column)) => Err(Cause::invalid(column)),
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

    fn fence(&self) -> Fence {
        Fence::new(self.past_caches)
    }

    fn run(&self, worker: usize, fence: &Fence, step: u64, part: usize, sub_domain: usize) {
        if self.failed() {
            return;
        }
        let part = self.stint.parts.start + part;
        let begin = self.watch.trace.map(Trace::now);
        // One net under everything: a worker that unwound would leave the others waiting for it.
        let at = Cell::new(self.step.part_start[part]);
        let outcome = catch_unwind(AssertUnwindSafe(|| {
            self.run_part(worker, fence, step, part, sub_domain, &at)
        }));
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
            Cause::NotFinite { .. } | Cause::Beyond { .. } => self.step.part_name(part),
            _ => self.step.stages[self.step.entries[at.get()].stage].name().to_owned(),
        };
        self.fail(Failure { step, part, stage, sub_domain: Some(sub_domain), cause });
    }

    fn failed(&self) -> bool {
        self.failed.load(Ordering::Acquire)
    }
}
