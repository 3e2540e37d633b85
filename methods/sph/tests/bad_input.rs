//! Bad input gets an error that names what and where, and never a panic.

use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation};
use finegrain_sph::{
    ArtificialViscosity, Body, Density, DensityDiffusion, DiffusionForm, Edac, Fluid, Gradient,
    Packing, Physics, PressureForm, Scheme, ShockCapturing, Smoothing, Sph, Stabilisation, Start,
    StateEquation, Viscosity,
};

fn start() -> Start {
    let lattice = Packing::Square.fit([1.0; 3], 0.1).unwrap();
    Start {
        region: Region { lower: vec![0.0; 2], upper: vec![1.0; 2], periodic: vec![true; 2] },
        spacing: 0.1,
        particle_volume: lattice.volume_per_particle(),
        positions: lattice.positions().collect(),
        velocities: Vec::new(),
    }
}

const FLUID: Fluid = Fluid {
    density: 1.0,
    sound_speed: 10.0,
    kinematic_viscosity: 0.1,
    state_equation: StateEquation::Linear { background: 0.0 },
};

fn complaint(start: &Start, fluid: &Fluid, physics: &Physics, scheme: &Scheme) -> String {
    match Sph::<f64>::new(start, fluid, physics, scheme) {
        Ok(_) => panic!("must be refused"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn numbers_outside_their_range() {
    let (physics, scheme) = (Physics::default(), Scheme::default());
    let of_fluid = |fluid: Fluid| complaint(&start(), &fluid, &physics, &scheme);
    assert!(of_fluid(Fluid { density: 0.0, ..FLUID }).contains("density is 0"));
    assert!(of_fluid(Fluid { sound_speed: -1.0, ..FLUID }).contains("sound_speed is -1"));
    assert!(
        of_fluid(Fluid { kinematic_viscosity: f64::NAN, ..FLUID }).contains("kinematic_viscosity")
    );
    let of_scheme = |scheme: Scheme| complaint(&start(), &FLUID, &physics, &scheme);
    assert!(of_scheme(Scheme { skin: 0.0, ..scheme }).contains("skin is 0"));
    assert!(of_scheme(Scheme { transport: -1.0, ..scheme }).contains("transport is -1"));
    let said = of_scheme(Scheme { transport: 1.0, ..scheme });
    assert!(said.contains("transport above 0 goes only with density = summation"), "{said}");
    let plain = Scheme { gradient: Gradient::Corrected, density: Density::Summation, ..scheme };
    assert!(of_scheme(plain).contains("gradient = corrected goes only with"));
    let stabilisation = Stabilisation { tensile_control: true, ..Stabilisation::NONE };
    let pressure_form = PressureForm::Antisymmetric;
    let said = of_scheme(Scheme { stabilisation, pressure_form, ..scheme });
    assert!(said.contains("tensile control goes only with pressure_form"), "{said}");
    let edac = Some(Edac { diffusion: f64::NAN });
    assert!(of_scheme(Scheme { edac, ..scheme }).contains("edac.diffusion is NaN"));
    let edac = Some(Edac { diffusion: 0.5 });
    assert!(of_scheme(Scheme { edac, ..scheme }).contains("edac goes only with pressure_form"));
    assert!(of_scheme(Scheme { courant_number: 0.0, ..scheme }).contains("courant_number"));
    let of_start = |start: Start| complaint(&start, &FLUID, &physics, &scheme);
    assert!(of_start(Start { spacing: -0.1, ..start() }).contains("spacing is -0.1"));
    assert!(of_start(Start { positions: Vec::new(), ..start() }).contains("0 particles"));
    assert!(of_start(Start { velocities: vec![[0.0; 3]], ..start() }).contains("1 velocities"));
}

#[test]
fn stabilisation_outside_its_range() {
    let of = |stabilisation: Stabilisation| {
        let scheme = Scheme { stabilisation, ..Scheme::default() };
        complaint(&start(), &FLUID, &Physics::default(), &scheme)
    };
    let none = Stabilisation::default();
    let viscosity = |alpha, beta| Some(ArtificialViscosity { alpha, beta });
    let diffusion = |delta| Some(DensityDiffusion { form: DiffusionForm::Antuono, delta });
    for (stabilisation, name) in [
        (Stabilisation { artificial_viscosity: viscosity(-0.1, 0.0), ..none }, "alpha is -0.1"),
        (Stabilisation { artificial_viscosity: viscosity(0.0, f64::NAN), ..none }, "beta is NaN"),
        (Stabilisation { density_diffusion: diffusion(-1.0), ..none }, "delta is -1"),
        (Stabilisation { artificial_pressure: Some(-0.2), ..none }, "artificial pressure is -0.2"),
        (Stabilisation { shifting: Some(0.0), ..none }, "speed of shifting is 0"),
        (Stabilisation { repulsion: Some(f64::INFINITY), ..none }, "repulsion is inf"),
    ] {
        let said = of(stabilisation);
        assert!(said.contains(name), "{said}");
    }
}

#[test]
fn a_body_that_makes_no_sense() {
    let body = Shape::Cylinder { axis: Axis::Z, centre: [0.5; 3], radius: -0.1 };
    let physics = Physics { bodies: vec![body.into()], ..Physics::default() };
    let said = complaint(&start(), &FLUID, &physics, &Scheme::default());
    assert!(said.contains("body 0"), "{said}");
    let shape = Shape::Sphere { centre: [0.5; 3], radius: 0.1 };
    let body = Body { shape, surface_velocity: [0.0, f64::INFINITY, 0.0] };
    let physics = Physics { bodies: vec![body], ..Physics::default() };
    let said = complaint(&start(), &FLUID, &physics, &Scheme::default());
    assert!(said.contains("surface_velocity is inf"), "{said}");
}

#[test]
fn a_box_inside_out() {
    let region = Region { lower: vec![1.0, 0.0], upper: vec![0.0, 1.0], periodic: vec![true; 2] };
    let start = Start { region, ..start() };
    let said = complaint(&start, &FLUID, &Physics::default(), &Scheme::default());
    assert!(said.contains("box from 1 to 0 in direction 0"), "{said}");
}

#[test]
fn a_particle_that_is_nowhere_and_one_that_moves_at_no_speed() {
    let mut start = start();
    start.positions[7][1] = f64::NAN;
    let (physics, scheme) = (Physics::default(), Scheme::default());
    let begin = |start: &Start| {
        let sph = Sph::<f64>::new(start, &FLUID, &physics, &scheme).unwrap();
        let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
        simulation.begin().unwrap_err().to_string()
    };
    let said = begin(&start);
    assert!(said.contains("particle 7") && said.contains("direction 1"), "{said}");
    start.positions[7][1] = 0.05;
    start.velocities = vec![[0.0; 3]; start.positions.len()];
    start.velocities[3][0] = f64::INFINITY;
    let said = begin(&start);
    assert!(said.contains("largest speed inf"), "{said}");
}

#[test]
fn choices_that_do_not_make_a_gas() {
    let gas = Fluid { state_equation: StateEquation::IdealGas { heat_ratio: 1.4 }, ..FLUID };
    let physics = Physics { energy: true, ..Physics::default() };
    let scheme = Scheme { smoothing: Smoothing::Adaptive { longest: 0.2 }, ..Scheme::default() };
    let said = |fluid: &Fluid, physics: &Physics, scheme: &Scheme, word: &str| {
        let said = complaint(&start(), fluid, physics, scheme);
        assert!(said.contains(word), "{said}");
    };
    assert!(Sph::<f64>::new(&start(), &gas, &physics, &scheme).is_ok());
    said(&FLUID, &physics, &scheme, "goes only with an ideal gas");
    said(
        &gas,
        &physics,
        &Scheme::default(),
        "goes only with a smoothing length that follows the density",
    );
    said(&gas, &Physics::default(), &scheme, "goes only with the energy equation");
    let corrected = Scheme { gradient: Gradient::Corrected, ..scheme };
    said(&gas, &physics, &corrected, "goes only with gradient = kernel");
    let viscous = Physics { viscosity: Some(Viscosity::Morris), ..physics.clone() };
    said(&gas, &viscous, &scheme, "goes only with no laminar viscosity");
    let shocks = ShockCapturing { viscosity: -1.0, ..ShockCapturing::default() };
    let shocked = Physics { shock_capturing: Some(shocks), ..physics.clone() };
    said(&gas, &shocked, &scheme, "shock viscosity is -1");
    said(&FLUID, &shocked, &Scheme::default(), "shock capturing goes only with an ideal gas");
    let cold = Fluid { state_equation: StateEquation::IdealGas { heat_ratio: 1.0 }, ..gas };
    said(&cold, &physics, &scheme, "heat_ratio is 1");
    let none = Scheme { smoothing: Smoothing::Adaptive { longest: 0.0 }, ..scheme };
    said(&gas, &physics, &none, "longest smoothing length is 0");
}
