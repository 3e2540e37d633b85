//! What scenes of incompressible flow share: histories, dumps, divergence and momentum, and the picture.

use finegrain_fd::{Compiled, FlowEnd, Mesh, NavierStokes, Parts, Spread, StaggeredOrder, measure};
use finegrain_framework::run::{Dump, Every, Run, Summary};
use finegrain_framework::shape::Shape;
use finegrain_framework::space::Grid;
use finegrain_framework::{Rate, Simulation, Whole};

use super::Flow;
use crate::figure::{Axis, Field};
use crate::scene::parameter::{Kind, Parameter, Parameters};
use crate::scene::report::Picture;
use crate::scene::{Report, at_time, cubic};

/// Of operators in periodic boxes.
pub const ORDER: Parameter = Parameter {
    name: "order",
    kind: Kind::Choice { default: "4", names: &["2", "4"] },
    unit: "",
    help: "of the operators: Harlow & Welch (1965), Morinishi et al. (1998)",
    only_with: None,
};

/// A fluid without forces between walls at rest, if there are any, for the parameters of time steps and, in periodic
/// boxes, [`ORDER`].
pub fn equation(parameters: &Parameters, viscosity: f64, order: StaggeredOrder) -> NavierStokes {
    NavierStokes {
        viscosity,
        acceleration: [0.0; 3],
        ends: [[FlowEnd::REST; 2]; 3],
        bodies: Vec::new(),
        order,
        integrator: super::integrator(parameters),
        courant: parameters.number("courant"),
    }
}

/// What [`ORDER`] says.
pub fn order(parameters: &Parameters) -> StaggeredOrder {
    match parameters.choice("order") {
        "2" => StaggeredOrder::Second,
        _ => StaggeredOrder::Fourth,
    }
}

/// A scene of incompressible flow.
pub trait Scene {
    /// When it ends if nobody says otherwise, s.
    fn end_time(&self) -> f64;

    /// Time between samples of the history, s.
    fn sampling(&self) -> f64;

    /// Bodies in the flow.
    fn bodies(&self) -> Vec<Shape> {
        Vec::new()
    }

    /// Adds histories after the first, which has `kinetic_energy`, and stop criteria.
    fn observe<T: Compiled>(&self, run: Run<Grid>, _parts: &Parts<T>) -> Run<Grid> {
        run
    }

    /// Draws results from the histories and the final state, whose derived fields are up to date.
    fn judge<T: Compiled>(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    );

    /// Title of the picture of the final field.
    fn title(&self) -> String;
}

/// The flow of a scene.
pub struct Incompressible<S>(pub S);

impl<T: Compiled, S: Scene> Flow<T> for Incompressible<S> {
    fn end_time(&self) -> f64 {
        self.0.end_time()
    }

    fn observe(&self, run: Run<Grid>, parts: &Parts<T>) -> Run<Grid> {
        let all = parts.clone();
        let columns = [
            "kinetic_energy",
            "largest_speed",
            "momentum_x",
            "momentum_y",
            "momentum_z",
            "divergence",
        ];
        let run = run.monitor("flow", Every::Time(self.0.sampling()), columns, move |whole| {
            let [x, y, z] = momentum(whole, &all);
            let [energy, speed] = energy_and_speed(whole, &all);
            [energy, speed, x, y, z, measure::largest(whole, divergence(&all))]
        });
        self.0.observe(run, parts)
    }

    fn show(&self, dump: Dump, unknowns: &[String]) -> Dump {
        let [pressure, velocity @ .., _] = NavierStokes::DERIVED;
        dump.scalar(pressure).vector("velocity", velocity.into_iter().take(unknowns.len()))
    }

    /// `largest_speed`: of any component of the velocity at any time; `divergence`: the largest, times the spacing over
    /// the largest speed; in an empty periodic box `momentum_change`: the largest of its components' since the
    /// beginning, over the largest speed; without bodies `ripples`.
    fn judge(
        &self,
        report: &mut Report,
        summary: &Summary,
        simulation: &mut Simulation<Grid>,
        parts: &Parts<T>,
    ) {
        let mut whole = simulation.whole();
        let [_, speed] = energy_and_speed(&mut whole, parts);
        let spacing = parts.mesh.spacing().into_iter().take(parts.mesh.dims()).fold(0.0, f64::max);
        let largest = measure::largest(&mut whole, divergence(parts));
        let history = &summary.histories[0];
        let before = history.column("largest_speed").into_iter().flatten();
        report.result("largest_speed", before.fold(speed, f64::max), None);
        if speed > 0.0 {
            report.result("divergence", largest * spacing / speed, None);
        }
        let mut sides = parts.mesh.sides().iter();
        let is_free =
            self.0.bodies().is_empty() && sides.all(|side| side.spread == Spread::Periodic);
        if is_free && speed > 0.0 {
            let names = ["momentum_x", "momentum_y", "momentum_z"];
            let before = names.map(|name| history.column(name)?.next());
            let pairs = momentum(&mut whole, parts).into_iter().zip(before);
            let change = pairs.map(|(now, before)| (now - before.unwrap_or(now)).abs());
            report.result("momentum_change", change.fold(0.0, f64::max) / speed, None);
        }
        if self.0.bodies().is_empty() && speed > 0.0 {
            report.result("ripples", ripples(simulation, parts), None);
        }
        self.0.judge(report, summary, simulation, parts);
    }

    /// The speed around bodies, in space in a slice through the middle.
    fn picture(&self, simulation: &Simulation<Grid>, parts: &Parts<T>) -> Picture {
        let ([nx, ny, nz], [dx, dy, _]) = (parts.mesh.shape(), parts.mesh.spacing());
        let [x, y, _] = parts.mesh.position([0; 3]);
        let slice = velocities(simulation, parts).skip(nz / 2 * nx * ny).take(nx * ny);
        let bodies = self.0.bodies();
        let speeds = slice.map(|(position, [u, v, w])| {
            let is_in_body = bodies.iter().any(|body| body.contains(position));
            if is_in_body { f64::NAN } else { u.hypot(v).hypot(w) }
        });
        Field::of_grid([nx, ny], [x, y], [dx, dy], speeds)
            .title(at_time(self.0.title(), simulation.clock().time()))
            .quantity(Axis::new("speed").unit("m/s"))
            .into()
    }
}

/// How much of the velocities is as short as the mesh: the root mean square of their fourth differences over 16, over
/// that of the velocities. Of a wave it is `sin^4(k h / 2)`: 1 for what changes its sign from point to point.
fn ripples<T: Compiled>(simulation: &Simulation<Grid>, parts: &Parts<T>) -> f64 {
    let [nx, ny, _] = parts.mesh.shape();
    let strides = [1, nx, nx * ny];
    let (mut short, mut all) = (0.0, 0.0);
    for &unknown in &parts.unknowns {
        let values = simulation.columns().values(unknown);
        for (axis, side) in parts.mesh.sides().iter().enumerate() {
            let stride = strides[axis];
            for i in 0..values.len() {
                // Next to ends there are no two points on either side.
                if !(2..side.points - 2).contains(&(i / stride % side.points)) {
                    continue;
                }
                let at = |by: usize| values[i + by * stride - 2 * stride].as_f64();
                let fourth = at(0) - 4.0 * at(1) + 6.0 * at(2) - 4.0 * at(3) + at(4);
                short += (fourth / 16.0).powi(2);
                all += at(2).powi(2);
            }
        }
    }
    (short / all).sqrt()
}

/// Positions, m, and velocities, m/s, in the middle of cells.
pub fn velocities<'a, T: Compiled>(
    simulation: &'a Simulation<Grid>,
    parts: &'a Parts<T>,
) -> impl Iterator<Item = ([f64; 3], [f64; 3])> + 'a {
    let components = parts.derived[1..][..parts.mesh.dims()].iter();
    let columns: Vec<_> = components.map(|&u| simulation.columns().values(u)).collect();
    parts.mesh.positions().enumerate().map(move |(i, position)| {
        (position, [0, 1, 2].map(|a| columns.get(a).map_or(0.0, |column| column[i].as_f64())))
    })
}

/// A field in the plane at a point, by cubics through four points along each axis; of those in the middle of cells, or on
/// the faces along an axis.
pub fn interpolated<T: Compiled>(
    mesh: &Mesh,
    faces: Option<usize>,
    values: &[T],
    point: [f64; 2],
) -> f64 {
    let ([nx, ny, _], spacing, first) = (mesh.shape(), mesh.spacing(), mesh.position([0; 3]));
    let shift = |a: usize| if faces == Some(a) { 0.5 } else { 0.0 };
    let place = [0, 1].map(|a| (point[a] - first[a]) / spacing[a] + shift(a));
    let [along_x, along_y] = place.map(|place| cubic::weights(place - place.floor()));
    let at = |a: usize, by: usize, n: usize| {
        (place[a].floor() as isize + by as isize - 1).rem_euclid(n as isize) as usize
    };
    let mut sum = 0.0;
    for (dy, wy) in along_y.into_iter().enumerate() {
        for (dx, wx) in along_x.into_iter().enumerate() {
            sum += wx * wy * values[at(1, dy, ny) * nx + at(0, dx, nx)].as_f64();
        }
    }
    sum
}

fn divergence<T: Compiled>(parts: &Parts<T>) -> Rate<T> {
    parts.derived[1 + parts.mesh.dims()]
}

/// Integrals of the velocity.
pub fn momentum<T: Compiled>(whole: &mut Whole<'_, Grid>, parts: &Parts<T>) -> [f64; 3] {
    let mut momentum = [0.0; 3];
    for (total, &u) in momentum.iter_mut().zip(&parts.unknowns) {
        *total = measure::totals(whole, parts, u).integral;
    }
    momentum
}

/// The kinetic energy over the density, and the largest component of the velocity.
pub fn energy_and_speed<T: Compiled>(whole: &mut Whole<'_, Grid>, parts: &Parts<T>) -> [f64; 2] {
    let (mut energy, mut speed) = (0.0, 0.0f64);
    for &u in &parts.unknowns {
        let totals = measure::totals(whole, parts, u);
        energy += 0.5 * totals.square;
        speed = speed.max(totals.most).max(-totals.least);
    }
    [energy, speed]
}
