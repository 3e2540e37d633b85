//! A shear wave in a periodic box decays as the Navier-Stokes equations have it.

use std::f64::consts::{PI, TAU};

use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation};
use finegrain_sph::{
    Fluid, Packing, Physics, Scheme, SmoothingFunction, Sph, Start, StateEquation, Viscosity,
};

const VISCOSITY: f64 = 0.1;
/// Slow, so that the wave does not carry particles far in its life: the flow stays along x.
const SPEED: f64 = 0.01;

/// Rate of decay of the velocity, `v_x = U sin(2 pi y)`, over the exact one, `(2 pi)^2 nu`.
fn decay_rate(viscosity: Viscosity, cells: f64, scheme: &Scheme) -> f64 {
    let spacing = 1.0 / cells;
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
    let sph = Sph::<f64>::new(&start, &fluid, &physics, scheme).unwrap();
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
    // The kernel's width and eta^2 = 0.01 h^2 each take off a percent or so. The kernel is wide for
    // the form of Monaghan, see below.
    let scheme = Scheme { smoothing_ratio: 2.0, ..Scheme::default() };
    for viscosity in [Viscosity::Morris, Viscosity::Monaghan, Viscosity::Adami] {
        let rate = decay_rate(viscosity, 48.0, &scheme);
        assert!((rate - 1.0).abs() < 0.03, "{viscosity:?}: {rate}");
    }
}

/// `8 sum_j V_j F_ij x^2 (1 - cos(k y)) / (r^2 + eta^2) / k^2` over a square lattice of spacing 1: what
/// the form of Monaghan makes of a shear wave of `cells` points, with Wendland's C2 kernel in the
/// plane, `7 / (4 pi h^2) (1 - q/2)^4 (1 + 2 q)`.
fn monaghan_on_a_lattice(cells: f64, h: f64) -> f64 {
    let (k, reach) = (TAU / cells, (2.0 * h) as i32);
    let mut sum = 0.0;
    for (x, y) in (-reach..=reach).flat_map(|x| (-reach..=reach).map(move |y| (x, y))) {
        let (x, y) = (f64::from(x), f64::from(y));
        let q = x.hypot(y) / h;
        if q < 2.0 {
            let factor = 35.0 / (4.0 * PI * h.powi(4)) * (1.0 - 0.5 * q).powi(3);
            sum += factor * x * x * (1.0 - (k * y).cos()) / (x * x + y * y + 0.01 * h * h);
        }
    }
    8.0 * sum / (k * k)
}

#[test]
fn the_form_of_monaghan_sees_the_lattice() {
    // Nearest neighbours straight along or across the shear count for nothing.
    let expected = monaghan_on_a_lattice(32.0, 1.6);
    assert!((expected - 0.9).abs() < 0.01, "{expected}");
    let kernel = SmoothingFunction::WendlandC2;
    let scheme = Scheme { kernel, smoothing_ratio: 1.6, ..Scheme::default() };
    let rate = decay_rate(Viscosity::Monaghan, 32.0, &scheme);
    assert!((rate / expected - 1.0).abs() < 2e-3, "{rate}, not {expected}");
}
