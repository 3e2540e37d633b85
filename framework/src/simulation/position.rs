//! Saving a simulation and going on from where it was saved, with the same bits.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::Simulation;
use super::saved::{Saved, column_block};
use crate::checkpoint::{CheckpointError, CheckpointReader, Header};
use crate::clock::Clock;
use crate::columns::{ColumnId, ElementKind};
use crate::domain::Domain;
use crate::format;
use crate::stage::Fault;

/// Where a simulation is, besides its columns: with them, all that it needs to go on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Position {
    clock: Clock,
    pace_left: u64,
    begun: bool,
    end_time: Option<f64>,
    points: u64,
    /// The stages of the step.
    step: String,
    instruction_sets: Vec<String>,
    /// What [`Domain::save`] gave.
    domain: Vec<u64>,
}

impl Position {
    /// Where it is in time.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }
}

/// Why a simulation cannot go on from a checkpoint.
#[derive(Debug, thiserror::Error)]
pub enum RestoreError {
    /// The file is no sound checkpoint of this method and scene, or lacks a column.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// The checkpoint was written by another version of this program.
    #[error(
        "checkpoint `{}` has run state of version {found}; this program reads version {supported}",
        path.display()
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// Version of the file.
        found: u32,
        /// Version that this program reads.
        supported: u32,
    },
    /// The checkpoint has another number of points than the model.
    #[error("checkpoint `{}` has {found} points, the model has {expected}", path.display())]
    Points {
        /// The file.
        path: PathBuf,
        /// Points of the model.
        expected: usize,
        /// Points of the checkpoint.
        found: u64,
    },
    /// The checkpoint is of a model with another step: another integrator, say.
    #[error(
        "checkpoint `{}` is of a model that steps by [{found}]; this one steps by [{expected}]",
        path.display()
    )]
    Step {
        /// The file.
        path: PathBuf,
        /// Stages of this model's step.
        expected: String,
        /// Stages of the step in the checkpoint.
        found: String,
    },
    /// The checkpoint has a column that the model does not have.
    #[error(
        "checkpoint `{}` has a column {column:?}, which the model does not have; its kept columns \
         are {known}",
        path.display()
    )]
    Column {
        /// The file.
        path: PathBuf,
        /// Name of the column.
        column: String,
        /// Names of the model's kept columns.
        known: String,
    },
    /// The checkpoint's division of space does not fit the model's domain.
    #[error("checkpoint `{}`: {fault}", path.display())]
    Domain {
        /// The file.
        path: PathBuf,
        /// Why not.
        fault: Fault,
    },
}

impl<D: Domain> Simulation<D> {
    /// Where the simulation is, besides its columns.
    pub fn position(&self) -> Position {
        Position {
            clock: self.clock,
            pace_left: self.pace_left,
            begun: self.begun,
            end_time: self.end_time,
            points: self.columns().points() as u64,
            step: self.model.plan.step.outline(),
            instruction_sets: self.instruction_sets.clone(),
            domain: self.domain().save(),
        }
    }

    /// Writes the checkpoint `path`, whose folder must exist: all that this simulation, or another
    /// one of the same model under any schedule, needs to go on with the same bits.
    /// `scene_hash` says what is modelled and is asked for by [`Simulation::restore`].
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>, scene_hash: u64) -> Result<(), CheckpointError> {
        let columns = self.columns();
        let header = Header { method: self.model.method.clone(), scene_hash };
        let blocks = self.kept().map(|(name, id, _)| (column_block(name), columns.any_values(id)));
        let saved = Saved { position: self.position(), passenger: Vec::new() };
        saved.write(path.as_ref(), &header, blocks)
    }

    /// Goes on from the checkpoint `path`, which must be of the same method, scene and columns.
    ///
    /// # Errors
    /// If it is not, or is damaged. The simulation is as before, unless it is the domain that
    /// refuses the checkpoint's division of space.
    pub fn restore(&mut self, path: impl AsRef<Path>, scene_hash: u64) -> Result<(), RestoreError> {
        let path = path.as_ref();
        let mut reader = CheckpointReader::open(path)?;
        reader.require(&self.model.method, scene_hash)?;
        let saved = Saved::read(path, &reader)?;
        self.restore_from(path, &mut reader, saved.position)
    }

    /// Takes `position` and the columns of a checkpoint that was found to be of this scene.
    pub(crate) fn restore_from(
        &mut self,
        path: &Path,
        reader: &mut CheckpointReader,
        position: Position,
    ) -> Result<(), RestoreError> {
        let path = || path.to_path_buf();
        let points = self.columns().points();
        if position.points != points as u64 {
            return Err(RestoreError::Points {
                path: path(),
                expected: points,
                found: position.points,
            });
        }
        let kept: Vec<_> =
            self.kept().map(|(name, id, kind)| (name.to_owned(), id, kind)).collect();
        self.require_columns(&path(), reader, &kept)?;
        let step = self.model.plan.step.outline();
        if position.step != step {
            return Err(RestoreError::Step { path: path(), expected: step, found: position.step });
        }
        for (name, id, kind) in &kept {
            let bytes = self.model.columns.bytes_mut(*id);
            let name = column_block(name);
            match kind {
                ElementKind::F32 => reader.read_into::<f32>(&name, bytemuck::cast_slice_mut(bytes)),
                ElementKind::F64 => reader.read_into::<f64>(&name, bytemuck::cast_slice_mut(bytes)),
                ElementKind::U32 => reader.read_into::<u32>(&name, bytemuck::cast_slice_mut(bytes)),
                ElementKind::U64 => reader.read_into::<u64>(&name, bytemuck::cast_slice_mut(bytes)),
                ElementKind::U8 => reader.read_into::<u8>(&name, bytes),
            }?;
        }
        let model = &mut self.model;
        model
            .domain
            .restore(&position.domain, &model.columns)
            .map_err(|fault| RestoreError::Domain { path: path(), fault })?;
        self.clock = position.clock;
        self.pace_left = position.pace_left;
        self.begun = position.begun;
        self.derived = false;
        self.end_time = position.end_time;
        self.instruction_sets = position.instruction_sets;
        let now = crate::lanes::instruction_set();
        if self.instruction_sets.iter().all(|known| known != now) {
            self.instruction_sets.push(now.to_owned());
        }
        Ok(())
    }

    /// The columns that live from step to step.
    pub(crate) fn kept(&self) -> impl Iterator<Item = (&str, ColumnId, ElementKind)> {
        let columns = self.columns().iter().filter(|(_, column)| column.is_kept());
        columns.map(|(id, column)| (column.name(), id, column.kind()))
    }

    /// Makes sure, before anything is overwritten, that the checkpoint has the columns `kept`,
    /// and no others.
    fn require_columns(
        &self,
        path: &Path,
        reader: &CheckpointReader,
        kept: &[(String, ColumnId, ElementKind)],
    ) -> Result<(), RestoreError> {
        for (name, id, kind) in kept {
            let block = column_block(name);
            let Some(info) = reader.blocks().find(|info| info.name == block) else {
                return Err(
                    CheckpointError::MissingBlock { path: path.to_path_buf(), block }.into()
                );
            };
            let (expected, found): (format::Kind, _) = (kind.file_kind(), info.kind);
            if found != expected {
                let path = path.to_path_buf();
                return Err(CheckpointError::WrongKind { path, block, expected, found }.into());
            }
            let (expected, found) = (self.columns().bytes(*id).len() / kind.size(), info.count);
            if found != expected as u64 {
                let path = path.to_path_buf();
                return Err(CheckpointError::WrongCount { path, block, expected, found }.into());
            }
        }
        let foreign = reader.blocks().find_map(|info| {
            let column = info.name.strip_prefix(&column_block(""))?;
            kept.iter().all(|(name, ..)| name != column).then(|| column.to_owned())
        });
        match foreign {
            None => Ok(()),
            Some(column) => {
                let names: Vec<_> = kept.iter().map(|(name, ..)| name.as_str()).collect();
                Err(RestoreError::Column {
                    path: path.to_path_buf(),
                    column,
                    known: names.join(", "),
                })
            }
        }
    }
}
