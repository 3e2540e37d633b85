//! Taking up a run from a checkpoint.

use std::path::Path;

use super::record::{Record, history_blocks};
use super::{History, Run, RunFailure};
use crate::checkpoint::CheckpointReader;
use crate::domain::Domain;
use crate::simulation::{RestoreError, Saved};

impl<D: Domain> Run<D> {
    /// Brings everything to where it was when the checkpoint `path` was written.
    pub(super) fn resume(&mut self, path: &Path) -> Result<(), RunFailure> {
        let mut reader = CheckpointReader::open(path).map_err(RestoreError::from)?;
        let method = &self.simulation.model().method;
        reader.require_method(method).map_err(RestoreError::from)?;
        let saved = Saved::read(path, &reader)?;
        let mut record = Record::from_bytes(&saved.passenger, path).map_err(RestoreError::from)?;
        if reader.header().scene_hash != self.scene_hash() {
            let (path, differences) = (path.to_path_buf(), record.differences(&self.scene));
            return Err(RunFailure::Scene { path, differences });
        }
        for history in &mut self.histories {
            restore_history(history, &record, &mut reader, path)?;
        }
        self.simulation.restore_from(path, &mut reader, saved.position)?;
        let clock = self.simulation.clock();
        let monitors = self.monitors.iter_mut().map(|monitor| &mut monitor.timetable);
        let dumps = self.dumps.iter_mut().map(|dump| &mut dump.timetable);
        let checkpoints = self.checkpoints.iter_mut().map(|checkpoints| &mut checkpoints.timetable);
        for timetable in monitors.chain(dumps).chain(checkpoints) {
            timetable.skip(clock);
        }
        // Asked again here, a criterion that was met here ends the run again.
        for criterion in &mut self.criteria {
            criterion.timetable.skip_before(clock);
        }
        // It was written before it could know of itself.
        if !record.checkpoints.contains(&clock.step()) {
            record.checkpoints.push(clock.step());
        }
        self.record = record;
        self.saved_at = Some(clock.step());
        self.last_checkpoint = Some(path.to_path_buf());
        Ok(())
    }
}

impl<D: Domain> Run<D> {
    /// Makes sure that there is something left to do after the checkpoint `path`.
    pub(super) fn check_end(&self, path: &Path) -> Result<(), RunFailure> {
        let (clock, path) = (self.simulation.clock(), path.to_path_buf());
        if let Some(end) = self.until.steps.filter(|&end| end < clock.step()) {
            let (reached, end) = (format!("step {}", clock.step()), format!("step {end}"));
            return Err(RunFailure::PastEnd { path, reached, end });
        }
        if let Some(end) = self.until.time.filter(|&end| end < clock.time()) {
            let (reached, end) = (format!("time {}", clock.time()), format!("time {end}"));
            return Err(RunFailure::PastEnd { path, reached, end });
        }
        Ok(())
    }
}

/// Takes the rows of a history from a checkpoint; a monitor that it does not know has none.
fn restore_history(
    history: &mut History,
    record: &Record,
    reader: &mut CheckpointReader,
    path: &Path,
) -> Result<(), RunFailure> {
    let name = history.name().to_owned();
    let Some((_, columns)) = record.monitors.iter().find(|(known, _)| *known == name) else {
        return Ok(());
    };
    let [steps, times, values] = history_blocks(&name);
    let steps = reader.read(&steps).map_err(RestoreError::from)?;
    let times = reader.read(&times).map_err(RestoreError::from)?;
    let values = reader.read(&values).map_err(RestoreError::from)?;
    if columns == history.columns() && history.set_rows(steps, times, values) {
        return Ok(());
    }
    Err(RunFailure::Monitor {
        path: path.to_path_buf(),
        monitor: name,
        expected: history.columns().to_vec(),
        found: columns.clone(),
    })
}
