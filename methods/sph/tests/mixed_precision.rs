//! Mixed precision: positions in `f64` and all else in `f32`. Far from the origin, where `f32` cannot
//! tell neighbours apart, it is as near to `f64` as `f32` is at the origin.

use std::f64::consts::TAU;

use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Settings, Simulation};
use finegrain_sph::{
    Density, Edac, Fluid, Packing, Physics, PressureForm, Scheme, Sph, Start, StateEquation,
    Viscosity,
};

const SPACING: f64 = 0.05;
const STEPS: u64 = 60;

/// Velocities, by identity, of vortices around a cylinder in a unit box with its lower corner at
/// `(far, far)`, after some steps.
fn velocities<T: Real, P: Real>(far: f64) -> Vec<[f64; 2]> {
    let lattice = Packing::Square.fit([1.0; 3], SPACING).unwrap();
    let near: Vec<_> = lattice.displaced_positions(0.2, 11).collect();
    let start = Start {
        region: Region { lower: vec![far; 2], upper: vec![far + 1.0; 2], periodic: vec![true; 2] },
        spacing: SPACING,
        particle_volume: lattice.volume_per_particle(),
        velocities: near.iter().map(|x| [(TAU * x[1]).sin(), (TAU * x[0]).sin(), 0.0]).collect(),
        positions: near.iter().map(|[x, y, z]| [far + x, far + y, *z]).collect(),
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 10.0,
        kinematic_viscosity: 0.02,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let centre = [far + 0.5, far + 0.5, 0.0];
    let cylinder = Shape::Cylinder { axis: Axis::Z, centre, radius: 0.2 };
    let physics = Physics {
        viscosity: Some(Viscosity::Adami),
        bodies: vec![cylinder.into()],
        ..Physics::default()
    };
    let scheme = Scheme {
        density: Density::Summation,
        edac: Some(Edac { diffusion: 0.5 }),
        pressure_form: PressureForm::DensityWeighted,
        transport: 1.0,
        ..Scheme::default()
    };
    let sph = Sph::<T, P>::new(&start, &fluid, &physics, &scheme).unwrap();
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    simulation.advance(STEPS).unwrap();
    let columns = simulation.columns();
    let mut velocities = vec![[0.0; 2]; columns.points()];
    for (i, &identity) in columns.values(sph.fields.identity).iter().enumerate() {
        velocities[identity as usize] =
            [0, 1].map(|a| columns.values(sph.fields.velocity[a])[i].as_f64());
    }
    velocities
}

/// Largest difference of two velocities, over that of the flow.
fn difference(a: &[[f64; 2]], b: &[[f64; 2]]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

#[test]
fn far_from_the_origin_it_is_as_good_as_single_precision_is_at_the_origin() {
    let exact = velocities::<f64, f64>(0.0);
    let round_off = difference(&velocities::<f32, f32>(0.0), &exact);
    assert!(round_off > 0.0 && round_off < 1e-3, "{round_off:e}");
    // 4096 times the box away, f32 knows positions to a hundredth of a spacing.
    let far = 4096.0;
    let single = difference(&velocities::<f32, f32>(far), &exact);
    let mixed = difference(&velocities::<f32, f64>(far), &exact);
    assert!(mixed < 2.0 * round_off, "{mixed:e}, single precision at the origin {round_off:e}");
    assert!(single > 30.0 * mixed, "{single:e} in single precision, {mixed:e} mixed");
}
