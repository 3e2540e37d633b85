//! What the writer thread owns: the files of a run.

use std::fs::{self, File, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::record::{Record, checkpoint_file, history_blocks};
use super::snapshot::Snapshot;
use super::view::View;
use super::{History, OutputError};
use crate::checkpoint::Header;
use crate::format::{AtomicFile, Pvd, Values, remove_abandoned};
use crate::simulation::{Position, Saved, column_block};

/// What is written, and where.
pub(super) struct Layout {
    pub folder: PathBuf,
    pub views: Vec<View>,
    pub header: Header,
    /// What is modelled, in words.
    pub scene: String,
    /// Names of the columns that a checkpoint's snapshot copies.
    pub kept: Vec<String>,
    /// How many checkpoints are kept.
    pub keep: usize,
}

/// A row of monitor number `monitor`.
pub(super) struct Row {
    pub monitor: usize,
    pub step: u64,
    pub time: f64,
    pub values: Vec<f64>,
}

/// The files of a run; every change to them goes through here, in order.
pub(super) struct Store {
    layout: Layout,
    series: Vec<Pvd>,
    logs: Vec<Log>,
    /// Steps of the checkpoints that are kept, ascending.
    checkpoints: Vec<u64>,
    last_checkpoint: Option<PathBuf>,
    files: Vec<PathBuf>,
    /// Held until the run has ended.
    _lock: Option<File>,
}

/// A history and its file.
struct Log {
    history: History,
    path: PathBuf,
    file: File,
    /// Bytes of whole rows in the file.
    length: u64,
    line: String,
}

impl Store {
    /// Makes the folder, if need be, and brings histories and series to where the run is: what
    /// another run has written there later is cut off.
    pub fn open(
        layout: Layout,
        histories: Vec<History>,
        record: &Record,
    ) -> Result<Self, OutputError> {
        let folder = &layout.folder;
        fs::create_dir_all(folder).map_err(refused("make folder", folder))?;
        let lock = lock(folder)?;
        remove_abandoned(folder);
        let logs: Vec<Log> = histories
            .into_iter()
            .map(|history| Log::open(folder, history))
            .collect::<Result<_, _>>()?;
        let mut files: Vec<_> = logs.iter().map(|log| log.path.clone()).collect();
        let mut all_series = Vec::new();
        for view in &layout.views {
            let mut series = record.series(view.name());
            series.retain(|file| folder.join(file).exists());
            let path = series_path(folder, view);
            series.save(&path)?;
            files.push(path);
            all_series.push(series);
        }
        let mut checkpoints = record.checkpoints.clone();
        checkpoints.retain(|&step| folder.join(checkpoint_file(step)).exists());
        Ok(Self {
            layout,
            series: all_series,
            logs,
            checkpoints,
            last_checkpoint: None,
            files,
            _lock: lock,
        })
    }

    /// Appends a row to a history: all of it or, if the disk is full, nothing.
    pub fn log(&mut self, row: &Row) -> Result<(), OutputError> {
        let log = &mut self.logs[row.monitor];
        log.history.push(row.step, row.time, &row.values);
        log.line.clear();
        log.history.csv_row(log.history.len() - 1, &mut log.line);
        // One write for a whole line: who is killed leaves no half of one.
        log.file.write_all(log.line.as_bytes()).map_err(|error| {
            // If that fails too, the first error is what is to be told.
            let _ = log.file.set_len(log.length);
            refused("write", &log.path)(error)
        })?;
        log.length += log.line.len() as u64;
        Ok(())
    }

    /// Writes a file of series number `series`.
    pub fn dump(&mut self, series: usize, snapshot: &Snapshot) -> Result<(), OutputError> {
        let view = &self.layout.views[series];
        let file = format!("{}-{:09}.{}", view.name(), snapshot.step, view.extension());
        let path = self.layout.folder.join(&file);
        view.save(&path, snapshot)?;
        self.files.push(path);
        let series = &mut self.series[series];
        // A restarted run may come by a step that has been shown.
        series.retain(|known| known != file);
        series.push(snapshot.time, file)?;
        Ok(series.save(series_path(&self.layout.folder, view))?)
    }

    /// Writes a checkpoint and removes those that are one too many.
    pub fn checkpoint(
        &mut self,
        position: Position,
        snapshot: &Snapshot,
    ) -> Result<(), OutputError> {
        let step = snapshot.step;
        let path = self.layout.folder.join(checkpoint_file(step));
        let passenger = self.record().to_bytes(&path)?;
        let columns = self.layout.kept.iter().enumerate();
        let columns = columns.map(|(place, name)| (column_block(name), snapshot.values(place)));
        let histories = self.logs.iter().flat_map(|Log { history, .. }| {
            let values = [
                Values::from(history.steps()),
                Values::from(history.times()),
                Values::from(history.values()),
            ];
            history_blocks(history.name()).into_iter().zip(values)
        });
        let blocks = columns.chain(histories);
        Saved { position, passenger }.write(&path, &self.layout.header, blocks)?;
        self.last_checkpoint = Some(path.clone());
        if !self.checkpoints.contains(&step) {
            self.checkpoints.push(step);
        }
        self.files.retain(|file| *file != path);
        self.files.push(path);
        while self.checkpoints.len() > self.layout.keep {
            let old = self.layout.folder.join(checkpoint_file(self.checkpoints.remove(0)));
            match fs::remove_file(&old) {
                Err(error) if error.kind() != io::ErrorKind::NotFound => {
                    return Err(refused("remove", &old)(error));
                }
                _ => self.files.retain(|file| *file != old),
            }
        }
        Ok(())
    }

    /// What is to be remembered of the outputs.
    pub fn record(&self) -> Record {
        let names = self.layout.views.iter().map(|view| view.name().to_owned());
        let monitors = self
            .logs
            .iter()
            .map(|Log { history, .. }| (history.name().to_owned(), history.columns().to_vec()));
        Record {
            scene: self.layout.scene.clone(),
            series: names.zip(self.series.iter().cloned()).collect(),
            monitors: monitors.collect(),
            checkpoints: self.checkpoints.clone(),
        }
    }

    /// The last checkpoint that was completed.
    pub fn last_checkpoint(&self) -> Option<&Path> {
        self.last_checkpoint.as_deref()
    }

    /// The files that were written and are still there.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }
}

impl Log {
    /// Begins the file with the rows that are there, replacing an older file at once.
    fn open(folder: &Path, history: History) -> Result<Self, OutputError> {
        let path = folder.join(format!("{}.csv", history.name()));
        let mut text = history.csv_head();
        (0..history.len()).for_each(|row| history.csv_row(row, &mut text));
        let file = AtomicFile::create(&path)
            .and_then(|mut file| {
                file.write_all(text.as_bytes())?;
                file.commit()?;
                File::options().append(true).open(&path)
            })
            .map_err(refused("write", &path))?;
        Ok(Self { history, path, file, length: text.len() as u64, line: String::new() })
    }
}

/// Keeps other runs out of a folder, where the system can lock one; `None` where it cannot.
fn lock(folder: &Path) -> Result<Option<File>, OutputError> {
    let Ok(handle) = File::open(folder) else { return Ok(None) };
    match handle.try_lock() {
        Ok(()) => Ok(Some(handle)),
        Err(TryLockError::WouldBlock) => Err(OutputError::InUse { folder: folder.to_path_buf() }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

fn series_path(folder: &Path, view: &View) -> PathBuf {
    folder.join(format!("{}.pvd", view.name()))
}

fn refused(attempt: &'static str, path: &Path) -> impl FnOnce(io::Error) -> OutputError {
    let path = path.to_path_buf();
    move |source| OutputError::File { attempt, path, source }
}
