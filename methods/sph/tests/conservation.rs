//! In a periodic box momentum is conserved to round-off at every step, and viscosity takes kinetic energy;
//! with the energy equation, internal energy gains what kinetic energy loses. Angular momentum is conserved,
//! too, where nothing is periodic and particles act on each other along the line between them.

mod flow;

use finegrain_framework::space::cells::Region;
use finegrain_framework::{Real, Settings, Simulation};
use finegrain_sph::{
    Fluid, Packing, Physics, Scheme, Sph, Start, StateEquation, Viscosity, WallVelocity, measure,
};

#[test]
fn momentum_to_round_off() {
    for (viscosity, scheme) in [
        (Viscosity::Morris, Scheme::default()),
        (Viscosity::StrainRate, Scheme::default()),
        (Viscosity::Adami, flow::edac()),
        (Viscosity::Monaghan, Scheme::default()),
    ] {
        for dims in [2, 3] {
            let (mut simulation, fields, mass) =
                flow::flow::<f64, f64>(dims, viscosity, &scheme, false, Settings::default());
            simulation.begin().unwrap();
            let before = measure::totals(&mut simulation.whole(), &fields, mass);
            // What could be lost: every particle's momentum, once.
            let scale = (2.0 * before.kinetic_energy * before.mass).sqrt();
            for _ in 0..40 {
                simulation.advance(1).unwrap();
                let now = measure::totals(&mut simulation.whole(), &fields, mass);
                assert_eq!(now.mass, before.mass);
                for a in 0..dims {
                    let change = (now.momentum[a] - before.momentum[a]).abs() / scale;
                    assert!(change < 1e-13, "{viscosity:?} {dims}-D: {change:e}");
                }
            }
            let now = measure::totals(&mut simulation.whole(), &fields, mass);
            assert!(now.kinetic_energy < before.kinetic_energy);
        }
    }
}

/// By how much kinetic and internal energy of vortices together change in a tenth of a time unit, as a part
/// of what kinetic energy changes by.
fn energy_gained(dims: usize, viscosity: Option<Viscosity>, courant_number: f64) -> f64 {
    let physics = Physics { viscosity, energy: true, ..Physics::default() };
    let scheme = Scheme { courant_number, ..Scheme::default() };
    let (mut simulation, fields, mass) =
        flow::begun(flow::vortices::<f64, f64>(dims, &physics, &scheme), Settings::default());
    simulation.begin().unwrap();
    let before = measure::totals(&mut simulation.whole(), &fields, mass);
    while simulation.clock().time() < 0.1 {
        simulation.advance(1).unwrap();
    }
    let now = measure::totals(&mut simulation.whole(), &fields, mass);
    let kinetic = now.kinetic_energy - before.kinetic_energy;
    let internal = now.internal_energy - before.internal_energy;
    // Much more than round-off goes from one to the other.
    assert!(kinetic.abs() > 5e-3 * before.kinetic_energy, "{kinetic} of {before:?}");
    (kinetic + internal) / kinetic.abs()
}

#[test]
fn internal_energy_gains_what_kinetic_energy_loses() {
    for (dims, most) in [(2, 0.02), (3, 1e-3)] {
        // What pressure does cancels pair by pair: what is left is the integrator's, at least of order 2.
        let [coarse, fine] = [1.0, 0.5].map(|courant| energy_gained(dims, None, courant).abs());
        assert!(fine < 3e-3 && coarse > 4.0 * fine, "{dims}-D: {coarse:e}, {fine:e}");
        // Heat by shear takes the density around for a particle's own and, in the plane, where the strain rate
        // has a trace, leaves out what that does (eq. I.3).
        let gained = energy_gained(dims, Some(Viscosity::StrainRate), 0.5);
        assert!(gained.abs() < most, "{dims}-D, viscous: {gained:e}");
    }
}

/// What the fluid gains of momentum is what the body force gives it and the cylinder takes: to
/// round-off, for a cylinder that feels every force that it exerts.
#[test]
fn momentum_that_a_body_takes() {
    let virtual_particles = Scheme { wall_velocity: WallVelocity::Fitted, ..Scheme::default() };
    let fitted = Scheme { wall_velocity: WallVelocity::Fitted, ..flow::edac() };
    for (viscosity, scheme) in [
        (Viscosity::Morris, virtual_particles),
        (Viscosity::StrainRate, virtual_particles),
        (Viscosity::Monaghan, fitted),
        (Viscosity::Adami, flow::edac()),
        (Viscosity::Adami, fitted),
    ] {
        for dims in [2, 3] {
            let (mut simulation, fields, mass) =
                flow::flow::<f64, f64>(dims, viscosity, &scheme, true, Settings::default());
            simulation.advance(5).unwrap();
            let force = measure::force_on_body(&mut simulation.whole(), &fields, mass, |_| true);
            let columns = simulation.columns();
            let depth = columns.values(fields.wall_depth.unwrap());
            for a in 0..dims {
                let acceleration = columns.values(fields.acceleration[a]);
                let driving = if a == 0 { 0.3 } else { 0.0 };
                let (mut gained, mut size) = (0.0, 0.0);
                for (&acceleration, _) in
                    acceleration.iter().zip(depth).filter(|(_, depth)| **depth == 0.0)
                {
                    gained += mass * (acceleration - driving);
                    size += (mass * acceleration).abs();
                }
                let missing = (gained + force[a]).abs() / size;
                assert!(missing < 1e-13, "{viscosity:?} {dims}-D, {a}: {missing:e} of {size}");
                assert!(force[a].abs() > 1e-4 * size || a > 0, "{force:?} of {size}");
            }
        }
    }
}

/// On a lattice many pairs are exactly the kernel's support apart. Whether they interact must not
/// be decided by rounding, for each of the two by itself.
fn momentum_on_a_perfect_lattice<T: Real>(most: f64) {
    for cells in [16, 20, 25, 30] {
        let spacing = 1.0 / f64::from(cells);
        let lattice = Packing::Square.fit([1.0; 3], spacing).unwrap();
        let positions: Vec<_> = lattice.positions().collect();
        let wave = |x: f64| (std::f64::consts::TAU * x).sin();
        let start = Start {
            region: Region { lower: vec![0.0; 2], upper: vec![1.0; 2], periodic: vec![true; 2] },
            spacing,
            particle_volume: lattice.volume_per_particle(),
            velocities: positions.iter().map(|x| [wave(x[1]), wave(x[0]), 0.0]).collect(),
            positions,
        };
        let fluid = Fluid {
            density: 1.0,
            sound_speed: 10.0,
            kinematic_viscosity: 0.01,
            // A large pressure everywhere makes every pair that acts on one side only count.
            state_equation: StateEquation::Linear { background: 1.0 },
        };
        let physics = Physics { viscosity: Some(Viscosity::Morris), ..Physics::default() };
        let sph = Sph::<T>::new(&start, &fluid, &physics, &Scheme::default()).unwrap();
        let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
        simulation.advance(1).unwrap();
        let totals = measure::totals(&mut simulation.whole(), &sph.fields, sph.particle_mass);
        let change = totals.momentum[0].hypot(totals.momentum[1]);
        assert!(change < most, "{cells} cells: {change:e}");
    }
}

#[test]
fn momentum_on_a_perfect_lattice_in_f64() {
    momentum_on_a_perfect_lattice::<f64>(1e-14);
}

#[test]
fn momentum_on_a_perfect_lattice_in_f32() {
    momentum_on_a_perfect_lattice::<f32>(1e-5);
}

/// Momentum and angular momentum, about the origin and over those that there were at the start if
/// all particles moved alike, that a sheared disc gains in 40 steps.
fn gained_by_a_free_disc(viscosity: Viscosity) -> [f64; 3] {
    let spacing = 0.05;
    let lattice = Packing::Square.fit([1.0; 3], spacing).unwrap();
    let positions: Vec<_> = (lattice.displaced_positions(0.1, 3))
        .map(|[x, y, _]| [x - 0.5, y - 0.5, 0.0])
        .filter(|[x, y, _]| x.hypot(*y) < 0.4)
        .collect();
    let start = Start {
        region: Region { lower: vec![-0.5; 2], upper: vec![0.5; 2], periodic: vec![false; 2] },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        // Turning, and sheared besides.
        velocities: (positions.iter())
            .map(|[x, y, _]| [2.0 * (15.0 * y).sin() - 3.0 * y, x + x * x, 0.0])
            .collect(),
        positions,
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 20.0,
        kinematic_viscosity: 0.05,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let physics = Physics { viscosity: Some(viscosity), ..Physics::default() };
    let sph = Sph::<f64>::new(&start, &fluid, &physics, &Scheme::default()).unwrap();
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    simulation.begin().unwrap();
    let sums = |simulation: &Simulation<_>| {
        let columns = simulation.columns();
        let value = |of| columns.values(of);
        let (x, y) = (value(sph.fields.position[0]), value(sph.fields.position[1]));
        let (u, v) = (value(sph.fields.velocity[0]), value(sph.fields.velocity[1]));
        let mut sums = [0.0; 6];
        for i in 0..columns.points() {
            let turning = x[i] * v[i] - y[i] * u[i];
            let (speed, arm) = (u[i].hypot(v[i]), x[i].hypot(y[i]));
            for (sum, s) in sums.iter_mut().zip([u[i], v[i], turning, speed, speed, speed * arm]) {
                *sum += s;
            }
        }
        sums
    };
    let before = sums(&simulation);
    simulation.advance(40).unwrap();
    let after = sums(&simulation);
    assert!(after[3] < 0.99 * before[3], "viscosity slows it down");
    std::array::from_fn(|k| (after[k] - before[k]).abs() / before[3 + k])
}

#[test]
fn angular_momentum_of_a_free_disc_to_round_off() {
    for gained in gained_by_a_free_disc(Viscosity::Monaghan) {
        assert!(gained < 1e-13, "{gained:e}");
    }
    // The others keep momentum only.
    let [x, y, turning] = gained_by_a_free_disc(Viscosity::Morris);
    assert!(x < 1e-13 && y < 1e-13 && turning > 1e-6, "{x:e}, {y:e}, {turning:e}");
}
