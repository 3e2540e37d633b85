//! The scene catalogue: what is modelled, once, for every method.
//!
//! A scene's physics (geometry, fluid, forcing, reference) is in a file of its own; how a method
//! takes part is in a folder of the method's.

pub mod advection;
pub mod burgers;
pub mod cavity;
pub mod channel;
pub mod channel_cylinder;
pub mod cubic;
pub mod cylinder;
pub mod dam_break;
pub mod double_shear_layer;
pub mod drop;
pub mod error;
pub mod fd;
pub mod heat;
pub mod hydrostatic_tank;
pub mod lbm;
pub mod noh;
pub mod parameter;
pub mod peak;
pub mod report;
pub mod riemann;
pub mod rotating_patch;
pub mod shear_wave;
pub mod sod;
pub mod sph;
pub mod sphere_array;
pub mod standing_wave;
pub mod tank;
pub mod taylor_green;
pub mod toro;
pub mod wave;
pub mod womersley;
pub mod zalesak;

use std::path::PathBuf;
use std::time::Duration;

use finegrain_framework::run::{Dump, Every, Progress, Run, Until};
use finegrain_framework::{Domain, Model, Schedule, Settings, Simulation, Viewable};

pub use error::SceneError;
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
    /// Number of workers; if `None`, see [`Prepared::workers`].
    pub workers: Option<usize>,
    /// End after so many steps.
    pub steps: Option<u64>,
    /// End at this time, s.
    pub until: Option<f64>,
    /// End after so much wall-clock time.
    pub wall_clock: Option<Duration>,
    /// Folder for files; none are written without.
    pub out: Option<PathBuf>,
    /// Dump fields every so many steps; ten times on the way to the end time of the scene by default.
    pub dump_every: Option<u64>,
    /// Write a checkpoint every so many steps, besides the one at the end.
    pub checkpoint_every: Option<u64>,
    /// Write which worker ran which sub-domain's which stage when to this file.
    pub trace: Option<PathBuf>,
    /// Go on from this checkpoint.
    pub restart: Option<PathBuf>,
    /// Where progress goes.
    pub progress: Option<Port<Progress>>,
    /// Where a request to stop comes from.
    pub stops: Option<Inbox<()>>,
    /// Where requests for a checkpoint come from; without a folder nobody asks there.
    pub checkpoint_requests: Option<Inbox<()>>,
}

/// The last parts of each worker that a trace shows.
const TRACED: usize = 200_000;

impl Orders {
    /// A simulation of `model` for these orders.
    fn simulation<D: Domain>(
        &self,
        model: Model<D>,
        workers: usize,
    ) -> Result<Simulation<D>, SceneError> {
        let trace = if self.trace.is_some() { TRACED } else { 0 };
        let settings = Settings { schedule: self.schedule, workers, trace, ..Settings::default() };
        Simulation::new(model, settings).map_err(|cause| SceneError::Workers { workers, cause })
    }

    /// Adds to a run when it ends, what it writes and where it begins; `end_time` is when the scene
    /// ends by itself, s, and `dump` shows its fields.
    fn plan<D: Viewable>(
        self,
        run: Run<D>,
        end_time: f64,
        dump: impl FnOnce(Every) -> Dump,
    ) -> Run<D> {
        let time = self.until.or(self.steps.is_none().then_some(end_time));
        let mut run = run.until(Until { steps: self.steps, time, wall_clock: self.wall_clock });
        if let Some(out) = self.out {
            let every = self.dump_every.map_or(Every::Time(0.1 * end_time), Every::Steps);
            let dump = dump(every).and_last();
            // One at the end in any case, so that every run can be taken up again.
            let every = Every::Steps(self.checkpoint_every.unwrap_or(u64::MAX));
            run = run.out(out).dump(dump).checkpoint(every, 3);
            if let Some(requests) = self.checkpoint_requests {
                run = run.checkpoint_on(requests);
            }
        }
        if let Some(restart) = self.restart {
            run = run.restart_from(restart);
        }
        if let Some(progress) = self.progress {
            run = run.progress(progress, Duration::from_millis(200));
        }
        if let Some(stops) = self.stops {
            run = run.stop_on(stops);
        }
        run
    }
}

/// A scene that is ready to run with one method.
pub trait Prepared {
    /// Number of points.
    fn points(&self) -> usize;

    /// Fewest points that are worth a worker: with fewer, what workers wait for each other in every step takes longer
    /// than what they save.
    fn points_per_worker(&self) -> usize;

    /// Number of workers that it runs with: what is ordered, or all cores, as far as there are points enough; one
    /// without a schedule for more.
    fn workers(&self, orders: &Orders) -> usize {
        if orders.schedule == Schedule::Serial {
            return 1;
        }
        let worth = (self.points() / self.points_per_worker()).max(1);
        orders.workers.unwrap_or_else(|| worth.min(Settings::default().workers))
    }

    /// Runs it to the end.
    ///
    /// # Errors
    /// If the run fails.
    fn run(self: Box<Self>, orders: Orders) -> Result<Report, SceneError>;
}

/// How a scene is made ready.
type Prepare = fn(&Parameters, Precision) -> Result<Box<dyn Prepared>, SceneError>;

/// How a method takes part in a scene.
pub struct Method {
    /// Its name.
    pub name: &'static str,
    /// The scene's parameters, and its own.
    pub parameters: fn() -> Vec<Parameter>,
    prepare: Prepare,
}

impl Method {
    const fn sph(parameters: fn() -> Vec<Parameter>, prepare: Prepare) -> Self {
        Self { name: "sph", parameters, prepare }
    }

    const fn lbm(parameters: fn() -> Vec<Parameter>, prepare: Prepare) -> Self {
        Self { name: "lbm", parameters, prepare }
    }

    const fn fd(parameters: fn() -> Vec<Parameter>, prepare: Prepare) -> Self {
        Self { name: "fd", parameters, prepare }
    }
}

/// An entry of the catalogue.
pub struct Scene {
    /// Its name.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
    /// The methods that can run it, the default first.
    pub methods: &'static [Method],
}

/// All scenes.
pub const SCENES: &[Scene] = &[
    Scene {
        name: "cylinder",
        summary: "creeping flow through a square array of cylinders (Morris et al. 1997; 3-D as Holmes et al. 2011)",
        methods: &[
            Method::sph(sph::cylinder::parameters, sph::cylinder::prepare),
            Method::lbm(lbm::cylinder::parameters, lbm::cylinder::prepare),
            Method::fd(fd::cylinder::parameters, fd::cylinder::prepare),
        ],
    },
    Scene {
        name: "taylor-green",
        summary: "vortices decaying in a periodic box (Taylor & Green 1937)",
        methods: &[
            Method::sph(sph::taylor_green::parameters, sph::taylor_green::prepare),
            Method::lbm(lbm::taylor_green::parameters, lbm::taylor_green::prepare),
            Method::fd(fd::taylor_green::parameters, fd::taylor_green::prepare),
        ],
    },
    Scene {
        name: "elliptic-drop",
        summary: "a round drop drawn out by its own motion (Monaghan 1994)",
        methods: &[Method::sph(sph::drop::elliptic_parameters, sph::drop::prepare_elliptic)],
    },
    Scene {
        name: "oscillating-drop",
        summary: "a drop that swings in a central force (Monaghan & Rafiee 2013)",
        methods: &[Method::sph(sph::drop::oscillating_parameters, sph::drop::prepare_oscillating)],
    },
    Scene {
        name: "rotating-patch",
        summary: "a rotating square of fluid, under tension throughout (Colagrossi 2005)",
        methods: &[Method::sph(sph::rotating_patch::parameters, sph::rotating_patch::prepare)],
    },
    Scene {
        name: "dam-break",
        summary: "collapse of a column of water in a tank (Martin & Moyce 1952)",
        methods: &[Method::sph(sph::dam_break::parameters, sph::dam_break::prepare)],
    },
    Scene {
        name: "hydrostatic-tank",
        summary: "water at rest in a tank with a free surface",
        methods: &[Method::sph(sph::hydrostatic_tank::parameters, sph::hydrostatic_tank::prepare)],
    },
    Scene {
        name: "standing-wave",
        summary: "a standing gravity wave in a closed tank (Antuono et al. 2011)",
        methods: &[Method::sph(sph::standing_wave::parameters, sph::standing_wave::prepare)],
    },
    Scene {
        name: "sod",
        summary: "shock tube of an ideal gas (Sod 1978), 1-D or 2-D",
        methods: &[
            Method::sph(sph::sod::parameters, sph::sod::prepare),
            Method::fd(fd::sod::parameters, fd::sod::prepare),
        ],
    },
    Scene {
        name: "noh",
        summary: "implosion of a cold gas with an infinitely strong shock (Noh 1987), 1-D or 2-D",
        methods: &[Method::sph(sph::noh::parameters, sph::noh::prepare)],
    },
    Scene {
        name: "couette",
        summary: "flow between two plates of which one starts to move (Morris et al. 1997)",
        methods: &[
            Method::sph(sph::channel::parameters, sph::channel::prepare_couette),
            Method::lbm(lbm::channel::parameters, lbm::channel::prepare_couette),
            Method::fd(fd::channel::parameters, fd::channel::prepare_couette),
        ],
    },
    Scene {
        name: "poiseuille",
        summary: "flow between two plates that a body force starts (Morris et al. 1997)",
        methods: &[
            Method::sph(sph::channel::parameters, sph::channel::prepare_poiseuille),
            Method::lbm(lbm::channel::parameters, lbm::channel::prepare_poiseuille),
            Method::fd(fd::channel::parameters, fd::channel::prepare_poiseuille),
        ],
    },
    Scene {
        name: "cavity",
        summary: "eddies under a moving lid (Ghia et al. 1982, Botella & Peyret 1998)",
        methods: &[
            Method::sph(sph::cavity::parameters, sph::cavity::prepare),
            Method::lbm(lbm::cavity::parameters, lbm::cavity::prepare),
            Method::fd(fd::cavity::parameters, fd::cavity::prepare),
        ],
    },
    Scene {
        name: "channel-cylinder",
        summary: "flow past a cylinder in a channel with an inlet and an outlet (Schaefer & Turek 1996)",
        methods: &[
            Method::lbm(lbm::channel_cylinder::parameters, lbm::channel_cylinder::prepare),
            Method::sph(sph::channel_cylinder::parameters, sph::channel_cylinder::prepare),
            Method::fd(fd::channel_cylinder::parameters, fd::channel_cylinder::prepare),
        ],
    },
    Scene {
        name: "double-shear-layer",
        summary: "layers of shear that roll up in a periodic box (Minion & Brown 1997)",
        methods: &[
            Method::lbm(lbm::double_shear_layer::parameters, lbm::double_shear_layer::prepare),
            Method::fd(fd::double_shear_layer::parameters, fd::double_shear_layer::prepare),
        ],
    },
    Scene {
        name: "sphere-array",
        summary: "creeping flow through a cubic array of spheres (Zick & Homsy 1982)",
        methods: &[Method::lbm(lbm::sphere_array::parameters, lbm::sphere_array::prepare)],
    },
    Scene {
        name: "womersley",
        summary: "flow between two plates that a body force moves to and fro (Womersley 1955)",
        methods: &[Method::lbm(lbm::womersley::parameters, lbm::womersley::prepare)],
    },
    Scene {
        name: "shear-wave",
        summary: "a wave of shear that viscosity lets decay in a periodic box",
        methods: &[Method::lbm(lbm::shear_wave::parameters, lbm::shear_wave::prepare)],
    },
    Scene {
        name: "toro",
        summary: "Riemann problems that are hard on a method (Toro 1999)",
        methods: &[Method::fd(fd::toro::parameters, fd::toro::prepare)],
    },
    Scene {
        name: "heat",
        summary: "a wave of temperature that levels out in a box, 1-D to 3-D",
        methods: &[Method::fd(fd::heat::parameters, fd::heat::prepare)],
    },
    Scene {
        name: "wave",
        summary: "a standing wave in a box, 1-D to 3-D",
        methods: &[Method::fd(fd::wave::parameters, fd::wave::prepare)],
    },
    Scene {
        name: "advection",
        summary: "a shape that is carried through a periodic box, 1-D or 2-D",
        methods: &[Method::fd(fd::advection::parameters, fd::advection::prepare)],
    },
    Scene {
        name: "zalesak",
        summary: "a slotted disk that is carried around (Zalesak 1979)",
        methods: &[Method::fd(fd::zalesak::parameters, fd::zalesak::prepare)],
    },
    Scene {
        name: "burgers",
        summary: "a wave that steepens until viscosity holds it (Basdevant et al. 1986)",
        methods: &[Method::fd(fd::burgers::parameters, fd::burgers::prepare)],
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

    /// A method that can run it, the default one if `None`.
    ///
    /// # Errors
    /// If the scene does not have the method; the message lists those that it has.
    pub fn method(&self, name: Option<&str>) -> Result<&'static Method, SceneError> {
        let Some(name) = name else { return Ok(&self.methods[0]) };
        self.methods.iter().find(|method| method.name == name).ok_or_else(|| {
            let known: Vec<_> = self.methods.iter().map(|method| method.name).collect();
            SceneError::Method {
                scene: self.name,
                method: name.to_owned(),
                known: known.join(", "),
            }
        })
    }

    /// Sets parameters of the default method.
    ///
    /// # Errors
    /// If one is unknown or not valid.
    pub fn set<'a>(
        &self,
        settings: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<Parameters, SceneError> {
        self.set_for(None, settings)
    }

    /// Sets parameters of a method, the default one if `None`.
    ///
    /// # Errors
    /// If the scene does not have the method, or a parameter is unknown or not valid.
    pub fn set_for<'a>(
        &self,
        method: Option<&str>,
        settings: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<Parameters, SceneError> {
        let method = self.method(method)?;
        Parameters::new(&(method.parameters)(), settings).map_err(|mut error| {
            if let ParameterError::Unknown { name, elsewhere, .. } = &mut error {
                *elsewhere = self.methods_with(name);
            }
            self.with(method, error.into())
        })
    }

    /// The methods for which the scene has this parameter, in brackets; nothing if for none.
    fn methods_with(&self, name: &str) -> String {
        let has = |method: &&Method| (method.parameters)().iter().any(|p| p.name == name);
        let names: Vec<_> = self.methods.iter().filter(has).map(|method| method.name).collect();
        if names.is_empty() {
            return String::new();
        }
        format!(" (there is one with {})", names.join(" and "))
    }

    fn with(&self, method: &Method, cause: SceneError) -> SceneError {
        SceneError::With { scene: self.name, method: method.name, cause: Box::new(cause) }
    }

    /// Prepares it for a method, the default one if `None`.
    ///
    /// # Errors
    /// If the scene does not have the method, the parameters were set for another one, or the method
    /// refuses them.
    pub fn prepare(
        &self,
        method: Option<&str>,
        parameters: &Parameters,
        precision: Precision,
    ) -> Result<Box<dyn Prepared>, SceneError> {
        let method = self.method(method)?;
        let mut declared: Vec<_> = (method.parameters)().iter().map(|p| p.name).collect();
        declared.sort_unstable();
        let is_its = parameters.iter().map(|(name, _)| name).eq(declared);
        let prepared = match is_its {
            true => (method.prepare)(parameters, precision),
            false => Err(SceneError::Parameters),
        };
        prepared.map_err(|cause| self.with(method, cause))
    }
}

/// Title of a picture of the state at a time, s.
fn at_time(title: String, time: f64) -> String {
    if time == 0.0 || time.abs() >= 0.1 {
        format!("{title}, t = {time:.3} s")
    } else {
        format!("{title}, t = {time:.2e} s")
    }
}

/// Everything that decides the bits, a line each, for checkpoints; other versions of this program may
/// compute the same things in another order.
fn description(scene: &str, method: &str, parameters: &Parameters, precision: Precision) -> String {
    let (version, precision) = (env!("CARGO_PKG_VERSION"), precision.name());
    let mut text = format!(
        "finegrain = {version}\nscene = {scene}\nmethod = {method}\nprecision = {precision}\n"
    );
    for (name, value) in parameters.iter() {
        text += &format!("{name} = {value}\n");
    }
    text
}
