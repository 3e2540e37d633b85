//! The scene catalogue: what is modelled, once, for every method.
//!
//! A scene's physics (geometry, fluid, forcing, reference) is in a file of its own; how a method
//! takes part is in a folder of the method's.

pub mod cavity;
pub mod channel;
pub mod cylinder;
pub mod dam_break;
pub mod drop;
pub mod hydrostatic_tank;
pub mod noh;
pub mod parameter;
pub mod report;
pub mod riemann;
pub mod rotating_patch;
pub mod sod;
pub mod sph;
pub mod standing_wave;
pub mod tank;
pub mod taylor_green;

use std::path::PathBuf;
use std::time::Duration;

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
    /// Positions in 64 bits, all else in 32.
    Mixed,
    /// 64-bit floats.
    #[default]
    F64,
}

impl Precision {
    /// Its name on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::Mixed => "mixed",
            Self::F64 => "f64",
        }
    }
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
    /// End after so much wall-clock time.
    pub wall_clock: Option<Duration>,
    /// Folder for files; none are written without.
    pub out: Option<PathBuf>,
    /// Dump fields every so many steps; ten times by default.
    pub dump_every: Option<u64>,
    /// Write a checkpoint every so many steps, besides the one at the end.
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
pub const SCENES: &[Scene] = &[
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
        name: "elliptic-drop",
        summary: "a round drop drawn out by its own motion (Monaghan 1994)",
        methods: &["sph"],
        parameters: sph::drop::elliptic_parameters,
        prepare: sph::drop::prepare_elliptic,
    },
    Scene {
        name: "oscillating-drop",
        summary: "a drop that swings in a central force (Monaghan & Rafiee 2013)",
        methods: &["sph"],
        parameters: sph::drop::oscillating_parameters,
        prepare: sph::drop::prepare_oscillating,
    },
    Scene {
        name: "rotating-patch",
        summary: "a rotating square of fluid, under tension throughout (Colagrossi 2005)",
        methods: &["sph"],
        parameters: sph::rotating_patch::parameters,
        prepare: sph::rotating_patch::prepare,
    },
    Scene {
        name: "dam-break",
        summary: "collapse of a column of water in a tank (Martin & Moyce 1952)",
        methods: &["sph"],
        parameters: sph::dam_break::parameters,
        prepare: sph::dam_break::prepare,
    },
    Scene {
        name: "hydrostatic-tank",
        summary: "water at rest in a tank with a free surface",
        methods: &["sph"],
        parameters: sph::hydrostatic_tank::parameters,
        prepare: sph::hydrostatic_tank::prepare,
    },
    Scene {
        name: "standing-wave",
        summary: "a standing gravity wave in a closed tank (Antuono et al. 2011)",
        methods: &["sph"],
        parameters: sph::standing_wave::parameters,
        prepare: sph::standing_wave::prepare,
    },
    Scene {
        name: "sod",
        summary: "shock tube of an ideal gas (Sod 1978), 1-D or 2-D",
        methods: &["sph"],
        parameters: sph::sod::parameters,
        prepare: sph::sod::prepare,
    },
    Scene {
        name: "noh",
        summary: "implosion of a cold gas with an infinitely strong shock (Noh 1987), 1-D or 2-D",
        methods: &["sph"],
        parameters: sph::noh::parameters,
        prepare: sph::noh::prepare,
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
        static ALL: &[Scene] = SCENES;
        ALL.iter().find(|s| s.name == name).ok_or_else(|| {
            let known: Vec<_> = ALL.iter().map(|s| s.name).collect();
            let near = parameter::nearest(name, &known);
            SceneError::Unknown { name: name.to_owned(), near, known: known.join(", ") }
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
