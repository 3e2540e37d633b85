//! Lattice Boltzmann on a periodic cube: million site updates a second of whole steps, beside what the memory
//! allows: copies of as many columns, and updates of them in place.
//!
//! `cargo bench --bench lbm -- [sites along a side] [samples] [short]`; `benches/lbmpy/compare.py` runs it in
//! turns with lbmpy.

mod samples;

use std::f64::consts::TAU;

use finegrain::framework::pack::{Fill, Pack, Targets, prefetch};
use finegrain::framework::space::Grid;
use finegrain::framework::space::grid::RowsOfMut;
use finegrain::framework::*;
use finegrain::lbm::{
    Collision, Compiled, Fluid, LatticeKind, Lbm, LbmError, Mesh, Physics, Scheme, Start,
    Streaming, mesh,
};
use samples::{Case, sample};

/// Steps of a sample.
const STEPS: u64 = 10;
/// Velocities of D3Q19.
const COLUMNS: usize = 19;
/// Packs for which memory is asked ahead, as the method does.
const AHEAD: usize = 6;

/// How much is measured.
#[derive(Clone, Copy)]
struct Extent {
    side: usize,
    samples: usize,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let numbers: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    let extent = Extent {
        side: numbers.first().copied().unwrap_or(128),
        samples: numbers.get(1).copied().unwrap_or(5),
    };
    let workers = std::thread::available_parallelism()?.get();
    println!("{}, sites: {}^3", lanes::instruction_set(), extent.side);
    println!("| | workers | schedule | best | median | beside the first |");
    println!("|---|---|---|---|---|---|");
    let trt = Collision::Trt { magic: 3.0 / 16.0 };
    compare::<f64>(LatticeKind::D3Q19, [Collision::CentralMoments, trt], workers, extent)?;
    compare::<f32>(LatticeKind::D3Q19, [Collision::CentralMoments, trt], workers, extent)?;
    if std::env::args().any(|a| a == "short") {
        return Ok(());
    }
    for (lattice, collision) in [
        (LatticeKind::D3Q19, Collision::Bgk),
        (LatticeKind::D3Q19, Collision::Cumulant),
        (LatticeKind::D3Q19, Collision::Regularised),
        (LatticeKind::D3Q27, Collision::CentralMoments),
    ] {
        let mut runs = Vec::new();
        for streaming in [Streaming::TwoGrids, Streaming::InPlace] {
            let name = format!("{}, {collision:?}, f64, {streaming:?}", lattice.name());
            let model = flow::<f64>(lattice, collision, streaming, extent.side)?;
            runs.push(Run::new(name, model, Schedule::Lockstep, workers)?);
        }
        measure(&mut runs, extent);
    }
    Ok(())
}

/// Prints the speed of both ways to stream with the first collision, and in place with the second, on one worker
/// and on all, beside that of memory.
fn compare<T: Compiled>(
    lattice: LatticeKind,
    [collision, other]: [Collision; 2],
    workers: usize,
    extent: Extent,
) -> Result<(), Box<dyn std::error::Error>> {
    use Schedule::{Lockstep, PeerToPeer};
    use Streaming::{InPlace, TwoGrids};
    let scalar = std::any::type_name::<T>();
    let mut runs = Vec::new();
    for (collision, streaming, schedule, workers) in [
        (collision, TwoGrids, Lockstep, 1),
        (collision, InPlace, Lockstep, 1),
        (collision, TwoGrids, Lockstep, workers),
        (collision, InPlace, Lockstep, workers),
        (collision, TwoGrids, PeerToPeer, workers),
        (collision, InPlace, PeerToPeer, workers),
        (other, InPlace, Lockstep, 1),
        (other, InPlace, Lockstep, workers),
        (other, InPlace, PeerToPeer, workers),
    ] {
        let name = format!("{}, {collision:?}, {scalar}, {streaming:?}", lattice.name());
        let model = flow::<T>(lattice, collision, streaming, extent.side)?;
        runs.push(Run::new(name, model, schedule, workers)?);
    }
    for workers in [1, workers] {
        for (name, is_in_place) in [("copied", false), ("updated in place", true)] {
            let name = format!("{COLUMNS} columns of {scalar} {name}");
            runs.push(Run::new(name, memory::<T>(is_in_place, extent.side), Lockstep, workers)?);
        }
    }
    measure(&mut runs, extent);
    // Written past the caches or not, swept or ahead.
    for streaming in 0..2 {
        let same: Vec<_> =
            (0..3).map(|n| runs[streaming + 2 * n].simulation.state_hash()).collect();
        assert!(same.iter().all(|hash| *hash == same[0]), "bits differ");
    }
    Ok(())
}

/// Something to be timed.
struct Run {
    name: String,
    simulation: Simulation<Grid>,
}

impl Run {
    fn new(
        name: String,
        model: Model<Grid>,
        schedule: Schedule,
        workers: usize,
    ) -> std::io::Result<Self> {
        let settings = Settings { schedule, workers, ..Settings::default() };
        let name = format!("{name} | {workers} | {schedule}");
        Ok(Self { name, simulation: Simulation::new(model, settings)? })
    }
}

fn measure(runs: &mut [Run], extent: Extent) {
    let mut cases: Vec<_> = runs
        .iter_mut()
        .map(|run| {
            let simulation = &mut run.simulation;
            let advance = || simulation.advance(STEPS).expect("waves decay without fault");
            Case::new(run.name.clone(), advance)
        })
        .collect();
    sample(&mut cases, extent.samples);
    let speed = |seconds: f64| 1e-6 * (STEPS as usize * extent.side.pow(3)) as f64 / seconds;
    for case in &cases {
        let [best, median] = [case.best(), case.median()].map(speed);
        let ratio = case.speed_beside(&cases[0]);
        println!("| {} | {best:.1} | {median:.1} | {ratio:.2} |", case.name);
    }
}

/// A wave of shear.
fn flow<T: Compiled>(
    lattice: LatticeKind,
    collision: Collision,
    streaming: Streaming,
    side: usize,
) -> Result<Model<Grid>, LbmError> {
    let spacing = 1.0 / side as f64;
    let mesh = Mesh {
        shape: [side; 3],
        corner: [0.0; 3],
        spacing,
        time_step: mesh::time_step_of_mach(spacing, 1.0, 0.1),
        periodic: [true; 3],
    };
    let fluid = Fluid { density: 1.0, kinematic_viscosity: 0.01, largest_speed: 1.0 };
    let start = Start::with_velocity(|[_, y, z]| [(TAU * y).sin(), 0.0, (TAU * z).cos()]);
    let streaming = Some(streaming);
    let scheme = Scheme { collision, streaming, ..Scheme::on(lattice) };
    Ok(Lbm::<T>::new(&mesh, &fluid, &Physics::default(), &scheme, &start)?.model)
}

/// As many columns as D3Q19 has, copied or updated in place: the same memory without the physics.
fn memory<T: Real>(is_in_place: bool, side: usize) -> Model<Grid> {
    let domain = Grid::builder([side; 3]).periodic([true; 3]).build();
    let mut columns = Columns::new(domain.points());
    let now: [State<T>; COLUMNS] = std::array::from_fn(|q| columns.state(&format!("now_{q}")));
    let step = if is_in_place {
        Step::builder().update(Update { now }).build()
    } else {
        let next = std::array::from_fn(|q| columns.rate(&format!("next_{q}")));
        let step = Step::builder().rate(Copy { now, next });
        (0..COLUMNS).fold(step, |step, q| step.swap(now[q], next[q])).build()
    };
    Model::with_fixed_dt("memory", domain, columns, step, 1.0)
}

/// Copies columns, past the caches where that is faster.
struct Copy<T> {
    now: [State<T>; COLUMNS],
    next: [Rate<T>; COLUMNS],
}

impl<T: Real> RateStage<Grid> for Copy<T> {
    type Scratch = ();

    fn writes(&self) -> Vec<ColumnId> {
        self.next.iter().map(|next| next.id()).collect()
    }

    fn rate(
        &self,
        near: &Near<'_, Grid>,
        rates: &mut Rates<'_, Grid>,
        _: &mut (),
        _: &Moment,
    ) -> Result<(), Fault> {
        let now = self.now.map(|now| near.rows(now));
        let mut next = rates.rows_of(self.next);
        for (j, k) in near.sub_domain().rows() {
            let from = now.each_ref().map(|now| now.row(j as isize, k as isize));
            pulp::Arch::new().dispatch(CopyRow { from, to: &mut next, row: (j, k) });
        }
        Ok(())
    }
}

struct CopyRow<'a, 'n, T> {
    from: [&'a [T]; COLUMNS],
    to: &'a mut RowsOfMut<'n, T, COLUMNS>,
    row: (usize, usize),
}

impl<T: Real> pulp::WithSimd for CopyRow<'_, '_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let from = self.from.map(|from| T::Pack::<S>::packs(simd, from));
        let x = 0..self.from[0].len();
        self.to.fill::<T::Pack<S>>(simd, self.row, x, From::<T::Pack<S>>(from));
    }
}

struct From<'a, P: Pack>([&'a [P::Vector]; COLUMNS]);

impl<P: Pack> Fill<P::Vector, COLUMNS> for From<'_, P> {
    #[inline(always)]
    fn fill(self, to: &mut Targets<'_, P::Vector, COLUMNS>) {
        let from = self.0;
        for i in 0..from[0].len() {
            let mut values = [from[0][i]; COLUMNS];
            for q in 0..COLUMNS {
                prefetch(from[q], i + AHEAD);
                values[q] = from[q][i];
            }
            to.write(i, values);
        }
    }
}

/// Updates columns in place.
struct Update<T> {
    now: [State<T>; COLUMNS],
}

impl<T: Real> UpdateStage<Grid> for Update<T> {
    type Scratch = ();

    fn update(&self, own: &mut Own<'_, Grid>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let mut now = self.now.map(|now| own.rows_mut(now));
        for (j, k) in own.sub_domain().rows() {
            let row = now.each_mut().map(|now| now.row(j, k));
            pulp::Arch::new().dispatch(UpdateRow { row });
        }
        Ok(())
    }
}

struct UpdateRow<'a, T> {
    row: [&'a mut [T]; COLUMNS],
}

impl<T: Real> pulp::WithSimd for UpdateRow<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, simd: S) {
        let row = self.row.map(|row| T::Pack::<S>::packs_mut(simd, row));
        for i in 0..row[0].len() {
            for q in 0..COLUMNS {
                prefetch(row[q], i + AHEAD);
                row[q][i] = (T::Pack::<S>::of(simd, row[q][i]) + T::one()).vector();
            }
        }
    }
}
