//! A run and what is asked of it.

use std::convert::Infallible;
use std::path::PathBuf;
use std::time::Duration;

use super::every::Timetable;
use super::monitor::{Criterion, Monitor};
use super::record::Record;
use super::{Dump, Every, History, Progress, Until};
use crate::domain::Domain;
use crate::port::{Choice, Inbox, Port};
use crate::simulation::Simulation;
use crate::viewable::{Geometry, Viewable};
use crate::whole::Whole;

/// A simulation with a plan: when it ends and what is written on the way.
///
/// Made by [`Run::new`] and the methods that add to it, carried out by [`Run::run`].
pub struct Run<D: Domain> {
    pub(super) simulation: Simulation<D>,
    pub(super) until: Until,
    pub(super) folder: Option<PathBuf>,
    /// What is modelled, in words.
    pub(super) scene: String,
    pub(super) monitors: Vec<Monitor<D>>,
    /// Of each monitor, its history.
    pub(super) histories: Vec<History>,
    pub(super) dumps: Vec<PlannedDump>,
    pub(super) criteria: Vec<Criterion<D>>,
    pub(super) checkpoints: Option<Checkpoints>,
    pub(super) control: Choice<'static, Request, Infallible>,
    pub(super) takes_stops: bool,
    pub(super) takes_requests: bool,
    pub(super) progress: Option<(Port<Progress>, Duration)>,
    /// The checkpoint to go on from, until that is done.
    pub(super) restart_from: Option<PathBuf>,
    pub(super) record: Record,
    /// Step of the last checkpoint that was posted to be written.
    pub(super) saved_at: Option<u64>,
    /// The last checkpoint that is known to be complete.
    pub(super) last_checkpoint: Option<PathBuf>,
}

pub(super) struct PlannedDump {
    pub dump: Dump,
    pub geometry: Geometry,
    pub timetable: Timetable,
    /// Step that was shown last.
    pub shown: Option<u64>,
}

pub(super) struct Checkpoints {
    pub timetable: Timetable,
    pub keep: usize,
}

/// What somebody outside asks of the run.
#[derive(Clone, Copy, Debug)]
pub(super) enum Request {
    Stop,
    Checkpoint,
}

impl<D: Domain> Run<D> {
    /// A run of `simulation` from where it is, with no end and no outputs yet.
    pub fn new(simulation: Simulation<D>) -> Self {
        Self {
            simulation,
            until: Until::default(),
            folder: None,
            scene: String::new(),
            monitors: Vec::new(),
            histories: Vec::new(),
            dumps: Vec::new(),
            criteria: Vec::new(),
            checkpoints: None,
            control: Choice::new(),
            takes_stops: false,
            takes_requests: false,
            progress: None,
            restart_from: None,
            record: Record::default(),
            saved_at: None,
            last_checkpoint: None,
        }
    }

    /// Ends the run when the first of these limits is reached.
    #[must_use]
    pub fn until(mut self, until: Until) -> Self {
        self.until = until;
        self
    }

    /// Ends the run if `criterion`, which is asked at the moments `every`, says so. It sees the
    /// state and the monitors' histories, and must decide from them alone, so that a restarted run
    /// ends at the same step.
    #[must_use]
    pub fn stop_when(
        mut self,
        every: Every,
        criterion: impl FnMut(&mut Whole<'_, D>, &[History]) -> bool + Send + 'static,
    ) -> Self {
        let (timetable, question) = (Timetable::new(every), Box::new(criterion));
        self.criteria.push(Criterion { timetable, question });
        self
    }

    /// Ends the run, in order, when a message comes: Ctrl-C, say.
    #[must_use]
    pub fn stop_on(mut self, stops: Inbox<()>) -> Self {
        self.control = self.control.on(stops, |()| Ok(Request::Stop));
        self.takes_stops = true;
        self
    }

    /// Writes a checkpoint for every message, as soon as the workers come back; it is one of the
    /// run's checkpoints like those of [`Run::checkpoint`].
    #[must_use]
    pub fn checkpoint_on(mut self, requests: Inbox<()>) -> Self {
        self.control = self.control.on(requests, |()| Ok(Request::Checkpoint));
        self.takes_requests = true;
        self
    }

    /// The folder for all files, which is made if need be. Without one, monitors write no files.
    #[must_use]
    pub fn out(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folder = Some(folder.into());
        self
    }

    /// Says what is modelled, a line each for name and value of all that decides it: a checkpoint
    /// of another scene is refused, with the lines in which it differs.
    #[must_use]
    pub fn scene(mut self, description: impl Into<String>) -> Self {
        self.scene = description.into();
        self
    }

    /// The hash by which checkpoints know their scene.
    pub(super) fn scene_hash(&self) -> u64 {
        xxhash_rust::xxh3::xxh3_64(self.scene.as_bytes())
    }

    /// Keeps a history of `N` numbers with these `columns`, and writes it to `NAME.csv`.
    ///
    /// `probe` must follow from the state alone and leave it as it is, so that a restarted run has
    /// the same history; use the reductions of [`Whole`], whose bits do not depend on the workers.
    #[must_use]
    pub fn monitor<const N: usize>(
        mut self,
        name: &str,
        every: Every,
        columns: [&str; N],
        mut probe: impl FnMut(&mut Whole<'_, D>) -> [f64; N] + Send + 'static,
    ) -> Self {
        self.histories.push(History::new(name.to_owned(), columns.map(str::to_owned).to_vec()));
        self.monitors.push(Monitor {
            timetable: Timetable::new(every),
            probe: Box::new(move |whole, row| row.extend(probe(whole))),
        });
        self
    }

    /// Writes a checkpoint at the moments `every` but the beginning, and when the run ends in
    /// order; removes old ones so that the last `keep` stay.
    #[must_use]
    pub fn checkpoint(mut self, every: Every, keep: usize) -> Self {
        self.checkpoints = Some(Checkpoints { timetable: Timetable::new(every), keep });
        self
    }

    /// Posts how far the run is, at most once a leg and not sooner than `at_least` after the last
    /// time. A bounded port that is full misses one; a closed one is no error.
    #[must_use]
    pub fn progress(mut self, port: Port<Progress>, at_least: Duration) -> Self {
        self.progress = Some((port, at_least));
        self
    }

    /// Goes on from a checkpoint that a run of the same model wrote, with the same bits as if it
    /// had not been interrupted. Histories and series in the folder are cut back to it.
    ///
    /// [`Until::time`] is part of what is computed: with another end than the interrupted run
    /// had, the last steps differ; of a method with a fixed time step, all of them.
    #[must_use]
    pub fn restart_from(mut self, checkpoint: impl Into<PathBuf>) -> Self {
        self.restart_from = Some(checkpoint.into());
        self
    }

    /// The simulation.
    pub fn simulation(&self) -> &Simulation<D> {
        &self.simulation
    }

    /// Gives the simulation back, to go on with it otherwise.
    pub fn into_simulation(self) -> Simulation<D> {
        self.simulation
    }

    /// The simulation, to look at it with its team.
    pub fn simulation_mut(&mut self) -> &mut Simulation<D> {
        &mut self.simulation
    }

    /// The histories so far, in order of the monitors' declaration.
    pub fn histories(&self) -> &[History] {
        &self.histories
    }
}

impl<D: Viewable> Run<D> {
    /// Writes a series of files for viewing.
    #[must_use]
    pub fn dump(mut self, dump: Dump) -> Self {
        let geometry = self.simulation.domain().geometry();
        let timetable = Timetable::new(dump.every);
        self.dumps.push(PlannedDump { dump, geometry, timetable, shown: None });
        self
    }
}
