//! The cost of a step is linear in the number of particles: what a particle has to look at does
//! not depend on how many there are, in a box that is filled and in one that is nearly empty.

use std::time::{Duration, Instant};

use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::{CellsOptions, Region};
use finegrain_framework::{Columns, Domain, Schedule, Settings, Simulation, State, Team};
use finegrain_sph::{Fluid, Packing, Physics, Scheme, Sph, Start, StateEquation, Viscosity};

/// Candidates that a particle has on average, and neighbouring sub-domains that a sub-domain has.
fn work_per_particle(positions: &[[f64; 3]], region: Region, range: f64) -> (f64, f64) {
    let mut columns = Columns::new(positions.len());
    let axes: Vec<State<f64>> = ["x", "y", "z"].iter().map(|name| columns.state(name)).collect();
    for (a, &axis) in axes.iter().enumerate() {
        for (x, at) in columns.values_mut(axis).iter_mut().zip(positions) {
            *x = at[a];
        }
    }
    let options = CellsOptions { region, range, skin: 0.1 * range, block_points: 64 };
    let mut cells = Cells::new(&mut columns, &axes, options).unwrap();
    let mut team = Team::new(1).unwrap();
    cells.sort(&mut columns, &mut team).unwrap();
    let (mut candidates, mut neighbours, mut runs) = (0, 0, Vec::new());
    let blocks = cells.partition().len();
    for id in 0..blocks {
        let block = cells.sub_domain(id);
        neighbours += cells.partition().neighbours(id).len();
        for cell in block.cells() {
            block.candidates(cell, &mut runs);
            let seen: usize = runs.iter().map(|run| run.span.len()).sum();
            candidates += cell.span.len() * seen;
        }
    }
    (candidates as f64 / positions.len() as f64, neighbours as f64 / blocks as f64)
}

#[test]
fn in_a_filled_periodic_box() {
    let work = |width: f64| {
        let lattice = Packing::HexagonalClosePacked.fit([0.01, 0.01, width], 0.0002).unwrap();
        let region = Region {
            lower: vec![0.0; 3],
            upper: lattice.lengths().to_vec(),
            periodic: vec![true; 3],
        };
        work_per_particle(&lattice.positions().collect::<Vec<_>>(), region, 0.0006)
    };
    let ((few, few_blocks), (many, many_blocks)) = (work(0.005), work(0.02));
    assert!((many / few - 1.0).abs() < 0.1, "{few} and {many} candidates");
    assert!((many_blocks / few_blocks - 1.0).abs() < 0.1, "{few_blocks} and {many_blocks}");
    // A sphere of the range holds 160 particles, the cells around it 27 / (4/3 pi) times as many.
    assert!(many < 160.0 * 27.0 / 4.19 * 1.5, "{many} candidates");
}

#[test]
fn empty_space_costs_nothing() {
    let lattice = Packing::Cubic.fit([1.0; 3], 0.1).unwrap();
    let cluster: Vec<_> = lattice.positions().collect();
    let open = || Region { lower: vec![0.0; 3], upper: vec![1.0; 3], periodic: vec![false; 3] };
    let (alone, _) = work_per_particle(&cluster, open(), 0.2);
    let far = cluster.iter().map(|x| x.map(|x| x + 100.0));
    let both: Vec<_> = cluster.iter().copied().chain(far).collect();
    let (apart, _) = work_per_particle(&both, open(), 0.2);
    assert!(apart < 1.3 * alone, "{alone} candidates in one cluster, {apart} in two far apart");
}

/// Time that ten steps of a vortex flow take, with all that happens between them; the least of several
/// times, which what else the machine does can only make longer.
fn time_of_steps(length: f64) -> Duration {
    let lattice = Packing::Square.fit([length, 3.2, 1.0], 0.1).unwrap();
    let positions: Vec<_> = lattice.displaced_positions(0.1, 7).collect();
    let start = Start {
        region: Region {
            lower: vec![0.0; 2],
            upper: lattice.lengths()[..2].to_vec(),
            periodic: vec![true; 2],
        },
        spacing: 0.1,
        particle_volume: lattice.volume_per_particle(),
        velocities: positions.iter().map(|x| [0.0, x[0].sin(), 0.0]).collect(),
        positions,
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 10.0,
        kinematic_viscosity: 0.01,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let physics = Physics { viscosity: Some(Viscosity::StrainRate), ..Physics::default() };
    let sph = Sph::<f64>::new(&start, &fluid, &physics, &Scheme::default()).unwrap();
    let settings = Settings { schedule: Schedule::Serial, ..Settings::default() };
    let mut simulation = Simulation::new(sph.model, settings).unwrap();
    let ten_steps = |simulation: &mut Simulation<_>| {
        let begin = Instant::now();
        simulation.advance(10).unwrap();
        begin.elapsed()
    };
    (0..8).map(|_| ten_steps(&mut simulation)).min().unwrap()
}

/// Sixteen times as many particles: 256 times the time if anything in a step were quadratic.
#[test]
fn of_a_whole_step() {
    let (few, many) = (time_of_steps(6.4), time_of_steps(16.0 * 6.4));
    let growth = many.as_secs_f64() / few.as_secs_f64();
    assert!(growth < 2.5 * 16.0, "{growth} times as long for 16 times as many particles");
}
