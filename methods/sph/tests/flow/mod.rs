//! A small periodic flow with everything in it, for tests of what must hold for any flow.

use finegrain_framework::shape::{Axis, Shape};
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Settings, Simulation, space::Cells};
use finegrain_sph::packing::Lattice;
use finegrain_sph::{
    Body, Density, Edac, Fields, Fluid, Packing, Physics, PressureForm, Scheme, SmoothingFunction,
    Sph, Start, StateEquation, Viscosity, WallPressure, WallVelocity,
};

/// Density as a sum, pressure that evolves by itself, transport velocity, and walls that take both
/// velocity and pressure from the fluid.
#[allow(dead_code)]
pub fn edac() -> Scheme {
    Scheme {
        kernel: SmoothingFunction::QuinticSpline,
        density: Density::Summation,
        edac: Some(Edac { diffusion: 0.5 }),
        pressure_form: PressureForm::DensityWeighted,
        transport: 2.0,
        wall_pressure: WallPressure::Extrapolated,
        wall_velocity: WallVelocity::Mirrored,
        ..Scheme::default()
    }
}

/// Vortices in a periodic box from a disturbed lattice, with or without a cylinder in it.
#[allow(dead_code)]
pub fn flow<T: Real, P: Real>(
    dims: usize,
    viscosity: Viscosity,
    scheme: &Scheme,
    has_body: bool,
    settings: Settings,
) -> (Simulation<Cells<P>>, Fields<T, P>, f64) {
    begun(sph(dims, viscosity, scheme, has_body), settings)
}

/// The same, not begun.
#[allow(dead_code)]
pub fn sph<T: Real, P: Real>(
    dims: usize,
    viscosity: Viscosity,
    scheme: &Scheme,
    has_body: bool,
) -> Sph<T, P> {
    let turns = scheme.wall_velocity != WallVelocity::Linear;
    let [x, y, _] = lattice(dims).0.lengths();
    let shape = Shape::Cylinder { axis: Axis::Z, centre: [0.5 * x, 0.5 * y, 0.0], radius: 0.2 };
    let body = Body { shape, surface_velocity: [if turns { 0.1 } else { 0.0 }, 0.0, 0.0] };
    let physics = Physics {
        viscosity: Some(viscosity),
        body_acceleration: if has_body { [0.3, 0.0, 0.0] } else { [0.0; 3] },
        bodies: if has_body { vec![body] } else { Vec::new() },
        forces_on_bodies: has_body && turns,
        ..Physics::default()
    };
    vortices(dims, &physics, scheme)
}

/// Its simulation, fields and the mass of a particle.
#[allow(dead_code)]
pub fn begun<T: Real, P: Real>(
    sph: Sph<T, P>,
    settings: Settings,
) -> (Simulation<Cells<P>>, Fields<T, P>, f64) {
    (Simulation::new(sph.model, settings).unwrap(), sph.fields, sph.particle_mass)
}

/// Undisturbed particles, and their spacing.
fn lattice(dims: usize) -> (Lattice, f64) {
    let (packing, box_sides, spacing) = if dims == 3 {
        // Thin: a support radius of 0.3 in a box 0.25 high.
        (Packing::HexagonalClosePacked, [1.0, 1.0, 0.25], 0.1)
    } else {
        (Packing::Square, [1.0; 3], 0.04)
    };
    (packing.fit(box_sides, spacing).unwrap(), spacing)
}

/// The same with any physics.
pub fn vortices<T: Real, P: Real>(dims: usize, physics: &Physics, scheme: &Scheme) -> Sph<T, P> {
    let (lattice, spacing) = lattice(dims);
    let lengths = lattice.lengths();
    let positions: Vec<_> = lattice.displaced_positions(0.1, 7).collect();
    let wave = |x: f64, length: f64| (std::f64::consts::TAU * x / length).sin();
    let start = Start {
        region: Region {
            lower: vec![0.0; dims],
            upper: lengths[..dims].to_vec(),
            periodic: vec![true; dims],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        velocities: positions
            .iter()
            .map(|x| [wave(x[1], lengths[1]), 0.5 * wave(x[0], lengths[0]), 0.0])
            .collect(),
        positions,
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 10.0,
        kinematic_viscosity: 0.01,
        state_equation: StateEquation::Tait { exponent: 7.0, background: 0.05 },
    };
    Sph::new(&start, &fluid, physics, scheme).unwrap()
}
