//! A shear wave in a periodic box decays as the Navier-Stokes equations have it.

use std::f64::consts::TAU;

use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation};
use finegrain_sph::{Fluid, Packing, Physics, Scheme, Sph, Start, StateEquation, Viscosity};

const VISCOSITY: f64 = 0.1;
/// Slow, so that the wave does not carry particles far in its life: the flow stays along x.
const SPEED: f64 = 0.01;
const CELLS: f64 = 48.0;

/// Rate of decay of the velocity, `v_x = U sin(2 pi y)`, over the exact one, `(2 pi)^2 nu`.
fn decay_rate(viscosity: Viscosity) -> f64 {
    let spacing = 1.0 / CELLS;
    let lattice = Packing::Square.fit([1.0, 8.0 * spacing, 0.0], spacing).unwrap();
    // Along x a few spacings are enough.
    let positions: Vec<_> = lattice.positions().map(|[x, y, z]| [y, x, z]).collect();
    let lengths = lattice.lengths();
    let start = Start {
        region: Region {
            lower: vec![0.0; 2],
            upper: vec![lengths[1], lengths[0]],
            periodic: vec![true; 2],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        velocities: positions.iter().map(|x| [SPEED * (TAU * x[1]).sin(), 0.0, 0.0]).collect(),
        positions,
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 1.0,
        kinematic_viscosity: VISCOSITY,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let physics = Physics { viscosity: Some(viscosity), ..Physics::default() };
    // The form of Monaghan sees the lattice: nearest neighbours along and across the shear count for
    // nothing. With a wide kernel that is a small part of the sums.
    let scheme = Scheme { smoothing_ratio: 2.0, ..Scheme::default() };
    let sph = Sph::<f64>::new(&start, &fluid, &physics, &scheme).unwrap();
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    let amplitude = |simulation: &Simulation<_>| {
        let columns = simulation.columns();
        let y = columns.values(sph.fields.position[1]).iter();
        let v = columns.values(sph.fields.velocity[0]);
        2.0 * y.zip(v).map(|(y, v)| v * (TAU * y).sin()).sum::<f64>() / v.len() as f64
    };
    simulation.begin().unwrap();
    let first = amplitude(&simulation);
    simulation.advance(150).unwrap();
    let (last, time) = (amplitude(&simulation), simulation.clock().time());
    (first / last).ln() / time / (TAU * TAU * VISCOSITY)
}

#[test]
fn the_rate_is_that_of_the_viscosity() {
    // The kernel's width and eta^2 = 0.01 h^2 each take off a percent or so.
    for viscosity in [Viscosity::Morris, Viscosity::Monaghan, Viscosity::Adami] {
        let rate = decay_rate(viscosity);
        assert!((rate - 1.0).abs() < 0.03, "{viscosity:?}: {rate}");
    }
}
