//! What can be wrong with a scene.

use std::path::PathBuf;

use finegrain_framework::run::RunFailed;

use super::Precision;
use super::parameter::{self, ParameterError};

/// Why a scene could not be prepared or run.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// There is no such scene.
    #[error("no scene {name:?}{}; there are {known}", parameter::did_you_mean(near))]
    Unknown {
        /// What was asked for.
        name: String,
        /// The known name that is nearest, if one is near.
        near: Option<String>,
        /// What there is.
        known: String,
    },
    /// The scene cannot be run by that method.
    #[error("scene {scene:?} has no method {method:?}; it has {known}")]
    Method {
        /// The scene.
        scene: &'static str,
        /// What was asked for.
        method: String,
        /// What there is.
        known: String,
    },
    /// The scene and method in which something else is wrong.
    #[error("scene {scene:?}, --method {method}: {cause}")]
    With {
        /// The scene.
        scene: &'static str,
        /// The method.
        method: &'static str,
        /// What is wrong.
        #[source]
        cause: Box<SceneError>,
    },
    /// The method does not compute with such numbers.
    #[error("there is no precision {}; there are {known}", precision.name())]
    Precision {
        /// What was asked for.
        precision: Precision,
        /// What there is.
        known: &'static str,
    },
    /// The parameters were set for another method or scene.
    #[error("these are not its parameters")]
    Parameters,
    /// A parameter cannot be set.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The method refused the model.
    #[error(transparent)]
    Sph(#[from] finegrain_sph::SphError),
    /// The method refused the model.
    #[error(transparent)]
    Lbm(#[from] finegrain_lbm::LbmError),
    /// The method refused the model.
    #[error(transparent)]
    Fd(#[from] finegrain_fd::FdError),
    /// The particles cannot be placed.
    #[error(transparent)]
    Packing(#[from] finegrain_sph::packing::PackingError),
    /// The system refused threads.
    #[error("cannot start {workers} workers: {cause}")]
    Workers {
        /// How many.
        workers: usize,
        /// Why.
        cause: std::io::Error,
    },
    /// A trace does not show what a step costs.
    #[error("steps: {steps} are too few to tell what a step costs; give more")]
    TooShort {
        /// Steps of the run.
        steps: u64,
    },
    /// The trace cannot be written.
    #[error("cannot write trace `{}`: {cause}", path.display())]
    Trace {
        /// Its file.
        path: PathBuf,
        /// Why.
        cause: std::io::Error,
    },
    /// The run failed.
    #[error(transparent)]
    Run(#[from] RunFailed),
}
