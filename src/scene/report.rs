//! What a run of a scene comes to.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use finegrain_framework::run::{Stopped, Summary};
use finegrain_framework::{Domain, Simulation, Workload, trace};

use super::SceneError;
use crate::figure::{Chart, Field, FigureError};

/// What a run looks like in the end.
#[derive(Clone, Debug)]
pub enum Picture {
    /// A field in the plane.
    Field(Field),
    /// A profile along a line.
    Chart(Chart),
}

impl Picture {
    /// Draws it and writes it as a PNG file.
    ///
    /// # Errors
    /// If there is nothing to show or the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), FigureError> {
        match self {
            Self::Field(field) => field.save(path),
            Self::Chart(chart) => chart.save(path),
        }
    }
}

impl From<Field> for Picture {
    fn from(field: Field) -> Self {
        Self::Field(field)
    }
}

impl From<Chart> for Picture {
    fn from(chart: Chart) -> Self {
        Self::Chart(chart)
    }
}

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Report {
    /// Why it ended.
    pub stopped: Stopped,
    /// Number of points.
    pub points: usize,
    /// Number of steps since the beginning of time.
    pub steps: u64,
    /// Number of steps of this run.
    pub steps_done: u64,
    /// Time reached, s.
    pub time: f64,
    /// Wall-clock time, s.
    pub wall_s: f64,
    /// Hash of the state's bits.
    pub state_hash: u64,
    /// Instruction sets that it was computed with; several after a restart on another processor, and
    /// then the last bits may differ from those of an uninterrupted run.
    pub instruction_sets: Vec<String>,
    /// The scene's named scalar results.
    pub results: BTreeMap<&'static str, f64>,
    /// Relative errors where a reference exists for these parameters.
    pub errors: BTreeMap<&'static str, f64>,
    /// What to know about the results.
    pub notes: Vec<String>,
    /// Files written.
    pub files: Vec<PathBuf>,
    /// The end.
    pub picture: Option<Picture>,
    /// How workers spent their time, if a trace was asked for.
    pub trace: Option<trace::Summary>,
    /// What a step costs, if a trace was asked for and knows it.
    pub workload: Option<Workload>,
}

impl Report {
    /// A report without results yet.
    pub fn new(summary: &Summary, points: usize) -> Self {
        Self {
            stopped: summary.stopped,
            points,
            steps: summary.step,
            steps_done: summary.steps_done,
            time: summary.time,
            wall_s: summary.wall_clock.as_secs_f64(),
            state_hash: summary.state_hash,
            instruction_sets: summary.instruction_sets.clone(),
            results: BTreeMap::new(),
            errors: BTreeMap::new(),
            notes: Vec::new(),
            files: summary.files.clone(),
            picture: None,
            trace: None,
            workload: None,
        }
    }

    /// Writes what the workers did to `path`, if there is one, and sums it up.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn trace<D: Domain>(
        &mut self,
        simulation: &Simulation<D>,
        path: Option<PathBuf>,
    ) -> Result<(), SceneError> {
        if let (Some(path), Some(trace)) = (path, simulation.trace()) {
            crate::trace::write(trace, &path)
                .map_err(|cause| SceneError::Trace { path: path.clone(), cause })?;
            self.trace = Some(trace.summary());
            self.workload = Workload::of(simulation);
            self.files.push(path);
        }
        Ok(())
    }

    /// Points times steps over wall-clock time.
    pub fn point_steps_per_s(&self) -> f64 {
        self.points as f64 * self.steps_done as f64 / self.wall_s
    }

    /// Adds a result, and its relative error if there is a reference.
    pub fn result(&mut self, name: &'static str, value: f64, reference: Option<f64>) {
        self.results.insert(name, value);
        if let Some(reference) = reference {
            self.errors.insert(name, value / reference - 1.0);
        }
    }

    /// Adds a result that is a relative error by itself: the norm of a difference, say.
    pub fn error(&mut self, name: &'static str, error: f64) {
        self.results.insert(name, error);
        self.errors.insert(name, error);
    }
}
