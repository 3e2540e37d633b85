//! What turns steps into legs of the workers and whole-domain work between them.

use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::clock::Clock;
use crate::columns::Columns;
use crate::desk::Desk;
use crate::domain::Domain;
use crate::failure::{Cause, Failure};
use crate::leg::{Leg, Stint, Watch};
use crate::panic_message::panic_message;
use crate::schedule::Executor;
use crate::step::{Step, Stretch};
use crate::trace::Trace;
use crate::whole::{Partials, Whole};

/// All that steps work on and with.
pub(super) struct Engine<'a, D: Domain> {
    pub domain: &'a mut D,
    pub columns: &'a mut Columns,
    pub executor: &'a mut Executor,
    pub partials: &'a mut Partials,
    pub clock: &'a Clock,
    /// Whether rate stages may write past the caches.
    pub past_caches: bool,
}

impl<D: Domain> Engine<'_, D> {
    /// Runs `steps` steps: in one go, unless there is whole-domain work inside them.
    pub fn run(
        &mut self,
        step: &Step<D>,
        desk: &mut Desk,
        steps: Range<u64>,
        watch: Watch<'_>,
    ) -> Result<(), Failure> {
        if !step.has_whole() {
            return self.leg(step, desk, Stint { steps, parts: 0..step.parts() }, watch);
        }
        for now in steps {
            for stretch in &step.stretches {
                match stretch {
                    Stretch::Parts(parts) => {
                        let stint = Stint { steps: now..now + 1, parts: parts.clone() };
                        self.leg(step, desk, stint, watch)?;
                    }
                    Stretch::Whole(part) => self.whole(step, now, *part, watch)?,
                }
            }
        }
        Ok(())
    }

    /// Runs the stages of `step` once, without advancing time.
    pub fn once(&mut self, step: &Step<D>) -> Result<(), Failure> {
        let mut desk = Desk::new(step, self.columns, self.executor.team().workers());
        let now = self.clock.step();
        self.run(step, &mut desk, now..now + 1, Watch::default())
    }

    fn leg(
        &mut self,
        step: &Step<D>,
        desk: &mut Desk,
        stint: Stint,
        watch: Watch<'_>,
    ) -> Result<(), Failure> {
        let (first, part) = (stint.steps.start, stint.parts.start);
        let begin = watch.trace.map(Trace::now);
        let leg = Leg::new(self.domain, self.columns, step, desk, self.clock, stint, watch)
            .map_err(|fault| Failure {
                step: first,
                part,
                stage: "division of space".to_owned(),
                sub_domain: None,
                cause: Cause::Fault(fault),
            })?
            .past_caches(self.past_caches);
        self.executor.run(&leg);
        let outcome = leg.finish();
        if let (Some(trace), Some(begin)) = (watch.trace, begin) {
            trace.record_leg(begin, first);
        }
        outcome
    }

    fn whole(
        &mut self,
        step: &Step<D>,
        now: u64,
        part: usize,
        watch: Watch<'_>,
    ) -> Result<(), Failure> {
        let begin = watch.trace.map(Trace::now);
        let entry = &step.entries[step.part_start[part]];
        let stage = &step.stages[entry.stage];
        let moment = self.clock.moment(now, entry.c);
        let mut whole = Whole {
            domain: self.domain,
            columns: self.columns,
            team: self.executor.team(),
            step: now,
            time: moment.stage_time,
            dt: moment.dt,
            partials: self.partials,
        };
        let outcome = catch_unwind(AssertUnwindSafe(|| stage.run_whole(&mut whole)));
        if let (Some(trace), Some(begin)) = (watch.trace, begin) {
            trace.record_whole(begin, now, part);
        }
        let cause = match outcome {
            Ok(Ok(())) => {
                let after = step.swapped_before_part(part + 1);
                step.exchange(self.columns, entry.swapped ^ after);
                return Ok(());
            }
            Ok(Err(fault)) => Cause::Fault(fault),
            Err(panic) => Cause::Panic(panic_message(panic)),
        };
        let stage = stage.name().to_owned();
        Err(Failure { step: now, part, stage, sub_domain: None, cause })
    }
}
