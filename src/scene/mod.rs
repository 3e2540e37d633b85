//! The scene catalogue: what is modelled, once, for every method.
//!
//! A scene's physics (geometry, fluid, forcing, reference) is in a file of its own; how a method
//! takes part is in a folder of the method's.

pub mod cavity;
pub mod channel;
pub mod cylinder;
pub mod parameter;
pub mod report;
pub mod sph;
pub mod taylor_green;

use std::path::PathBuf;

use finegrain_framework::run::{Progress, RunFailed};
use finegrain_framework::{Schedule, Settings};

use finegrain_framework::port::{Inbox, Port};
pub use parameter::{Kind, Parameter, ParameterError, Parameters, Value};
pub use report::Report;

/// Scalar type of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// 32-bit floats.
    F32,
    /// 64-bit floats.
    #[default]
    F64,
}

/// How a scene is to be run; none of it changes what is modelled.
#[derive(Default)]
pub struct Orders {
    /// How workers meet.
    pub schedule: Schedule,
    /// Number of workers; all cores if `None`.
    pub workers: Option<usize>,
    /// End after so many steps.
    pub steps: Option<u64>,
    /// End at this time, s.
    pub until: Option<f64>,
    /// Folder for files; none are written without.
    pub out: Option<PathBuf>,
    /// Write a checkpoint every so many steps.
    pub checkpoint_every: Option<u64>,
    /// Go on from this checkpoint.
    pub restart: Option<PathBuf>,
    /// Where progress goes.
    pub progress: Option<Port<Progress>>,
    /// Where a request to stop comes from.
    pub stops: Option<Inbox<()>>,
}

impl Orders {
    /// Settings of a simulation for these orders.
    pub fn settings(&self) -> Settings {
        let settings = Settings { schedule: self.schedule, ..Settings::default() };
        Settings { workers: self.workers.unwrap_or(settings.workers), ..settings }
    }
}

/// Why a scene could not be prepared or run.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// There is no such scene.
    #[error("no scene {name:?}; there are {known}")]
    Unknown {
        /// What was asked for.
        name: String,
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
    /// A parameter cannot be set.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// The method refused the model.
    #[error(transparent)]
    Sph(#[from] finegrain_sph::SphError),
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
    /// The run failed.
    #[error(transparent)]
    Run(#[from] RunFailed),
}

/// A scene that is ready to run with one method.
pub trait Prepared {
    /// Number of points.
    fn points(&self) -> usize;

    /// Runs it to the end.
    ///
    /// # Errors
    /// If the run fails.
    fn run(self: Box<Self>, orders: Orders) -> Result<Report, SceneError>;
}

/// How a scene is made ready.
type Prepare = fn(&Parameters, Precision) -> Result<Box<dyn Prepared>, SceneError>;

/// An entry of the catalogue.
pub struct Scene {
    /// Its name.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
    /// The methods that can run it, the default first.
    pub methods: &'static [&'static str],
    /// Its parameters, and those of its methods.
    pub parameters: fn() -> Vec<Parameter>,
    prepare: Prepare,
}

/// All scenes.
pub const SCENES: [Scene; 5] = [
    Scene {
        name: "cylinder",
        summary: "creeping flow through a square array of cylinders (Morris et al. 1997; 3-D as Holmes et al. 2011)",
        methods: &["sph"],
        parameters: sph::cylinder::parameters,
        prepare: sph::cylinder::prepare,
    },
    Scene {
        name: "taylor-green",
        summary: "vortices decaying in a periodic box (Taylor & Green 1937)",
        methods: &["sph"],
        parameters: sph::taylor_green::parameters,
        prepare: sph::taylor_green::prepare,
    },
    Scene {
        name: "couette",
        summary: "flow between two plates of which one starts to move (Morris et al. 1997)",
        methods: &["sph"],
        parameters: sph::channel::parameters,
        prepare: sph::channel::prepare_couette,
    },
    Scene {
        name: "poiseuille",
        summary: "flow between two plates that a body force starts (Morris et al. 1997)",
        methods: &["sph"],
        parameters: sph::channel::parameters,
        prepare: sph::channel::prepare_poiseuille,
    },
    Scene {
        name: "cavity",
        summary: "eddies under a moving lid (Ghia et al. 1982, Botella & Peyret 1998)",
        methods: &["sph"],
        parameters: sph::cavity::parameters,
        prepare: sph::cavity::prepare,
    },
];

impl Scene {
    /// The scene with this name.
    ///
    /// # Errors
    /// If there is none; the message lists them.
    pub fn find(name: &str) -> Result<&'static Self, SceneError> {
        static ALL: &[Scene] = &SCENES;
        ALL.iter().find(|s| s.name == name).ok_or_else(|| {
            let known: Vec<_> = ALL.iter().map(|s| s.name).collect();
            SceneError::Unknown { name: name.to_owned(), known: known.join(", ") }
        })
    }

    /// Sets parameters.
    ///
    /// # Errors
    /// If one is unknown or not valid.
    pub fn set<'a>(
        &self,
        settings: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<Parameters, ParameterError> {
        Parameters::new(self.name, &(self.parameters)(), settings)
    }

    /// Prepares it for a method, the default one if `None`.
    ///
    /// # Errors
    /// If the scene does not have the method, or the method refuses the parameters.
    pub fn prepare(
        &self,
        method: Option<&str>,
        parameters: &Parameters,
        precision: Precision,
    ) -> Result<Box<dyn Prepared>, SceneError> {
        let method = method.unwrap_or(self.methods[0]);
        if !self.methods.contains(&method) {
            return Err(SceneError::Method {
                scene: self.name,
                method: method.to_owned(),
                known: self.methods.join(", "),
            });
        }
        (self.prepare)(parameters, precision)
    }
}
