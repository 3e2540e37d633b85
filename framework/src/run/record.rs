//! What a run remembers of its outputs from one run or restart to the next.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::checkpoint::CheckpointError;
use crate::format::Pvd;

/// Outputs so far, as a checkpoint holds them; the rows of histories are in blocks of their own.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    /// What is modelled, in words.
    pub scene: String,
    /// Names of the series, and their files.
    pub series: Vec<(String, Pvd)>,
    /// Names of the monitors, and their columns.
    pub monitors: Vec<(String, Vec<String>)>,
    /// Steps of the checkpoints that are kept, ascending.
    pub checkpoints: Vec<u64>,
}

impl Record {
    /// As the passenger of the checkpoint `path`.
    pub fn to_bytes(&self, path: &Path) -> Result<Vec<u8>, CheckpointError> {
        postcard::to_stdvec(self).map_err(|source| metadata_error(path, source))
    }

    /// From the passenger of the checkpoint `path`: nothing, if it was written without a run.
    pub fn from_bytes(bytes: &[u8], path: &Path) -> Result<Self, CheckpointError> {
        if bytes.is_empty() {
            return Ok(Self::default());
        }
        postcard::from_bytes(bytes).map_err(|source| metadata_error(path, source))
    }

    /// The lines in which the scene differs from the present `scene`.
    pub fn differences(&self, scene: &str) -> String {
        let only = |a: &str, b: &str, where_: &str| -> Vec<String> {
            let missing = a.lines().filter(|line| b.lines().all(|other| other != *line));
            missing.map(|line| format!("{line} {where_}")).collect()
        };
        let saved = only(&self.scene, scene, "in the checkpoint");
        [saved, only(scene, &self.scene, "here")].concat().join(", ")
    }

    /// The files of series `name`; none if there is no such series.
    pub fn series(&self, name: &str) -> Pvd {
        let found = self.series.iter().find(|(known, _)| known == name);
        found.map_or_else(Pvd::new, |(_, series)| series.clone())
    }
}

fn metadata_error(path: &Path, source: postcard::Error) -> CheckpointError {
    CheckpointError::Metadata { path: path.to_path_buf(), source }
}

/// Names of the blocks that hold the steps, times and values of a history.
pub(super) fn history_blocks(monitor: &str) -> [String; 3] {
    ["steps", "times", "values"].map(|part| format!("monitor {monitor} {part}"))
}

/// Name of the file of a checkpoint.
pub(super) fn checkpoint_file(step: u64) -> String {
    format!("checkpoint-{step:09}.ckpt")
}
