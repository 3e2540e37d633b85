//! What physics costs that a scene names, and that what it does not name costs nothing: bytes a
//! particle in all columns, and instructions a particle and step as `valgrind --tool=cachegrind`
//! counts them.
//!
//! A box of 2-D fluid, with and without each piece. Instructions are the difference between a run of
//! a few and of more steps, so that set-up does not count. Valgrind knows no AVX-512: what is counted
//! is the code for AVX2.

use std::env;
use std::process::Command;

use finegrain::framework::shape::Shape;
use finegrain::framework::space::cells::Region;
use finegrain::framework::{Schedule, Settings, Simulation};
use finegrain::sph::{
    DensityDiffusion, DiffusionForm, Fluid, Packing, Physics, Scheme, Sph, Stabilisation, Start,
    StateEquation, Viscosity, WallPressure, WallVelocity,
};

/// Numbers of steps whose instructions are compared.
const STEPS: [u64; 2] = [2, 12];

type Error = Box<dyn std::error::Error>;

/// A name, and what is modelled under it.
fn cases() -> Vec<(&'static str, Physics, Scheme)> {
    let plain = Physics::default;
    let viscous = |form| Physics { viscosity: Some(form), ..plain() };
    let sphere = Shape::Sphere { centre: [0.5, 0.5, 0.0], radius: 0.2 };
    let walls = Physics { bodies: vec![sphere.into()], ..plain() };
    let stabilised = |stabilisation| Scheme { stabilisation, ..Scheme::default() };
    let scheme = Scheme::default;
    vec![
        ("mass and pressure", plain(), scheme()),
        ("with energy", Physics { energy: true, ..plain() }, scheme()),
        ("with viscosity (Morris)", viscous(Viscosity::Morris), scheme()),
        ("with viscosity (strain rate)", viscous(Viscosity::StrainRate), scheme()),
        (
            "with density diffusion",
            plain(),
            stabilised(Stabilisation {
                density_diffusion: Some(DensityDiffusion {
                    form: DiffusionForm::Antuono,
                    delta: 0.1,
                }),
                ..Stabilisation::default()
            }),
        ),
        (
            "with shifting",
            plain(),
            stabilised(Stabilisation { shifting: Some(1.0), ..Stabilisation::default() }),
        ),
        ("with virtual walls", walls.clone(), scheme()),
        (
            "with walls of Adami et al.",
            Physics { viscosity: Some(Viscosity::Morris), ..walls.clone() },
            Scheme {
                wall_pressure: WallPressure::Extrapolated,
                wall_velocity: WallVelocity::Mirrored,
                ..scheme()
            },
        ),
        (
            "and the forces on them",
            Physics { viscosity: Some(Viscosity::Morris), forces_on_bodies: true, ..walls },
            Scheme {
                wall_pressure: WallPressure::Extrapolated,
                wall_velocity: WallVelocity::Mirrored,
                ..scheme()
            },
        ),
    ]
}

fn build(physics: &Physics, scheme: &Scheme) -> Result<Sph<f64>, Error> {
    let lattice = Packing::Square.fit([1.0; 3], 0.02)?;
    let positions: Vec<_> = lattice.displaced_positions(0.1, 1).collect();
    let wave = |x: f64| (std::f64::consts::TAU * x).sin();
    let start = Start {
        region: Region { lower: vec![0.0; 2], upper: vec![1.0; 2], periodic: vec![true; 2] },
        spacing: 0.02,
        particle_volume: lattice.volume_per_particle(),
        velocities: positions.iter().map(|x| [wave(x[1]), wave(x[0]), 0.0]).collect(),
        positions,
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 10.0,
        kinematic_viscosity: 0.01,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    Ok(Sph::new(&start, &fluid, physics, scheme)?)
}

/// Runs one case for some steps: what is counted.
fn run(case: usize, steps: u64) -> Result<(), Error> {
    let (_, physics, scheme) = &cases()[case];
    let settings = Settings { schedule: Schedule::Serial, workers: 1, ..Settings::default() };
    Simulation::new(build(physics, scheme)?.model, settings)?.advance(steps)?;
    Ok(())
}

/// Instructions of a run of one case; `None` where valgrind is not installed.
fn instructions(case: usize, steps: u64) -> Result<Option<f64>, Error> {
    let output = Command::new("valgrind")
        .args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"])
        .arg(env::current_exe()?)
        .args([case.to_string(), steps.to_string()])
        .output();
    let Ok(output) = output else { return Ok(None) };
    let said = String::from_utf8_lossy(&output.stderr);
    let count = said
        .lines()
        .find_map(|line| line.split_once("refs:"))
        .ok_or_else(|| format!("valgrind counted nothing: {said}"))?;
    Ok(Some(count.1.trim().replace(',', "").parse()?))
}

fn main() -> Result<(), Error> {
    let arguments: Vec<u64> = env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    if let [case, steps] = arguments[..] {
        return run(case as usize, steps);
    }
    println!("{:<30} {:>14} {:>28}", "", "bytes/particle", "instructions/particle/step");
    for (case, (name, physics, scheme)) in cases().iter().enumerate() {
        let columns = build(physics, scheme)?.model.columns;
        let bytes: usize = columns.iter().map(|(_, column)| column.kind().size()).sum();
        let [few, more] = STEPS.map(|steps| instructions(case, steps));
        let steps = (columns.points() as u64 * (STEPS[1] - STEPS[0])) as f64;
        let count = match (few?, more?) {
            (Some(few), Some(more)) => format!("{:.0}", (more - few) / steps),
            _ => "valgrind is not installed".to_owned(),
        };
        println!("{name:<30} {bytes:>14} {count:>28}");
    }
    Ok(())
}
