//! The same flow gives the same bits for any number of workers, schedule and hand-out order.

mod flow;
mod gas_box;

use finegrain_framework::shape::Shape;
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{HandOut, Real, Schedule, Settings, Simulation};
use finegrain_sph::{
    ArtificialViscosity, DensityDiffusion, DiffusionForm, Fluid, Pairs, Physics, Scheme,
    ShockCapturing, Slip, SmoothingFunction, Sph, Stabilisation, Start, StateEquation, Viscosity,
    WallPressure, WallVelocity,
};

fn hash<T: Real>(mut simulation: Simulation<Cells<T>>) -> u64 {
    // Several paces, so that particles are sorted anew more than once.
    simulation.advance(30).unwrap();
    simulation.state_hash()
}

fn same_bits<T: Real>(dims: usize, viscosity: Viscosity, scheme: &Scheme) {
    same_bits_of::<T>(|settings| flow::flow::<T, T>(dims, viscosity, scheme, true, settings).0);
}

fn same_bits_of_gas<T: Real>(dims: usize) {
    same_bits_of::<T>(|settings| {
        let sph = gas_box::gas_box::<T>(dims, Some(ShockCapturing::default()));
        Simulation::new(sph.model, settings).unwrap()
    });
}

fn same_bits_of<T: Real>(start: impl Fn(Settings) -> Simulation<Cells<T>>) {
    let serial = Settings { schedule: Schedule::Serial, workers: 1, ..Settings::default() };
    let expected = hash(start(serial));
    for schedule in Schedule::ALL {
        for workers in [1, 2, 3, 8] {
            for hand_out in [HandOut::Natural, HandOut::Shuffled { seed: 3 }] {
                let settings = Settings { schedule, workers, hand_out, ..Settings::default() };
                assert_eq!(hash(start(settings.clone())), expected, "{settings:?}");
            }
        }
    }
}

#[test]
fn one_sweep_in_2d() {
    same_bits::<f64>(2, Viscosity::Monaghan, &Scheme::default());
}

#[test]
fn two_sweeps_in_2d() {
    same_bits::<f64>(2, Viscosity::StrainRate, &Scheme::default());
}

#[test]
fn two_sweeps_in_a_thin_3d_box() {
    same_bits::<f64>(3, Viscosity::StrainRate, &Scheme::default());
}

#[test]
fn single_precision() {
    same_bits::<f32>(3, Viscosity::Morris, &Scheme::default());
}

#[test]
fn mixed_precision() {
    let scheme = flow::edac();
    same_bits_of::<f64>(|settings| {
        flow::flow::<f32, f64>(2, Viscosity::Adami, &scheme, true, settings).0
    });
}

#[test]
fn three_sweeps_with_pressure_transport_and_walls_from_the_fluid() {
    same_bits::<f64>(2, Viscosity::Adami, &flow::edac());
}

/// Lists of neighbours hold what a search finds, in the same order.
#[test]
fn sweeps_that_look_neighbours_up_or_search_for_them() {
    let [kept, searched] = [Pairs::Kept, Pairs::Searched].map(|pairs| {
        let settings = || Settings { workers: 2, ..Settings::default() };
        let paper = Scheme { pairs, ..Scheme::default() };
        let fitted = Scheme { wall_velocity: WallVelocity::Fitted, pairs, ..flow::edac() };
        let (strain, adami) = (Viscosity::StrainRate, Viscosity::Adami);
        [
            hash(flow::flow::<f64, f64>(3, strain, &paper, true, settings()).0),
            hash(flow::flow::<f32, f32>(2, strain, &paper, false, settings()).0),
            hash(flow::flow::<f32, f64>(2, adami, &fitted, true, settings()).0),
        ]
    });
    assert_eq!(kept, searched);
}

#[test]
fn gas_in_1d_and_2d() {
    same_bits_of_gas::<f64>(1);
    same_bits_of_gas::<f64>(2);
}

#[test]
fn gas_in_3d_and_single_precision() {
    same_bits_of_gas::<f32>(3);
}

/// Water that falls over in a corner, with everything against noise and clumping.
fn splash(settings: Settings) -> Simulation<Cells<f64>> {
    let spacing = 0.05;
    let at = |i: i32| (f64::from(i) + 0.5) * spacing;
    let positions: Vec<_> = (-3..10)
        .flat_map(|j| (-3..20).map(move |i| (i, j)))
        .filter(|&(i, j)| i < 0 || j < 0 || i < 8)
        .map(|(i, j)| [at(i), at(j), 0.0])
        .collect();
    let start = Start {
        region: Region { lower: vec![-0.2; 2], upper: vec![1.0; 2], periodic: vec![false; 2] },
        spacing,
        particle_volume: spacing * spacing,
        positions,
        velocities: Vec::new(),
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 30.0,
        kinematic_viscosity: 0.0,
        state_equation: StateEquation::Tait { exponent: 7.0, background: 0.0 },
    };
    let wall = |outward| Shape::HalfSpace { point: [0.0; 3], outward }.into();
    let physics = Physics {
        body_acceleration: [0.0, -9.81, 0.0],
        bodies: vec![wall([1.0, 0.0, 0.0]), wall([0.0, 1.0, 0.0])],
        slip: Slip::Free,
        ..Physics::default()
    };
    let scheme = Scheme {
        kernel: SmoothingFunction::WendlandC2,
        smoothing_ratio: 1.5,
        wall_pressure: WallPressure::Extrapolated,
        stabilisation: Stabilisation {
            artificial_viscosity: Some(ArtificialViscosity { alpha: 0.1, beta: 0.1 }),
            density_diffusion: Some(DensityDiffusion { form: DiffusionForm::Antuono, delta: 0.1 }),
            artificial_pressure: Some(0.2),
            tensile_control: true,
            shifting: Some(3.0),
            repulsion: Some(9.0),
        },
        ..Scheme::default()
    };
    let sph = Sph::<f64>::new(&start, &fluid, &physics, &scheme).unwrap();
    Simulation::new(sph.model, settings).unwrap()
}

#[test]
fn a_free_surface_with_everything_against_noise() {
    same_bits_of(splash);
}
