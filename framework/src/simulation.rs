//! A simulation: a method's model, run step by step under a schedule.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::clock::Clock;
use crate::columns::Columns;
use crate::domain::Domain;
use crate::integrator::Plan;
use crate::leg::{Cause, Desk, Failure, Leg, panic_message};
use crate::schedule::{Executor, HandOut, Schedule};
use crate::stage::Fault;
use crate::whole::{FixedPace, Pace, Pacing, Partials, Whole, WholeStage};

/// What a method builds: divided space, fields, and the stages that advance them.
pub struct Model<D: Domain> {
    /// The method's name, for messages and checkpoints.
    pub method: String,
    /// Divided space.
    pub domain: D,
    /// Fields, with their initial state.
    pub columns: Columns,
    /// The step, and what comes before the first.
    pub plan: Plan<D>,
    /// Whole-domain stages, run in order at the beginning of every pace.
    pub whole: Vec<Box<dyn WholeStage<D>>>,
    /// Time step control, run after them.
    pub pacing: Box<dyn Pacing<D>>,
}

impl<D: Domain> Model<D> {
    /// A model that needs no whole-domain work, stepped by the same `dt` always.
    pub fn with_fixed_dt(
        method: &str,
        domain: D,
        columns: Columns,
        plan: impl Into<Plan<D>>,
        dt: f64,
    ) -> Self {
        Self {
            method: method.to_owned(),
            domain,
            columns,
            plan: plan.into(),
            whole: Vec::new(),
            pacing: Box::new(FixedPace(dt)),
        }
    }
}

/// How to run a model; none of it changes a result.
#[derive(Clone, Debug)]
pub struct Settings {
    /// How workers meet.
    pub schedule: Schedule,
    /// Number of workers; all cores by default.
    pub workers: usize,
    /// Order of hand-out.
    pub hand_out: HandOut,
    /// Check that state columns are finite after every so many steps; `None` never. A NaN
    /// spreads to a neighbourhood a step, so a check every few steps still says where it began.
    pub check_every: Option<u64>,
    /// Most steps that `PeerToPeer` runs between meetings; chosen from the size of the cache and
    /// of a sub-domain if `None`.
    pub steps_ahead: Option<u64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            schedule: Schedule::default(),
            workers: crate::dispatch::cores(),
            hand_out: HandOut::default(),
            check_every: Some(10),
            steps_ahead: None,
        }
    }
}

/// Why a run ended before its time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{method}: step {step} (t = {time:.6e}), stage {stage:?}{}: {cause}", at(*.sub_domain))]
pub struct RunError {
    /// The method.
    pub method: String,
    /// Number of the step that failed, counted from 0.
    pub step: u64,
    /// Time at its beginning.
    pub time: f64,
    /// Name of the stage.
    pub stage: String,
    /// Number of the sub-domain; `None` for whole-domain work.
    pub sub_domain: Option<usize>,
    /// Why.
    pub cause: Cause,
}

fn at(sub_domain: Option<usize>) -> String {
    sub_domain.map_or_else(String::new, |id| format!(", sub-domain {id}"))
}

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
    begun: bool,
    settings: Settings,
}

impl<D: Domain> Simulation<D> {
    /// Starts the workers; nothing is computed yet.
    ///
    /// # Errors
    /// If the system refuses threads, or there are to be no workers.
    ///
    /// # Panics
    /// If the step swaps columns of different types: its handles belong to other columns.
    pub fn new(model: Model<D>, settings: Settings) -> std::io::Result<Self> {
        let executor =
            Executor::new(settings.schedule, settings.workers, settings.hand_out.clone())?;
        Ok(Self {
            desk: Desk::new(&model.plan.step, &model.columns, settings.workers),
            executor,
            model,
            partials: Partials::default(),
            clock: Clock::new(0.0),
            pace_left: 0,
            end_time: None,
            begun: false,
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

    /// How it is run.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Shortens the last steps so that one ends at `time` exactly. Set it before the steps near
    /// the end: a pace that has begun is not changed.
    pub fn end_at(&mut self, time: f64) {
        self.end_time = Some(time);
    }

    /// Everything at once, with the team: for monitors.
    pub fn whole(&mut self) -> Whole<'_, D> {
        Whole {
            domain: &mut self.model.domain,
            columns: &mut self.model.columns,
            team: self.executor.team(),
            step: self.clock.step(),
            time: self.clock.time(),
            partials: &mut self.partials,
        }
    }

    /// Prepares the first step: whole-domain work, and the rates that the integrator wants to
    /// have before it. [`Simulation::advance`] does so by itself; call it to look at the initial
    /// state as the stages see it.
    ///
    /// # Errors
    /// As [`Simulation::advance`].
    pub fn begin(&mut self) -> Result<(), RunError> {
        if self.begun {
            return Ok(());
        }
        self.begin_pace()?;
        if let Some(prologue) = &self.model.plan.prologue {
            let mut desk = Desk::new(prologue, &self.model.columns, self.settings.workers);
            let step = self.clock.step();
            let leg = Leg::new(
                &self.model.domain,
                &mut self.model.columns,
                prologue,
                &mut desk,
                &self.clock,
                step..step + 1,
                None,
            );
            self.executor.run(&leg);
            leg.finish().map_err(|failure| self.error(failure))?;
        }
        self.begun = true;
        Ok(())
    }

    /// Advances by `steps` steps.
    ///
    /// # Errors
    /// If a stage fails, panics or leaves a value that is not finite. The state is then that of
    /// no step in particular; go back to the last checkpoint.
    pub fn advance(&mut self, steps: u64) -> Result<(), RunError> {
        self.begin()?;
        let mut left = steps;
        while left > 0 {
            if self.pace_left == 0 {
                self.begin_pace()?;
            }
            let steps = left.min(self.pace_left).min(self.steps_ahead());
            let first = self.clock.step();
            let leg = Leg::new(
                &self.model.domain,
                &mut self.model.columns,
                &self.model.plan.step,
                &mut self.desk,
                &self.clock,
                first..first + steps,
                self.settings.check_every,
            );
            self.executor.run(&leg);
            leg.finish().map_err(|failure| self.error(failure))?;
            self.clock.advance(steps);
            self.pace_left -= steps;
            left -= steps;
        }
        Ok(())
    }

    /// Steps until whole-domain work is due again or the end time is reached, whichever is first.
    pub fn pace_left(&self) -> u64 {
        self.pace_left
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

    /// Steps between meetings: bounded for `PeerToPeer`, where a sub-domain and those around it
    /// should stay in the cache while time goes on.
    fn steps_ahead(&self) -> u64 {
        if self.executor.schedule() != Schedule::PeerToPeer {
            return u64::MAX;
        }
        // A leg's parts are counted in 32 bits.
        self.settings.steps_ahead.unwrap_or(8).clamp(1, 1 << 16)
    }

    fn begin_pace(&mut self) -> Result<(), RunError> {
        let mut whole = Whole {
            domain: &mut self.model.domain,
            columns: &mut self.model.columns,
            team: self.executor.team(),
            step: self.clock.step(),
            time: self.clock.time(),
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
        Err(RunError {
            method: self.model.method.clone(),
            step: self.clock.step(),
            time: self.clock.time(),
            stage: stage.to_owned(),
            sub_domain: None,
            cause,
        })
    }

    fn set_pace(&mut self, pace: Pace) {
        let Pace { mut dt, mut steps } = pace;
        if let Some(end) = self.end_time {
            let remaining = end - self.clock.time();
            // A whole number of steps but for rounding is not worth one more.
            let needed = (remaining / dt - 1e-9).ceil();
            if needed >= 1.0 && needed <= steps as f64 {
                dt = remaining / needed;
                steps = needed as u64;
            }
        }
        self.clock.set_dt(dt);
        self.pace_left = steps;
    }

    fn error(&self, failure: Failure) -> RunError {
        RunError {
            method: self.model.method.clone(),
            step: failure.step,
            time: self.clock.time_at(failure.step),
            stage: failure.stage,
            sub_domain: Some(failure.sub_domain),
            cause: failure.cause,
        }
    }
}
