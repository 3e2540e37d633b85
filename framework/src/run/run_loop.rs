//! The loop itself.

use std::path::PathBuf;
use std::time::Duration;

use super::monitor::look;
use super::plan::Request;
use super::progress::Stopwatch;
use super::store::{Layout, Row, Store};
use super::view::View;
use super::writer::Writer;
use super::{Run, RunFailed, RunFailure, Stopped, Summary};
use crate::checkpoint::Header;
use crate::columns::ColumnId;
use crate::domain::Domain;
use crate::port::Arbiter;

/// What a run has besides its plan while it goes on.
struct Course {
    watch: Stopwatch,
    /// If there is a folder.
    writer: Option<Writer>,
    /// Of each dump, how it is shown.
    views: Vec<View>,
    /// Columns that a checkpoint saves.
    kept: Vec<ColumnId>,
}

impl<D: Domain> Run<D> {
    /// Runs to the end. What was posted to be written is written when it returns, however it ends.
    ///
    /// May be called again after it has returned without error, with other limits
    /// ([`Run::until`]), to go on.
    ///
    /// # Errors
    /// If the plan makes no sense, the checkpoint to restart from does not fit, a stage fails or
    /// an output cannot be written; the error names the last checkpoint that is complete.
    pub fn run(&mut self) -> Result<Summary, RunFailed> {
        let mut files = Vec::new();
        match self.carry_out(&mut files) {
            Ok((stopped, watch)) => {
                let simulation = &self.simulation;
                Ok(Summary {
                    stopped,
                    step: simulation.clock().step(),
                    steps_done: watch.steps(),
                    time: simulation.clock().time(),
                    wall_clock: watch.elapsed(),
                    state_hash: simulation.state_hash(),
                    instruction_sets: simulation.instruction_sets().to_vec(),
                    histories: self.histories.clone(),
                    files,
                    last_checkpoint: self.last_checkpoint.clone(),
                })
            }
            Err(cause) => Err(RunFailed { cause, last_checkpoint: self.last_checkpoint.clone() }),
        }
    }

    fn carry_out(&mut self, files: &mut Vec<PathBuf>) -> Result<(Stopped, Stopwatch), RunFailure> {
        let mut course = self.prepare()?;
        let outcome = self.steps(&mut course);
        let Course { mut watch, writer, .. } = course;
        let mut written = Ok(());
        if let Some(writer) = writer {
            let store;
            (store, written) = writer.finish();
            if let Some(store) = store {
                self.record = store.record();
                files.extend_from_slice(store.files());
                if let Some(path) = store.last_checkpoint() {
                    self.last_checkpoint = Some(path.to_path_buf());
                }
            }
        }
        watch.read();
        // What stopped the stepping came first.
        let stopped = outcome?;
        written?;
        Ok((stopped, watch))
    }

    fn prepare(&mut self) -> Result<Course, RunFailure> {
        let watch = Stopwatch::start();
        self.check()?;
        let columns = self.simulation.columns();
        let views = self.dumps.iter();
        let views = views.map(|d| View::new(&d.dump, d.geometry.clone(), columns));
        let views: Vec<View> = views.collect::<Result<_, _>>()?;
        if let Some(path) = self.restart_from.clone() {
            self.resume(&path)?;
            self.restart_from = None;
            self.check_end(&path)?;
        }
        self.simulation.end_at(self.until.time);
        let writer = match self.folder.clone() {
            Some(folder) => Some(self.start_writer(folder, views.clone())?),
            None => None,
        };
        let kept = self.simulation.kept().map(|(_, id, _)| id).collect();
        Ok(Course { watch, writer, views, kept })
    }

    fn start_writer(&self, folder: PathBuf, views: Vec<View>) -> Result<Writer, RunFailure> {
        let method = self.simulation.model().method.clone();
        let layout = Layout {
            folder,
            views,
            header: Header { method, scene_hash: self.scene_hash() },
            scene: self.scene.clone(),
            kept: self.simulation.kept().map(|(name, ..)| name.to_owned()).collect(),
            keep: self.checkpoints.as_ref().map_or(usize::MAX, |checkpoints| checkpoints.keep),
        };
        Writer::start(Store::open(layout, self.histories.clone(), &self.record)?)
    }

    /// Steps and outputs in turn. At every step the order is: monitors, dumps, criteria,
    /// checkpoint, and only then the whole-domain work of the next pace; so that a checkpoint
    /// stands behind all outputs of its step and before anything of the next.
    fn steps(&mut self, course: &mut Course) -> Result<Stopped, RunFailure> {
        if !self.simulation.has_begun() {
            self.simulation.begin()?;
        }
        loop {
            self.take_rows(course)?;
            self.take_dumps(course, false)?;
            let (asked, mut save) = self.requests();
            let stopped = self.stopped(asked, &course.watch)?;
            if stopped.is_some() {
                self.take_dumps(course, true)?;
                self.simulation.derive()?;
            }
            if let Some(checkpoints) = &mut self.checkpoints {
                let clock = self.simulation.clock();
                save |= checkpoints.timetable.take(clock) && clock.step() > 0;
                save |= stopped.is_some();
            }
            save |= stopped.is_some() && self.takes_requests;
            // Stages are checked every few steps only; what is kept for good must be good.
            if save || stopped.is_some() {
                self.simulation.check_finite()?;
            }
            if save {
                self.take_checkpoint(course)?;
            }
            if let Some(writer) = &mut course.writer {
                writer.look()?;
            }
            self.report(&mut course.watch, stopped.is_some());
            if let Some(stopped) = stopped {
                return Ok(stopped);
            }
            self.simulation.begin()?;
            let steps = self.steps_left(&course.watch);
            self.simulation.advance(steps)?;
            course.watch.lap(steps);
        }
    }

    /// Takes the rows that are due.
    fn take_rows(&mut self, course: &Course) -> Result<(), RunFailure> {
        let clock = *self.simulation.clock();
        let (step, time) = (clock.step(), clock.time());
        for (number, monitor) in self.monitors.iter_mut().enumerate() {
            if !monitor.timetable.take(&clock) {
                continue;
            }
            let history = &mut self.histories[number];
            let mut values = Vec::with_capacity(history.columns().len());
            let name = || format!("monitor {}", history.name());
            self.simulation.derive()?;
            look(&mut self.simulation, name, |whole| (monitor.probe)(whole, &mut values))?;
            history.push(step, time, &values);
            if let Some(writer) = &course.writer {
                writer.log(Row { monitor: number, step, time, values })?;
            }
        }
        Ok(())
    }

    /// Posts the dumps that are due.
    fn take_dumps(&mut self, course: &mut Course, is_last: bool) -> Result<(), RunFailure> {
        let clock = *self.simulation.clock();
        for (number, dump) in self.dumps.iter_mut().enumerate() {
            let is_due = dump.timetable.take(&clock) || (is_last && dump.dump.has_last);
            if is_due
                && dump.shown != Some(clock.step())
                && let Some(writer) = &mut course.writer
            {
                dump.shown = Some(clock.step());
                self.simulation.derive()?;
                let mut snapshot = writer.snapshot()?;
                let ids = course.views[number].columns();
                snapshot.take(clock.step(), clock.time(), self.simulation.columns(), ids);
                writer.dump(number, snapshot)?;
            }
        }
        Ok(())
    }

    /// Whether somebody asks for a stop, and for a checkpoint.
    fn requests(&mut self) -> (bool, bool) {
        let (mut stop, mut save) = (false, false);
        // The handlers of these ports cannot fail.
        while let Some(request) = self.control.try_wait() {
            match request {
                Ok(Request::Stop) => stop = true,
                Ok(Request::Checkpoint) => save = true,
                Err(_) => {}
            }
        }
        (stop, save)
    }

    /// Whether the run is over.
    fn stopped(&mut self, asked: bool, watch: &Stopwatch) -> Result<Option<Stopped>, RunFailure> {
        let mut met = false;
        for criterion in &mut self.criteria {
            if criterion.timetable.take(self.simulation.clock()) {
                let name = || "stop criterion".to_owned();
                let histories = &self.histories;
                self.simulation.derive()?;
                met |= look(&mut self.simulation, name, |whole| {
                    (criterion.question)(whole, histories)
                })?;
            }
        }
        let (clock, until) = (self.simulation.clock(), &self.until);
        let reasons = [
            (until.time.is_some_and(|end| clock.time() >= end), Stopped::Time),
            (until.steps.is_some_and(|end| clock.step() >= end), Stopped::Steps),
            (met, Stopped::Criterion),
            (asked, Stopped::Asked),
            (until.wall_clock.is_some_and(|end| watch.elapsed() >= end), Stopped::WallClock),
        ];
        Ok(reasons.into_iter().find(|(holds, _)| *holds).map(|(_, stopped)| stopped))
    }

    /// Posts a checkpoint of this step, unless there is one already.
    ///
    /// The writer thread writes it, from a copy: syncing a file takes as long as many steps.
    fn take_checkpoint(&mut self, course: &mut Course) -> Result<(), RunFailure> {
        let (step, time) = (self.simulation.clock().step(), self.simulation.clock().time());
        let Some(writer) = &mut course.writer else { return Ok(()) };
        if self.saved_at == Some(step) {
            return Ok(());
        }
        let mut snapshot = writer.snapshot()?;
        snapshot.take(step, time, self.simulation.columns(), &course.kept);
        writer.checkpoint(self.simulation.position(), snapshot)?;
        self.saved_at = Some(step);
        Ok(())
    }

    fn report(&mut self, watch: &mut Stopwatch, is_last: bool) {
        if let Some((port, at_least)) = &self.progress {
            let at_least = if is_last { Duration::ZERO } else { *at_least };
            let progress = watch.report(at_least, self.simulation.clock(), &self.until);
            if let Some(progress) = progress {
                // Who has no room or does not listen misses it.
                let _ = port.try_post(progress);
            }
        }
    }

    /// Steps to the next moment at which there is something to do.
    fn steps_left(&self, watch: &Stopwatch) -> u64 {
        let simulation = &self.simulation;
        let clock = simulation.clock();
        let meeting = match simulation.leg_steps() {
            u64::MAX => 1,
            steps => steps,
        };
        let end = self.until.steps.map_or(u64::MAX, |end| end - clock.step());
        let within = simulation.pace_left().min(watch.stride(meeting)).min(end);
        let monitors = self.monitors.iter().map(|monitor| &monitor.timetable);
        let dumps = self.dumps.iter().map(|dump| &dump.timetable);
        let criteria = self.criteria.iter().map(|criterion| &criterion.timetable);
        let checkpoints = self.checkpoints.iter().map(|checkpoints| &checkpoints.timetable);
        let all = monitors.chain(dumps).chain(criteria).chain(checkpoints);
        all.fold(within, |steps, timetable| timetable.steps_left(clock, steps))
    }
}
