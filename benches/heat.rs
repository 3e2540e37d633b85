//! The method of the heat example (2-D, five points, f64) under every schedule, beside a loop
//! written by hand with rayon, in the same run.

mod samples;

use finegrain::framework::space::Grid;
use finegrain::framework::*;
use rayon::prelude::*;
use samples::{Case, sample};

/// Diffusivity dt / dx^2.
const NUMBER: f64 = 0.2;
/// Cell updates of a sample, and samples of each case.
const UPDATES: usize = 1 << 27;
const SAMPLES: usize = 20;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cores = std::thread::available_parallelism()?.get();
    for side in [4096, 512, 256] {
        for workers in [1, cores] {
            compare(side, workers)?;
        }
    }
    Ok(())
}

/// Prints the speed of all ways to step a periodic square of `side` x `side` cells.
fn compare(side: usize, workers: usize) -> Result<(), Box<dyn std::error::Error>> {
    let steps = (UPDATES / (side * side)).max(8);
    let mut hand_written = HandWritten::new(side, workers)?;
    let mut simulations = Schedule::ALL
        .into_iter()
        .filter(|&schedule| workers == 1 || schedule != Schedule::Serial)
        .map(|schedule| Ok((schedule, simulation(side, schedule, workers)?)))
        .collect::<std::io::Result<Vec<_>>>()?;
    let mut cases = vec![Case::new("by hand with rayon", || {
        (0..steps).for_each(|_| hand_written.step());
    })];
    for (schedule, (simulation, _)) in &mut simulations {
        cases.push(Case::new(schedule.name(), || {
            simulation.advance(steps as u64).expect("heat diffuses without fault");
        }));
    }
    sample(&mut cases, SAMPLES);
    println!(
        "| {side} x {side}, workers: {workers}, million cells/s | best | median | beside by hand |"
    );
    println!("|---|---|---|---|");
    let speed = |seconds: f64| 1e-6 * (steps * side * side) as f64 / seconds;
    for case in &cases {
        let [best, median] = [case.best(), case.median()].map(speed);
        let ratio = case.speed_beside(&cases[0]);
        println!("| {} | {best:.0} | {median:.0} | {ratio:.2} |", case.name);
    }
    println!();
    drop(cases);
    // All have taken the same steps, so they must have come to the same bits.
    for (schedule, (simulation, temperature)) in &simulations {
        let temperature = simulation.columns().values(*temperature);
        assert!(temperature == hand_written.now, "{schedule} differs from the loop by hand");
    }
    Ok(())
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
        near: &Near<Grid>,
        rates: &mut Rates<Grid>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        let (now, mut next) = (near.rows(self.temperature), rates.rows(self.next));
        for (j, k) in near.sub_domain().rows() {
            let row = |dj| now.row(j as isize + dj, k as isize);
            diffuse(next.row(j, k), [row(-1), row(0), row(1)]);
        }
        Ok(())
    }
}

/// One row of the next temperature; the ends are neighbours. Never inlined, so that all run the
/// same instructions and differ only in what is around them.
#[inline(never)]
fn diffuse(next: &mut [f64], rows: [&[f64]; 3]) {
    let n = next.len();
    assert!(n > 1);
    let [south, here, north] = rows.map(|row| &row[..n]);
    let value = |i: usize, west: usize, east: usize| {
        let around = here[west] + here[east] + south[i] + north[i];
        here[i] + NUMBER * (around - 4.0 * here[i])
    };
    next[0] = value(0, n - 1, 1);
    (1..n - 1).for_each(|i| next[i] = value(i, i - 1, i + 1));
    next[n - 1] = value(n - 1, n - 2, 0);
}

/// Anything that is not smooth.
fn initial(point: usize) -> f64 {
    (point as f64 * 0.37).sin()
}

fn simulation(
    side: usize,
    schedule: Schedule,
    workers: usize,
) -> std::io::Result<(Simulation<Grid>, State<f64>)> {
    let domain = Grid::builder([side, side]).periodic([true, true]).build();
    let mut columns = Columns::new(domain.points());
    let (temperature, next) = (columns.state("temperature"), columns.rate("next"));
    columns.values_mut(temperature).iter_mut().enumerate().for_each(|(i, t)| *t = initial(i));
    let step =
        Step::builder().rate(Diffusion { temperature, next }).swap(temperature, next).build();
    let model = Model::with_fixed_dt("heat", domain, columns, step, 1.0);
    let settings = Settings { schedule, workers, ..Settings::default() };
    Ok((Simulation::new(model, settings)?, temperature))
}

/// What one would write without the framework: two buffers, and rayon over rows.
struct HandWritten {
    side: usize,
    now: Vec<f64>,
    next: Vec<f64>,
    pool: rayon::ThreadPool,
}

impl HandWritten {
    fn new(side: usize, workers: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        Ok(Self {
            side,
            now: (0..side * side).map(initial).collect(),
            next: vec![0.0; side * side],
            pool: rayon::ThreadPoolBuilder::new().num_threads(workers).build()?,
        })
    }

    fn step(&mut self) {
        let Self { side, now, next, pool, .. } = self;
        let side = *side;
        let row = |j: usize| &now[j % side * side..][..side];
        pool.install(|| {
            next.par_chunks_mut(side)
                .enumerate()
                .for_each(|(j, next)| diffuse(next, [row(j + side - 1), row(j), row(j + 1)]));
        });
        std::mem::swap(now, next);
    }
}
