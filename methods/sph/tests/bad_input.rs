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
fn a_particle_that_is_nowhere() {
    let mut start = start();
    start.positions[7][1] = f64::NAN;
    let said = begun(&start, |_| {}).unwrap_err();
    assert!(said.contains("particle at place 7") && said.contains("direction 1"), "{said}");
}

/// What comes of beginning with the default physics, with fields that a scene sets as it likes.
fn begun(start: &Start, set: impl Fn(&mut Sph<f64>)) -> Result<(), String> {
    let mut sph = Sph::<f64>::new(start, &FLUID, &Physics::default(), &Scheme::default()).unwrap();
    set(&mut sph);
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    simulation.begin().map_err(|error| error.to_string())
}

#[test]
fn fields_that_are_no_numbers_at_the_start() {
    let mut start = start();
    start.velocities = vec![[0.0; 3]; start.positions.len()];
    assert_eq!(begun(&start, |_| {}), Ok(()));
    for (rho, words) in [
        (f64::NAN, "particle 5 starts with density = NaN; it must be finite and above zero"),
        (0.0, "particle 5 starts with density = 0;"),
    ] {
        let said = begun(&start, |sph| sph.model.columns.values_mut(sph.fields.density)[5] = rho);
        assert!(said.clone().unwrap_err().contains(words), "{said:?}");
    }
    start.velocities[3][0] = f64::INFINITY;
    let said = begun(&start, |_| {}).unwrap_err();
    assert!(said.contains("particle 3 starts with velocity_x = inf; it must be finite"), "{said}");
}

#[test]
fn particles_at_one_place() {
    let said = |start: &Start| complaint(start, &FLUID, &Physics::default(), &Scheme::default());
    let mut start = start();
    start.positions[42] = start.positions[17];
    let coincident = said(&start);
    assert!(coincident.contains("particles 17 and 42 are 0.000e0 m apart"), "{coincident}");
    assert!(coincident.contains(&format!("{:?}", start.positions[17])), "{coincident}");
    // Across the period: 17 is at x = 0.75, y = 0.15.
    start.positions[17] = [2e-5, 0.5, 0.0];
    start.positions[42] = [1.0 - 3e-5, 0.5, 0.0];
    let across = said(&start);
    assert!(across.contains("particles 17 and 42 are 5.000e-5 m apart"), "{across}");
    // Near, but not too near.
    start.positions[42] = [1.0 - 2e-4, 0.5, 0.0];
    assert!(Sph::<f64>::new(&start, &FLUID, &Physics::default(), &Scheme::default()).is_ok());
}

#[test]
fn a_kernel_that_reaches_around_the_box_more_than_twice() {
    let said = |smoothing_ratio| {
        let scheme = Scheme { smoothing_ratio, ..Scheme::default() };
        Sph::<f64>::new(&start(), &FLUID, &Physics::default(), &scheme).err().map(|e| e.to_string())
    };
    // The support is some three smoothing lengths, of a tenth of the box each.
    assert_eq!(said(5.0), None);
    let far = said(10.0).unwrap();
    assert!(far.contains("twice the period of 1.000e0 m in direction 0"), "{far}");
}

/// A floor of `layers` of particles below y = 0 and fluid above, in a box that is periodic in x, with
/// the particles of the floor for which `is_missing` left out.
fn floor(layers: i32, is_missing: impl Fn([f64; 3]) -> bool) -> Start {
    let at = |i: i32| (f64::from(i) + 0.5) * 0.1;
    let all = (-layers..6).flat_map(|j| (0..20).map(move |i| [at(i), at(j), 0.0]));
    let region =
        Region { lower: vec![0.0, -2.0], upper: vec![2.0; 2], periodic: vec![true, false] };
    Start { region, positions: all.filter(|&x| x[1] > 0.0 || !is_missing(x)).collect(), ..start() }
}

#[test]
fn walls_with_gaps() {
    let ground = Shape::HalfSpace { point: [0.0; 3], outward: [0.0, 1.0, 0.0] };
    let said = |start: &Start, shape: Shape| {
        let physics = Physics { bodies: vec![shape.into()], ..Physics::default() };
        // Sees 0.33 m far.
        Sph::<f64>::new(start, &FLUID, &physics, &Scheme::default()).err().map(|e| e.to_string())
    };
    assert_eq!(said(&floor(4, |_| false), ground), None);
    let empty = said(&floor(0, |_| false), ground).unwrap();
    assert!(empty.contains("body 0: no particle fills it"), "{empty}");
    // Too few layers of particles.
    let shallow = said(&floor(1, |_| false), ground).unwrap();
    assert!(shallow.contains("body 0: there is a gap at [0.05, -0.2"), "{shallow}");
    // A hole right under the surface.
    let hole = |[x, y, _]: [f64; 3]| (x - 1.05).abs() < 0.16 && y > -0.21;
    let pitted = said(&floor(4, hole), ground).unwrap();
    assert!(pitted.contains("body 0: there is a gap at [1.05"), "{pitted}");
    // A plate thinner than the fluid above sees.
    let plate = Shape::Cuboid {
        low: [f64::NEG_INFINITY, -0.1, f64::NEG_INFINITY],
        high: [f64::INFINITY, 0.0, f64::INFINITY],
    };
    let thin = said(&floor(1, |_| false), plate).unwrap();
    assert!(thin.contains("body 0: it is too thin at [0.05, -0.2"), "{thin}");
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

/// By the number that dumps show, not by its place after sorting.
#[test]
fn a_particle_without_density_is_named_by_its_identity() {
    let mut start = start();
    start.positions.reverse();
    let sph = Sph::<f64>::new(&start, &FLUID, &Physics::default(), &Scheme::default()).unwrap();
    let settings = Settings { workers: 1, ..Settings::default() };
    let (fields, mut simulation) = (sph.fields, Simulation::new(sph.model, settings).unwrap());
    simulation.begin().unwrap();
    let identity = simulation.columns().values(fields.identity);
    let place = identity.iter().zip(0..).position(|(&identity, i)| identity != i).unwrap();
    let expected = format!("particle {} has density", identity[place]);
    simulation.whole().columns.values_mut(fields.density)[place] = -3.0;
    let said = simulation.advance(1).unwrap_err().to_string();
    assert!(said.contains(&expected), "{expected}: {said}");
}
