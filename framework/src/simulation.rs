//! A simulation: a method's model, run step by step under a schedule.

mod ahead;
mod cache;
mod engine;
mod error;
mod model;
mod position;
mod saved;
mod settings;

pub use error::RunError;
pub use model::Model;
pub use position::{Position, RestoreError};
pub use settings::Settings;

pub(crate) use saved::{Saved, column_block};

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::activity::Activities;
use crate::clock::Clock;
use crate::columns::{Column, ColumnId, Columns, Role};
use crate::desk::Desk;
use crate::domain::Domain;
use crate::failure::{Cause, Failure};
use crate::integrator::Plan;
use crate::leg::Watch;
use crate::panic_message::panic_message;
use crate::schedule::{Executor, Schedule};
use crate::stage::Fault;
use crate::trace::Trace;
use crate::whole::{Pace, Partials, Whole};
use engine::Engine;

/// A model being run.
pub struct Simulation<D: Domain> {
    model: Model<D>,
    executor: Executor,
    desk: Desk,
    partials: Partials,
    clock: Clock,
    /// Steps until whole-domain work is due.
    pace_left: u64,
    end_time: Option<f64>,
    /// Instruction sets that the lanes were computed with since the beginning of time.
    instruction_sets: Vec<String>,
    begun: bool,
    /// Whether the derived fields are those of the present state.
    derived: bool,
    trace: Option<Trace>,
    settings: Settings,
}

impl<D: Domain> Simulation<D> {
    /// Starts the workers; nothing is computed yet.
    ///
    /// # Errors
    /// If the system refuses threads, or there are to be no workers.
    ///
    /// # Panics
    /// If the step swaps columns of different types: its handles belong to other columns; or a rate that none of
    /// its stages writes. If derived fields are updated instead of computed anew, or are kept from step to step: looking must not
    /// change what is computed (what whole-domain stages do is not looked at).
    pub fn new(model: Model<D>, settings: Settings) -> std::io::Result<Self> {
        for stage in model.plan.derived.iter().flat_map(|step| &step.stages) {
            let kept = |(id, column): (_, &Column)| column.is_kept() && stage.writes().contains(id);
            assert!(
                !stage.is_update() && !model.columns.iter().any(kept),
                "stage {} of derived fields changes the state",
                stage.name()
            );
        }
        let mut executor =
            Executor::new(settings.schedule, settings.workers, settings.hand_out.clone())?;
        let step = &model.plan.step;
        for &(a, b) in &step.pairs {
            let is_written = |id: &ColumnId| step.stages.iter().any(|s| s.writes().contains(*id));
            let is_rate = |id: &ColumnId| model.columns.column(*id).role() == Role::Rate;
            let mut rates = [a, b].into_iter().filter(is_rate).peekable();
            if let Some(&rate) = rates.peek() {
                let name = model.columns.column(rate).name();
                assert!(
                    rates.any(|id| is_written(&id)),
                    "column {name:?} is swapped but no stage writes it"
                );
            }
        }
        let trace = (settings.trace > 0).then(|| {
            let parts = (0..step.parts()).map(|part| step.part_name(part)).collect();
            Trace::new(parts, executor.team().workers(), settings.trace)
        });
        Ok(Self {
            desk: Desk::new(&model.plan.step, &model.columns, executor.team().workers()),
            executor,
            model,
            partials: Partials::default(),
            clock: Clock::new(0.0),
            pace_left: 0,
            end_time: None,
            instruction_sets: vec![crate::lanes::instruction_set().to_owned()],
            begun: false,
            derived: false,
            trace,
            settings,
        })
    }

    /// The model.
    pub fn model(&self) -> &Model<D> {
        &self.model
    }

    /// The fields.
    pub fn columns(&self) -> &Columns {
        &self.model.columns
    }

    /// Divided space.
    pub fn domain(&self) -> &D {
        &self.model.domain
    }

    /// Where the run is in time.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// What the workers did last, if [`Settings::trace`] asks for it.
    pub fn trace(&self) -> Option<&Trace> {
        self.trace.as_ref()
    }

    /// What the workers are doing inside stages that say ([`crate::Near::activity`]).
    pub fn activities(&self) -> Activities {
        self.desk.activities.clone()
    }

    /// How it is run.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Shortens the steps of the last pace, all alike, so that one ends at `time` exactly: a
    /// [`crate::FixedPace`] is a single one, so that all steps from here on are shortened. If the pacing
    /// does not allow it, ends a pace with the first step that reaches it; `None` for no end. Steps go on past the
    /// end if asked for.
    ///
    /// Part of what is computed, unlike the points at which a run is cut into calls of
    /// [`Simulation::advance`]: set the same end from the start, or the time step may differ.
    pub fn end_at(&mut self, time: impl Into<Option<f64>>) {
        let time = time.into();
        if time == self.end_time {
            return;
        }
        self.end_time = time;
        if self.pace_left > 0 {
            // Only a new end changes a pace that has begun: a restart with the old end must not
            // compute the time step anew, which would round it differently.
            self.set_pace(Pace { dt: self.clock.dt(), steps: self.pace_left });
        }
    }

    /// Everything at once, with the team: for monitors.
    pub fn whole(&mut self) -> Whole<'_, D> {
        Whole {
            domain: &mut self.model.domain,
            columns: &mut self.model.columns,
            team: self.executor.team(),
            step: self.clock.step(),
            time: self.clock.time(),
            dt: self.clock.dt(),
            partials: &mut self.partials,
        }
    }

    /// Prepares the next step: whole-domain work if it is due and, before the first step, the
    /// rates that the integrator wants to have. [`Simulation::advance`] does so by itself; call it
    /// to look at the initial state as the stages see it, or to know the time step.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn begin(&mut self) -> Result<(), RunError> {
        if self.pace_left == 0 {
            self.derived = false;
            self.begin_pace()?;
        }
        if self.begun {
            return Ok(());
        }
        let (mut engine, plan, ..) = self.engine();
        let outcome = plan.prologue.as_ref().map_or(Ok(()), |step| engine.once(step));
        outcome.map_err(|failure| self.error(failure))?;
        self.begun = true;
        Ok(())
    }

    /// Brings the derived fields ([`crate::Plan::derived`]) up to date with the present state; costs
    /// nothing if they are. [`crate::run::Run`] does so before anybody looks.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn derive(&mut self) -> Result<(), RunError> {
        if self.derived {
            return Ok(());
        }
        let (mut engine, plan, ..) = self.engine();
        let outcome = plan.derived.as_ref().map_or(Ok(()), |step| engine.once(step));
        outcome.map_err(|failure| self.error(failure))?;
        self.derived = true;
        Ok(())
    }

    /// Advances by `steps` steps.
    ///
    /// # Errors
    /// If a stage fails, panics or leaves a value that is not finite, or if whoever divided space anew
    /// left a partition that is not sealed or has other points than the columns. The state is then that of
    /// no step in particular; go back to the last checkpoint.
    pub fn advance(&mut self, steps: u64) -> Result<(), RunError> {
        let mut left = steps;
        while left > 0 {
            self.begin()?;
            self.derived = false;
            let steps = left.min(self.pace_left).min(self.leg_steps());
            let first = self.clock.step();
            let (mut engine, plan, desk, watch) = self.engine();
            let outcome = engine.run(&plan.step, desk, first..first + steps, watch);
            outcome.map_err(|failure| self.error(failure))?;
            self.clock.advance(steps);
            self.pace_left -= steps;
            left -= steps;
        }
        Ok(())
    }

    /// Whether the first step has been prepared, by [`Simulation::begin`].
    pub fn has_begun(&self) -> bool {
        self.begun
    }

    /// Steps until whole-domain work is due again or the end time is reached, whichever is first.
    pub fn pace_left(&self) -> u64 {
        self.pace_left
    }

    /// The instruction sets that it has been computed with since the beginning of time, in order of
    /// first use: several after a restart on another kind of processor. The same bits are promised
    /// for one.
    pub fn instruction_sets(&self) -> &[String] {
        &self.instruction_sets
    }

    /// Hash of all kept columns' bits and of the number of steps: two runs agree if and (but for
    /// collisions) only if this does.
    pub fn state_hash(&self) -> u64 {
        let columns = &self.model.columns;
        let mut hash = xxhash_rust::xxh3::Xxh3::new();
        hash.update(&self.clock.step().to_le_bytes());
        for (id, column) in columns.iter().filter(|(_, c)| c.is_kept()) {
            hash.update(column.name().as_bytes());
            hash.update(columns.bytes(id));
        }
        hash.digest()
    }

    /// Most steps that the workers run without coming back: bounded for `PeerToPeer` only, where
    /// a sub-domain and those around it should stay in the cache while time goes on.
    pub fn leg_steps(&self) -> u64 {
        if self.executor.schedule() != Schedule::PeerToPeer {
            return u64::MAX;
        }
        let chosen = self.settings.steps_ahead;
        let steps =
            chosen.unwrap_or_else(|| ahead::steps_ahead(&self.model, self.settings.workers));
        // A leg's parts are counted in 32 bits.
        steps.clamp(1, 1 << 16)
    }

    /// What runs steps, the plan, and what the steps of the plan need.
    fn engine(&mut self) -> (Engine<'_, D>, &Plan<D>, &mut Desk, Watch<'_>) {
        let Model { domain, columns, plan, .. } = &mut self.model;
        let (executor, partials, clock) = (&mut self.executor, &mut self.partials, &self.clock);
        let watch = Watch { check_every: self.settings.check_every, trace: self.trace.as_ref() };
        // Nothing of what a sweep writes is still in the caches when the next one reads it.
        let is_swept = executor.schedule() != Schedule::PeerToPeer;
        let past_caches = is_swept && columns.memory() > 4 * cache::cache_share(1);
        let engine = Engine { domain, columns, executor, partials, clock, past_caches };
        (engine, plan, &mut self.desk, watch)
    }

    fn begin_pace(&mut self) -> Result<(), RunError> {
        let mut whole = Whole {
            domain: &mut self.model.domain,
            columns: &mut self.model.columns,
            team: self.executor.team(),
            step: self.clock.step(),
            time: self.clock.time(),
            dt: self.clock.dt(),
            partials: &mut self.partials,
        };
        let (stages, pacing) = (&mut self.model.whole, &mut self.model.pacing);
        let mut at = 0;
        let outcome = catch_unwind(AssertUnwindSafe(|| -> Result<Pace, Fault> {
            for stage in stages {
                stage.run(&mut whole)?;
                at += 1;
            }
            pacing.pace(&mut whole)
        }));
        let cause = match outcome {
            Ok(Ok(pace)) if pace.dt > 0.0 && pace.dt.is_finite() && pace.steps > 0 => {
                self.set_pace(pace);
                return Ok(());
            }
            Ok(Ok(pace)) => Cause::Fault(Fault::new(format!(
                "{pace:?} is no pace: the time step must be positive and finite"
            ))),
            Ok(Err(fault)) => Cause::Fault(fault),
            Err(panic) => Cause::Panic(panic_message(panic)),
        };
        let stage = self.model.whole.get(at).map_or("time step control", |stage| stage.name());
        Err(self.error_now(stage, None, cause))
    }

    /// Makes sure that all state is finite and within its limits now, unless [`Settings::check_every`] is `None`.
    ///
    /// # Errors
    /// Names the column and the sub-domain.
    pub fn check_finite(&self) -> Result<(), RunError> {
        if self.settings.check_every.is_none() {
            return Ok(());
        }
        for (id, column) in self.columns().iter().filter(|(_, c)| c.role() == Role::State) {
            if let Some(point) = self.columns().any_values(id).first_beyond(column.most()) {
                let owner = self.domain().partition().owner(point);
                return Err(self.error_now("check between steps", owner, Cause::invalid(column)));
            }
        }
        Ok(())
    }

    /// An error of work that is done between steps.
    pub(crate) fn error_now(
        &self,
        stage: impl Into<String>,
        sub_domain: Option<usize>,
        cause: Cause,
    ) -> RunError {
        RunError {
            method: self.model.method.clone(),
            step: self.clock.step(),
            time: self.clock.time(),
            stage: stage.into(),
            sub_domain,
            cause,
        }
    }

    fn set_pace(&mut self, pace: Pace) {
        let Pace { mut dt, mut steps } = pace;
        let mut aim = None;
        if let Some(end) = self.end_time {
            let remaining = end - self.clock.time();
            // A whole number of steps but for rounding is not worth one more.
            let needed = (remaining / dt - 1e-9).ceil();
            if needed >= 1.0 && needed <= steps as f64 {
                steps = needed as u64;
                // A step that ends there but for rounding ends there, however rigid.
                let is_whole = (needed - remaining / dt).abs() < 1e-9 * needed;
                if is_whole || self.model.pacing.may_shorten() {
                    dt = remaining / needed;
                    aim = Some(end);
                }
            }
        }
        self.clock.set_dt(dt);
        if let Some(end) = aim {
            self.clock.aim(steps, end);
        }
        self.pace_left = steps;
    }

    fn error(&self, failure: Failure) -> RunError {
        RunError {
            method: self.model.method.clone(),
            step: failure.step,
            time: self.clock.time_at(failure.step),
            stage: failure.stage,
            sub_domain: failure.sub_domain,
            cause: failure.cause,
        }
    }
}
