//! Lattice Boltzmann on a periodic cube: million site updates a second of whole steps.

mod samples;

use std::f64::consts::TAU;

use finegrain::framework::*;
use finegrain::lbm::{
    Collision, Compiled, Fluid, LatticeKind, Lbm, Mesh, Physics, Scheme, Start, mesh,
};
use samples::{Case, sample};

/// Sites along a side.
const SIDE: usize = 128;
/// Steps of a sample, and samples of each case.
const STEPS: u64 = 10;
const SAMPLES: usize = 5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cores = std::thread::available_parallelism()?.get();
    println!("{}, sites: {SIDE}^3", lanes::instruction_set());
    println!(
        "| lattice, collision, scalar | workers | schedule | best | median | beside 1 worker |"
    );
    println!("|---|---|---|---|---|---|");
    let trt = Collision::Trt { magic: 3.0 / 16.0 };
    for (lattice, collision) in [
        (LatticeKind::D3Q19, trt),
        (LatticeKind::D3Q19, Collision::Bgk),
        (LatticeKind::D3Q19, Collision::Regularised),
        (LatticeKind::D3Q19, Collision::Cumulant),
        (LatticeKind::D3Q27, trt),
    ] {
        compare::<f64>(lattice, collision, cores)?;
    }
    compare::<f32>(LatticeKind::D3Q19, trt, cores)
}

/// Prints the speed on one worker and on all, in turns.
fn compare<T: Compiled>(
    lattice: LatticeKind,
    collision: Collision,
    cores: usize,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut runs = Vec::new();
    for workers in [1, cores] {
        for schedule in [Schedule::Lockstep, Schedule::PeerToPeer] {
            let settings = Settings { schedule, workers, ..Settings::default() };
            let simulation = Simulation::new(model::<T>(lattice, collision)?, settings)?;
            runs.push((workers, schedule, simulation));
        }
    }
    let mut cases: Vec<_> = runs
        .iter_mut()
        .map(|(workers, schedule, simulation)| {
            let name = format!("{workers} | {schedule}");
            Case::new(name, || simulation.advance(STEPS).expect("waves decay without fault"))
        })
        .collect();
    sample(&mut cases, SAMPLES);
    let speed = |seconds: f64| 1e-6 * (STEPS as usize * SIDE.pow(3)) as f64 / seconds;
    for case in &cases {
        let [best, median] = [case.best(), case.median()].map(speed);
        let (lattice, scalar) = (lattice.name(), std::any::type_name::<T>());
        let ratio = case.speed_beside(&cases[0]);
        println!(
            "| {lattice}, {collision:?}, {scalar} | {} | {best:.1} | {median:.1} | {ratio:.2} |",
            case.name
        );
    }
    Ok(())
}

/// A wave of shear.
fn model<T: Compiled>(
    lattice: LatticeKind,
    collision: Collision,
) -> Result<Model<space::Grid>, finegrain::lbm::LbmError> {
    let spacing = 1.0 / SIDE as f64;
    let mesh = Mesh {
        shape: [SIDE; 3],
        corner: [0.0; 3],
        spacing,
        time_step: mesh::time_step_of_mach(spacing, 1.0, 0.1),
        periodic: [true; 3],
    };
    let fluid = Fluid { density: 1.0, kinematic_viscosity: 0.01, largest_speed: 1.0 };
    let start = Start::with_velocity(|[_, y, z]| [(TAU * y).sin(), 0.0, (TAU * z).cos()]);
    let scheme = Scheme { collision, ..Scheme::on(lattice) };
    Ok(Lbm::<T>::new(&mesh, &fluid, &Physics::default(), &scheme, &start)?.model)
}
