//! How finite differences take part in the scenes.
//!
//! Time steps are a fraction, `courant`, of the longest that is stable; more than that is an error.

/// Defines `prepare`, which makes a scene ready by a function `build::<T>(parameters, precision)`, in
/// the scalar type asked for; `prepare_with!(NAME: build, FIRST)` a function of that name, by
/// `build::<T>(FIRST, parameters, precision)`.
macro_rules! prepare_with {
    ($build:ident) => {
        prepare_with!(prepare: $build);
    };
    ($prepare:ident: $build:ident $(, $first:expr)?) => {
        /// Prepares the scene.
        pub fn $prepare(
            parameters: &$crate::scene::Parameters,
            precision: $crate::scene::Precision,
        ) -> Result<Box<dyn $crate::scene::Prepared>, $crate::scene::SceneError> {
            use $crate::scene::Precision;
            Ok(match precision {
                Precision::F32 => Box::new($build::<f32>($($first,)? parameters, precision)?),
                Precision::F64 => Box::new($build::<f64>($($first,)? parameters, precision)?),
                Precision::Mixed => return Err($crate::scene::fd::refused(precision)),
            })
        }
    };
}

pub mod advection;
pub mod burgers;
pub mod cavity;
pub mod channel;
pub mod channel_cylinder;
pub mod cylinder;
pub mod double_shear_layer;
pub mod heat;
pub mod sod;
pub mod taylor_green;
pub mod toro;
pub mod wave;
pub mod zalesak;

mod gas;
mod incompressible;

use finegrain_fd::{Boundary, Compiled, Condition, Face, Fd, Mesh, Order, Parts, Side};
use finegrain_framework::run::{Dump, Run, Summary};
use finegrain_framework::space::Grid;
use finegrain_framework::{Integrator, Simulation};

use super::heat::BoxEnds;
use super::parameter::{Kind, Parameter, Parameters};
use super::report::Picture;
use super::{Orders, Precision, Prepared, Report, SceneError, at_time};
use crate::figure::{Axis, Chart, Field};

/// The error for numbers that the method does not compute with.
fn refused(precision: Precision) -> SceneError {
    SceneError::Precision { precision, known: "f32 and f64" }
}

/// Of the Laplacian.
const ORDER: Parameter = Parameter {
    name: "order",
    kind: Kind::Choice { default: "4", names: &["2", "4", "6", "8"] },
    unit: "",
    help: "of the Laplacian; 8 in periodic boxes only",
    only_with: None,
};

/// Of equations of first order in time.
const INTEGRATOR: Parameter =
    Parameter::choice("integrator", &["rk4", "ssp-rk3", "rk2", "euler"], "how time is stepped");

/// Of derivatives that go with the flow.
const FACE: Parameter = Parameter::choice(
    "face",
    &["weno5-z", "weno5", "upwind3", "upwind1"],
    "values on faces: Borges et al. (2008), Jiang & Shu (1996), or upwind of third or first order",
);

const COURANT: Parameter =
    Parameter::number("courant", 0.8, [1e-4, 1.0], "", "time step over the longest that is stable");

fn order(parameters: &Parameters) -> Order {
    let number = parameters.choice("order").parse().ok();
    number.and_then(Order::of).unwrap_or(Order::Fourth)
}

fn integrator(parameters: &Parameters) -> Integrator {
    parameters.choice("integrator").parse().unwrap_or(Integrator::Rk4)
}

fn face(parameters: &Parameters) -> Face {
    let name = parameters.choice("face");
    Face::ALL.into_iter().find(|face| face.name() == name).unwrap_or(Face::Weno5Z)
}

/// A time step that is no longer than `longest` and of which whole ones make `time`.
fn dividing(time: f64, longest: f64) -> f64 {
    time / (time / longest * (1.0 - 1e-12)).ceil()
}

/// A mesh of a box of side 1 in as many directions, and what holds at its ends.
fn unit_box(dims: usize, resolution: usize, ends: BoxEnds) -> (Mesh, Boundary) {
    let (side, condition) = match ends {
        BoxEnds::Periodic => (Side::periodic(resolution, 0.0, 1.0), Condition::Outflow),
        BoxEnds::Fixed => (Side::ends(resolution, 0.0, 1.0), Condition::dirichlet(0.0)),
        BoxEnds::Free => (Side::ends(resolution, 0.0, 1.0), Condition::neumann(0.0)),
    };
    (in_directions(side, dims), Boundary::all(condition))
}

/// A mesh with one side in every direction.
fn in_directions(side: Side, dims: usize) -> Mesh {
    match dims {
        1 => Mesh::new([side]),
        2 => Mesh::new([side; 2]),
        _ => Mesh::new([side; 3]),
    }
}

/// What a scene adds to a run.
trait Flow<T: Compiled> {
    /// When it ends if nobody says otherwise, s.
    fn end_time(&self) -> f64;

    /// Adds monitors and stop criteria.
    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid>;

    /// Adds what is to be seen of unknowns of these names.
    fn show(&self, dump: Dump, unknowns: &[String]) -> Dump {
        unknowns.iter().fold(dump, |dump, name| dump.scalar(name))
    }

    /// Draws results from the histories and the final state.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    );

    /// The final state.
    fn picture(&self, simulation: &Simulation<Grid>, parts: &Parts<T>) -> Picture;
}

/// A scene with its model.
struct FdScene<T: Compiled> {
    fd: Fd<T>,
    flow: Box<dyn Flow<T>>,
    /// What is modelled, for checkpoints.
    description: String,
}

impl<T: Compiled> Prepared for FdScene<T> {
    fn points(&self) -> usize {
        self.fd.parts.mesh.points()
    }

    /// Measured: with two workers heat and vortices in the plane are slower than with one at 8,100 points, and faster
    /// at 16,384.
    fn points_per_worker(&self) -> usize {
        8000
    }

    fn run(self: Box<Self>, orders: Orders) -> Result<Report, SceneError> {
        let workers = self.workers(&orders);
        let Self { fd: Fd { model, parts }, flow, description } = *self;
        let names: Vec<_> = parts
            .unknowns
            .iter()
            .map(|&u| model.columns.column(finegrain_framework::Handle::id(u)).name().to_owned())
            .collect();
        let (simulation, trace) = (orders.simulation(model, workers)?, orders.trace.clone());
        let run = flow.observe(Run::new(simulation).scene(description), &parts);
        let mut run = orders
            .plan(run, flow.end_time(), |every| flow.show(Dump::new("fields", every), &names));
        let summary = run.run()?;
        let mut report = Report::new(&summary, parts.mesh.points());
        let simulation = run.simulation_mut();
        report.trace(simulation, trace)?;
        flow.judge(&mut report, &summary, simulation, &parts);
        report.picture = Some(flow.picture(simulation, &parts));
        Ok(report)
    }
}

/// Positions, m, and values of an unknown.
fn values<'a, T: Compiled>(
    simulation: &'a Simulation<Grid>,
    parts: &'a Parts<T>,
    unknown: usize,
) -> impl Iterator<Item = ([f64; 3], f64)> + 'a {
    let values = simulation.columns().values(parts.unknowns[unknown]);
    parts.mesh.positions().zip(values.iter().map(|u| u.as_f64()))
}

/// An unknown along the line, with what it should be; in the plane as a field, and in space one in a slice
/// through the middle.
fn picture<T: Compiled>(
    simulation: &Simulation<Grid>,
    parts: &Parts<T>,
    title: String,
    quantity: Axis,
    exact: impl Fn([f64; 3]) -> f64,
) -> Picture {
    let [nx, ny, nz] = parts.mesh.shape();
    let title = at_time(title, simulation.clock().time());
    if ny * nz == 1 {
        let computed = values(simulation, parts, 0).map(|(x, u)| [x[0], u]);
        return chart(title, quantity, computed.collect(), |x| exact([x, 0.0, 0.0])).into();
    }
    let slice = values(simulation, parts, 0).skip(nz / 2 * nx * ny).take(nx * ny);
    let ([x, y, _], [dx, dy, _]) = (parts.mesh.position([0; 3]), parts.mesh.spacing());
    Field::of_grid([nx, ny], [x, y], [dx, dy], slice.map(|(_, u)| u))
        .title(title)
        .quantity(quantity)
        .into()
}

/// Points along x, of many thousands some, with what they should be.
fn chart(
    title: String,
    quantity: Axis,
    points: Vec<[f64; 2]>,
    exact: impl Fn(f64) -> f64,
) -> Chart {
    let [first, last] = [points.first(), points.last()].map(|end| end.map_or(0.0, |end| end[0]));
    let line = (0..=1000).map(|k| {
        let x = first + (last - first) * f64::from(k) / 1000.0;
        [x, exact(x)]
    });
    // So that what differs from point to point is seen, and both ends are.
    let (step, end) = (points.len().div_ceil(2000).max(1), points.len().saturating_sub(1));
    let shown = points.into_iter().enumerate().filter(|(i, _)| i % step == 0 || *i == end);
    Chart::new(title)
        .x(Axis::new("x").unit("m"))
        .y(quantity)
        .series("finite differences", shown.map(|(_, point)| point))
        .reference("exact", line)
}

/// Everything that is modelled, for checkpoints.
fn description(scene: &str, parameters: &Parameters, precision: Precision) -> String {
    super::description(scene, "fd", parameters, precision)
}
