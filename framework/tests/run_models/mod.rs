//! Small models of every kind that a run must be able to take up again: a grid that swaps,
//! ordinary differential equations under several integrators, and particles that are re-sorted.

#![allow(dead_code, reason = "every test uses some of it")]

use std::collections::BTreeMap;
use std::path::Path;

use finegrain_framework::run::{Dump, Every, Run};
use finegrain_framework::space::cells::{CellsOptions, Region};
use finegrain_framework::space::{Cells, Grid, Independent};
use finegrain_framework::*;

/// How to make a model, and what to write of it.
pub struct Case<D: Domain> {
    pub model: fn() -> Model<D>,
    pub outputs: fn(Run<D>) -> Run<D>,
    /// About twelve steps.
    pub end: f64,
}

/// Diffusion with a coefficient that time step control depends on, in paces of five steps.
pub const HEAT: Case<Grid> = Case {
    model: heat,
    outputs: |run| {
        let temperature = column(&run, "temperature");
        run.monitor("heat", Every::Steps(2), ["sum", "most"], move |whole| {
            let [sum] = whole.sum(|near| [own(near, temperature).iter().sum()]);
            let [most] = whole.max(|near| {
                [own(near, temperature).iter().copied().fold(f64::NEG_INFINITY, f64::max)]
            });
            [sum, most]
        })
        .dump(Dump::new("fields", Every::Time(0.21)).scalar("temperature"))
    },
    end: 1.0,
};

/// A driven oscillator at many points, by leapfrog, whose last rates live on.
pub const LEAPFROG: Case<Independent> =
    Case { model: || oscillators(Integrator::Leapfrog), outputs: oscillator_outputs, end: 1.0 };

/// The same by a Runge-Kutta method.
pub const RK4: Case<Independent> =
    Case { model: || oscillators(Integrator::Rk4), outputs: oscillator_outputs, end: 1.0 };

/// Particles that repel one another in a periodic box, sorted anew every few steps.
pub const SWARM: Case<Cells<f64>> = Case {
    model: swarm,
    outputs: |run| {
        let velocity = [column(&run, "velocity_x"), column(&run, "velocity_y")];
        run.monitor("energy", Every::Time(0.05), ["kinetic"], move |whole| {
            whole.sum(|near| {
                let [u, v] = velocity.map(|v| own(near, v));
                [u.iter().zip(v).map(|(u, v)| 0.5 * (u * u + v * v)).sum()]
            })
        })
        .dump(
            Dump::new("particles", Every::Steps(3))
                .scalar("identity")
                .vector("velocity", ["velocity_x", "velocity_y"]),
        )
    },
    end: 0.5,
};

/// A run of `case` that writes to `folder`, without an end.
pub fn plan<D: Domain>(case: &Case<D>, settings: Settings, folder: &Path) -> Run<D> {
    let simulation = Simulation::new((case.model)(), settings).unwrap();
    (case.outputs)(Run::new(simulation)).out(folder).scene("seven")
}

/// Settings that no result may depend on, different for every `number`.
pub fn settings(number: usize) -> Settings {
    Settings {
        schedule: Schedule::ALL[number % Schedule::ALL.len()],
        workers: 1 + number % 3,
        hand_out: HandOut::Shuffled { seed: number as u64 },
        steps_ahead: Some(1 + number as u64 % 4),
        ..Settings::default()
    }
}

/// All files of a folder but checkpoints, by name.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().map(Result::unwrap);
    let named = entries.map(|entry| (entry.file_name().into_string().unwrap(), entry.path()));
    named
        .filter(|(name, _)| !name.ends_with(".ckpt"))
        .map(|(name, path)| (name, std::fs::read(path).unwrap()))
        .collect()
}

/// Names of the checkpoints in a folder, in order.
pub fn checkpoints(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().map(Result::unwrap);
    let names = entries.map(|entry| entry.file_name().into_string().unwrap());
    let mut names: Vec<_> = names.filter(|name| name.ends_with(".ckpt")).collect();
    names.sort_unstable();
    names
}

fn own<'a, D: Domain>(near: &Near<'a, D>, column: State<f64>) -> &'a [f64] {
    near.state(column).own().whole()
}

/// The handle of a state column that the model's maker did not hand out.
fn column<D: Domain>(run: &Run<D>, name: &str) -> State<f64> {
    run.simulation().columns().find_state(name).unwrap()
}

struct Diffusion {
    temperature: State<f64>,
    next: Rate<f64>,
}

impl RateStage<Grid> for Diffusion {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.next.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        let (now, mut next) = (near.rows(self.temperature), rates.rows(self.next));
        for (j, k) in near.sub_domain().rows() {
            let row = |dj| now.row(j as isize + dj, k as isize);
            let (south, here, north) = (row(-1), row(0), row(1));
            let n = here.len();
            for (i, next) in next.row(j, k).iter_mut().enumerate() {
                let (west, east) = (here[(i + n - 1) % n], here[(i + 1) % n]);
                let flow = south[i] + north[i] + west + east - 4.0 * here[i];
                *next = here[i] + moment.dt * flow + 1e-3 * moment.stage_time.sin();
            }
        }
        Ok(())
    }
}

/// A time step that depends on the state, for five steps.
struct HeatPacing(State<f64>);

impl Pacing<Grid> for HeatPacing {
    fn pace(&mut self, whole: &mut Whole<'_, Grid>) -> Result<Pace, Fault> {
        let [most] =
            whole.max(|near| [own(near, self.0).iter().copied().fold(f64::NEG_INFINITY, f64::max)]);
        Ok(Pace { dt: 0.07 + 0.01 * most, steps: 5 })
    }
}

fn heat() -> Model<Grid> {
    let domain = Grid::builder([9, 14]).periodic([true, true]).tile(3, 1).build();
    let mut columns = Columns::new(domain.points());
    let (temperature, next) = (columns.state("temperature"), columns.rate("next"));
    for (i, t) in columns.values_mut(temperature).iter_mut().enumerate() {
        *t = (i as f64 * 0.37).sin();
    }
    let step = Step::builder().rate(Diffusion { temperature, next }).swap(temperature, next);
    Model {
        method: "heat".to_owned(),
        domain,
        columns,
        plan: step.build().into(),
        whole: Vec::new(),
        pacing: Box::new(HeatPacing(temperature)),
    }
}

struct Oscillator {
    position: State<f64>,
    velocity: State<f64>,
    acceleration: Rate<f64>,
}

impl RateStage<Independent> for Oscillator {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        vec![self.acceleration.id()]
    }

    fn rate(
        &self,
        near: &Near<'_, Independent>,
        rates: &mut Rates<'_, Independent>,
        _: &mut (),
        moment: &Moment,
    ) -> Result<(), Fault> {
        let (x, v) = (own(near, self.position), own(near, self.velocity));
        for (i, a) in rates.column(self.acceleration).whole().iter_mut().enumerate() {
            *a = -x[i] - 0.1 * v[i] + moment.stage_time.cos();
        }
        Ok(())
    }
}

fn oscillators(integrator: Integrator) -> Model<Independent> {
    let domain = Independent::with_share(50, 8);
    let mut columns = Columns::new(50);
    let (position, velocity) = (columns.state("position"), columns.state("velocity"));
    let acceleration = columns.rate("acceleration");
    for (i, x) in columns.values_mut(position).iter_mut().enumerate() {
        *x = 1.0 + 0.1 * i as f64;
    }
    let evaluation = [Stage::rate(Oscillator { position, velocity, acceleration })];
    let evolution = Evolution::new().with_motion(position, velocity).with(velocity, acceleration);
    let plan = integrator.plan(&mut columns, &evolution, &evaluation);
    Model::with_fixed_dt("oscillators", domain, columns, plan, 0.083)
}

fn oscillator_outputs(run: Run<Independent>) -> Run<Independent> {
    let position = column(&run, "position");
    run.monitor("mean", Every::Steps(1), ["position"], move |whole| {
        whole.sum(|near| [own(near, position).iter().sum::<f64>() / 50.0])
    })
    .dump(Dump::new("points", Every::Steps(5)).scalar("position").vector("velocity", ["velocity"]))
}

struct Repulsion {
    position: [State<f64>; 2],
    acceleration: [Rate<f64>; 2],
}

impl RateStage<Cells<f64>> for Repulsion {
    type Scratch = Vec<space::cells::Run>;

    fn writes(&self) -> Vec<ColumnId> {
        self.acceleration.map(Handle::id).to_vec()
    }

    fn rate(
        &self,
        near: &Near<'_, Cells<f64>>,
        rates: &mut Rates<'_, Cells<f64>>,
        runs: &mut Self::Scratch,
        _: &Moment,
    ) -> Result<(), Fault> {
        let range = near.domain().range();
        let at = self.position.map(|x| near.state(x));
        let [ax, ay] = self.acceleration.map(|a| rates.column(a));
        let (ax, ay) = (ax.whole(), ay.whole());
        let (block, first) = (near.sub_domain(), near.spans()[0].start);
        for cell in block.cells() {
            block.candidates(cell, runs);
            for i in cell.span.range() {
                let i = i - first;
                let here = at.map(|x| x.own().whole()[i]);
                let mut sum = [0.0; 2];
                for run in &*runs {
                    let [x, y] = at.map(|x| x.at(near.reach(run.owner, run.span)));
                    for (x, y) in x.iter().zip(y) {
                        let d = [here[0] - x - run.shift[0], here[1] - y - run.shift[1]];
                        let distance = (d[0] * d[0] + d[1] * d[1]).sqrt();
                        if distance > 0.0 && distance < range {
                            let force = 5.0 * (1.0 - distance / range) / distance;
                            sum = [sum[0] + force * d[0], sum[1] + force * d[1]];
                        }
                    }
                }
                [ax[i], ay[i]] = sum;
            }
        }
        Ok(())
    }
}

struct Sort;

impl WholeStage<Cells<f64>> for Sort {
    fn name(&self) -> &str {
        "sort into cells"
    }

    fn run(&mut self, whole: &mut Whole<'_, Cells<f64>>) -> Result<(), Fault> {
        whole.domain.sort(whole.columns, whole.team)
    }
}

struct SwarmPacing([State<f64>; 2]);

impl Pacing<Cells<f64>> for SwarmPacing {
    fn pace(&mut self, whole: &mut Whole<'_, Cells<f64>>) -> Result<Pace, Fault> {
        let [most] = whole.max(|near| {
            let [u, v] = self.0.map(|v| own(near, v));
            [u.iter().zip(v).map(|(u, v)| u * u + v * v).fold(0.0, f64::max)]
        });
        Ok(Pace { dt: 0.04 / (1.0 + 0.1 * most), steps: 3 })
    }
}

fn swarm() -> Model<Cells<f64>> {
    let points = 120;
    let mut columns = Columns::new(points);
    let position = ["x", "y"].map(|name| columns.state::<f64>(name));
    let velocity = ["velocity_x", "velocity_y"].map(|name| columns.state::<f64>(name));
    let acceleration = ["force_x", "force_y"].map(|name| columns.rate::<f64>(name));
    let identity = columns.state::<u32>("identity");
    for i in 0..points {
        columns.values_mut(identity)[i] = i as u32;
        for a in 0..2 {
            let x = (i as f64 * [0.618_033_988, 0.754_877_666][a]).fract();
            columns.values_mut(position[a])[i] = 4.0 * x;
            columns.values_mut(velocity[a])[i] = (i as f64 * [1.3, 2.9][a]).sin();
        }
    }
    let region = Region { lower: vec![0.0; 2], upper: vec![4.0; 2], periodic: vec![true; 2] };
    let options = CellsOptions { region, range: 0.5, skin: 0.6, block_points: 8 };
    let domain = Cells::new(&mut columns, &position, options).unwrap();
    let evolution = Evolution::new()
        .with_motion(position[0], velocity[0])
        .with_motion(position[1], velocity[1])
        .with(velocity[0], acceleration[0])
        .with(velocity[1], acceleration[1]);
    let evaluation = [Stage::rate(Repulsion { position, acceleration })];
    let plan = Integrator::Leapfrog.plan(&mut columns, &evolution, &evaluation);
    Model {
        method: "swarm".to_owned(),
        domain,
        columns,
        plan,
        whole: vec![Box::new(Sort)],
        pacing: Box::new(SwarmPacing(velocity)),
    }
}
