//! What the fluid sees in bodies: pressure and velocity continued as Adami, Hu & Adams (2012) do,
//! against closed forms, and friction that is there or not.

use finegrain_framework::shape::Shape;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation, space::Cells};
use finegrain_sph::{
    Body, Fields, Fluid, Packing, Physics, Scheme, Slip, SmoothingFunction, Sph, Start,
    StateEquation, Viscosity, WallPressure, WallVelocity,
};

const SPACING: f64 = 0.05;
const GRAVITY: f64 = 2.0;
const DENSITY: f64 = 3.0;
const SOUND_SPEED: f64 = 20.0;
/// Walls as Adami et al. have them.
fn adami() -> Scheme {
    Scheme {
        kernel: SmoothingFunction::QuinticSpline,
        wall_pressure: WallPressure::Extrapolated,
        wall_velocity: WallVelocity::Mirrored,
        ..Scheme::default()
    }
}

/// Fluid of the given density between y = 0.2 and 0.8, moving along x at `speed`, in a box that is
/// periodic in x, with a body below that may slide and one above.
fn begun(
    physics: Physics,
    scheme: &Scheme,
    surface_velocity: [f64; 3],
    speed: impl Fn(f64) -> f64,
    density: impl Fn(f64) -> f64,
) -> (Simulation<Cells<f64>>, Fields<f64>) {
    let lattice = Packing::Square.fit([1.0; 3], SPACING).unwrap();
    let positions: Vec<_> = lattice.positions().collect();
    let start = Start {
        region: Region { lower: vec![0.0; 2], upper: vec![1.0; 2], periodic: vec![true, false] },
        spacing: SPACING,
        particle_volume: lattice.volume_per_particle(),
        velocities: positions.iter().map(|x| [speed(x[1]), 0.0, 0.0]).collect(),
        positions: positions.clone(),
    };
    let fluid = Fluid {
        density: DENSITY,
        sound_speed: SOUND_SPEED,
        kinematic_viscosity: 0.1,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let half_space =
        |y: f64, up: f64| Shape::HalfSpace { point: [0.0, y, 0.0], outward: [0.0, up, 0.0] };
    let below = Body { shape: half_space(0.2, 1.0), surface_velocity };
    let physics = Physics { bodies: vec![below, half_space(0.8, -1.0).into()], ..physics };
    let mut sph = Sph::<f64>::new(&start, &fluid, &physics, scheme).unwrap();
    for (rho, x) in sph.model.columns.values_mut(sph.fields.density).iter_mut().zip(&positions) {
        *rho = density(x[1]);
    }
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    simulation.begin().unwrap();
    (simulation, sph.fields)
}

/// Pairs of height and whatever `value` makes of a particle, for those in bodies or in the fluid
/// that are within the kernel's reach of the surface.
fn near_surface(
    simulation: &Simulation<Cells<f64>>,
    fields: &Fields<f64>,
    in_bodies: bool,
    value: impl Fn(usize) -> f64,
) -> Vec<(f64, f64)> {
    let columns = simulation.columns();
    let depth = columns.values(fields.wall_depth.unwrap());
    let height = columns.values(fields.position[1]);
    (0..columns.points())
        .filter(|&i| (depth[i] > 0.0) == in_bodies && depth[i] < 2.0 * SPACING)
        .map(|i| (height[i], value(i)))
        .collect()
}

#[test]
fn pressure_at_rest_goes_on_into_bodies_as_it_is_in_the_fluid() {
    let physics = || Physics { body_acceleration: [0.0, -GRAVITY, 0.0], ..Physics::default() };
    // Compressible by a part in a thousand: what eq. 27 takes for the weight of the fluid varies.
    let pressure = |y: f64| DENSITY * GRAVITY * (0.8 - y);
    let density = |y: f64| DENSITY + pressure(y) / SOUND_SPEED.powi(2);
    let (simulation, fields) = begun(physics(), &adami(), [0.0; 3], |_| 0.0, density);
    let columns = simulation.columns();
    let extrapolated = columns.values(fields.wall_pressure.unwrap());
    let seen = near_surface(&simulation, &fields, true, |i| extrapolated[i]);
    assert_eq!(seen.len(), 80);
    for (y, p) in seen {
        let error = (p - pressure(y)).abs() / pressure(0.2);
        assert!(error < 2e-3, "pressure {p} at {y}, not {}", pressure(y));
    }
    // And the density with it.
    let density_of = columns.values(fields.density);
    for (y, rho) in near_surface(&simulation, &fields, true, |i| density_of[i]) {
        assert!((rho - density(y)).abs() < 2e-3 * (density(0.2) - DENSITY), "{rho} at {y}");
    }
    // So the fluid stays at rest.
    let up = columns.values(fields.acceleration[1]);
    for (y, a) in near_surface(&simulation, &fields, false, |i| up[i]) {
        assert!(a.abs() < 0.01 * GRAVITY, "acceleration {a} at {y}");
    }
}

#[test]
fn velocity_is_mirrored_about_that_of_the_surface() {
    let physics = || Physics { viscosity: Some(Viscosity::Morris), ..Physics::default() };
    let (simulation, fields) = begun(physics(), &adami(), [0.5, 0.0, 0.0], |_| 0.3, |_| DENSITY);
    let mirrored = simulation.columns().values(fields.mirrored_velocity[0]);
    for (y, v) in near_surface(&simulation, &fields, true, |i| mirrored[i]) {
        let expected = if y < 0.5 { 2.0 * 0.5 - 0.3 } else { -0.3 };
        assert!((v - expected).abs() < 1e-12, "{v} at {y}");
    }
}

#[test]
fn a_fitted_profile_continues_the_shear_whatever_the_distance_to_the_surface() {
    let physics = || Physics { viscosity: Some(Viscosity::Morris), ..Physics::default() };
    let scheme = Scheme { wall_velocity: WallVelocity::Fitted, ..adami() };
    let shear = |y: f64| 0.5 + 2.0 * (y - 0.2);
    let (simulation, fields) = begun(physics(), &scheme, [0.5, 0.0, 0.0], shear, |_| DENSITY);
    let fitted = simulation.columns().values(fields.mirrored_velocity[0]);
    let seen = near_surface(&simulation, &fields, true, |i| fitted[i]);
    let below: Vec<_> = seen.into_iter().filter(|(y, _)| *y < 0.5).collect();
    assert_eq!(below.len(), 40);
    for (y, v) in below {
        assert!((v - shear(y)).abs() < 1e-12, "{v} at {y}");
    }
}

/// Acceleration along x of the particles next to the surfaces below and above, in the shear
/// `v = 1 + (y - 0.2)`.
fn drag(physics: Physics, scheme: &Scheme, surface_velocity: f64) -> [f64; 2] {
    let surface_velocity = [surface_velocity, 0.0, 0.0];
    let (simulation, fields) =
        begun(physics, scheme, surface_velocity, |y| 1.0 + (y - 0.2), |_| DENSITY);
    let along = simulation.columns().values(fields.acceleration[0]);
    let seen = near_surface(&simulation, &fields, false, |i| along[i]);
    let at = |y: f64| seen.iter().find(|(at, _)| (at - y).abs() < 0.1 * SPACING).unwrap().1;
    [at(0.2 + 0.5 * SPACING), at(0.8 - 0.5 * SPACING)]
}

#[test]
fn a_surface_that_moves_with_the_shear_has_no_drag() {
    for viscosity in [Viscosity::Morris, Viscosity::StrainRate, Viscosity::Monaghan] {
        let physics = || Physics { viscosity: Some(viscosity), ..Physics::default() };
        let linear = Scheme { wall_velocity: WallVelocity::Linear, ..adami() };
        let at_rest = drag(physics(), &linear, 0.0)[0];
        assert!(at_rest < -1.0, "{viscosity:?}: {at_rest}");
        // The linear profile goes on through the surface.
        let along = drag(physics(), &linear, 1.0)[0];
        assert!(along.abs() < 0.03 * at_rest.abs(), "{viscosity:?}: {along} of {at_rest}");
        // Mirrored about a mean over the fluid: no profile exactly, but most of the drag is gone.
        let at_rest = drag(physics(), &adami(), 0.0)[0];
        let along = drag(physics(), &adami(), 1.0)[0];
        assert!(along.abs() < 0.1 * at_rest.abs(), "{viscosity:?}: {along} of {at_rest}");
    }
}

#[test]
fn there_is_no_drag_where_the_fluid_slips() {
    for viscosity in [Viscosity::Morris, Viscosity::StrainRate, Viscosity::Monaghan] {
        for scheme in [adami(), Scheme { wall_velocity: WallVelocity::Linear, ..adami() }] {
            let physics =
                || Physics { viscosity: Some(viscosity), slip: Slip::Free, ..Physics::default() };
            let (simulation, fields) =
                begun(physics(), &scheme, [5.0, 0.0, 0.0], |_| 1.0, |_| DENSITY);
            for &a in simulation.columns().values(fields.acceleration[0]) {
                assert!(a.abs() < 1e-10, "{viscosity:?}: acceleration {a}");
            }
        }
    }
}
