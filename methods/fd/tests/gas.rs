//! Euler's equations: waves, and Riemann problems that leave next to nothing.

mod solution;

use std::f64::consts::TAU;

use finegrain_fd::{Gas, GasEnd, GasState, Mesh, Side, measure};
use finegrain_framework::{Settings, Simulation};
use solution::order;

const OPEN: Gas = Gas { heat_ratio: 1.4, courant: 0.4, ends: [[GasEnd::Open; 2]; 2] };

/// A wave of density that is carried along changes nothing else, and is known.
fn carried(n: usize) -> f64 {
    let gas = Gas { courant: 0.4 * (20.0 / n as f64).powf(2.0 / 3.0), ..OPEN };
    let mesh = Mesh::new([Side::periodic(n, 0.0, 1.0)]);
    let density = |x: f64| 1.0 + 0.2 * (TAU * x).sin();
    let start =
        |x: [f64; 3]| GasState { density: density(x[0]), velocity: [1.0, 0.0, 0.0], pressure: 1.0 };
    let fd = gas.model::<f64>(&mesh, &start).unwrap();
    let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
    simulation.end_at(0.3);
    while simulation.clock().time() < 0.3 - 1e-12 {
        simulation.advance(1).unwrap();
    }
    solution::error(&simulation, &fd.parts, |x, t| density(x[0] - t))
}

#[test]
fn a_smooth_wave_is_carried_in_fifth_order() {
    let measured = order([20, 40].map(carried), [20, 40]);
    assert!((measured - 5.0).abs() < 0.2, "{measured}");
}

/// Weak sound goes at `sqrt(gamma p / rho)`, along any axis: pressure, its work and the energy are right.
#[test]
fn sound_has_its_speed() {
    const WEAK: f64 = 1e-6;
    let (density, pressure) = (1.3, 0.8);
    let speed = (OPEN.heat_ratio * pressure / density).sqrt();
    let wave = |x: f64| WEAK * (TAU * x).sin();
    let (along, across) = (Side::periodic(40, 0.0, 1.0), Side::periodic(8, 0.0, 1.0));
    let meshes =
        [(0, Mesh::new([along])), (0, Mesh::new([along, across])), (1, Mesh::new([across, along]))];
    for (axis, mesh) in meshes {
        let start = |x: [f64; 3]| {
            let part = wave(x[axis]);
            let mut velocity = [0.0; 3];
            velocity[axis] = speed * part;
            let pressure = pressure * (1.0 + OPEN.heat_ratio * part);
            GasState { density: density * (1.0 + part), velocity, pressure }
        };
        let fd = OPEN.model::<f64>(&mesh, &start).unwrap();
        let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
        simulation.advance(100).unwrap();
        let time = simulation.clock().time();
        assert!(speed * time > 0.25, "{time}");
        let values = simulation.columns().values(fd.parts.unknowns[0]);
        for (x, &found) in mesh.positions().zip(values) {
            let expected = wave(x[axis] - speed * time);
            let error = (found / density - 1.0 - expected) / WEAK;
            assert!(error.abs() < 1e-3, "axis {axis}, {x:?}: {error}");
        }
    }
}

fn still(density: f64, velocity: f64, pressure: f64) -> GasState {
    GasState { density, velocity: [velocity, 0.0, 0.0], pressure }
}

/// Runs a tube from 0 to 1, parted at 0.5, and gives the smallest density and pressure at any time.
fn least(left: GasState, right: GasState, time: f64) -> [f64; 2] {
    let mesh = Mesh::new([Side::cells(200, 0.0, 1.0)]);
    let fd = OPEN.model::<f64>(&mesh, &|x| if x[0] < 0.5 { left } else { right }).unwrap();
    let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
    simulation.end_at(time);
    let mut least = [f64::INFINITY; 2];
    while simulation.clock().time() < time * (1.0 - 1e-12) {
        simulation.advance(1).unwrap();
        let at = |f: usize| simulation.columns().values(fd.parts.unknowns[f]);
        for ((density, momentum), energy) in at(0).iter().zip(at(1)).zip(at(2)) {
            let pressure = 0.4 * (energy - 0.5 * momentum * momentum / density);
            least = [least[0].min(*density), least[1].min(pressure)];
        }
    }
    least
}

/// Toro (1999), table 4.1, tests 2 and 3; gas drawn apart into what is nearly a vacuum, where without
/// the limiter pressure becomes negative; and a blast of a hundred thousand to one (after Sedov).
#[test]
fn positive_stays_positive() {
    let cases = [
        ("123", still(1.0, -2.0, 0.4), still(1.0, 2.0, 0.4), 0.15),
        ("blast", still(1.0, 0.0, 1000.0), still(1.0, 0.0, 0.01), 0.012),
        ("vacuum", still(1.0, -5.0, 0.4), still(1.0, 5.0, 0.4), 0.05),
        ("strong blast", still(1.0, 0.0, 1e6), still(1e-3, 0.0, 1e-6), 1e-4),
    ];
    for (name, left, right, time) in cases {
        let [density, pressure] = least(left, right, time);
        assert!(density > 0.0 && pressure > 0.0, "{name}: {density} {pressure}");
    }
}

/// Between walls nothing is lost: mass and energy are kept to round-off, also in two directions; and what is
/// the same in both comes out the same.
#[test]
fn a_closed_box_keeps_mass_and_energy() {
    let gas = Gas { ends: [[GasEnd::Wall; 2]; 2], ..OPEN };
    let mesh = Mesh::new([Side::cells(40, 0.0, 1.0), Side::cells(40, 0.0, 1.0)]);
    let start = |x: [f64; 3]| still(1.0, 0.0, if x[0] + x[1] < 0.7 { 10.0 } else { 0.1 });
    let fd = gas.model::<f64>(&mesh, &start).unwrap();
    let mut simulation = Simulation::new(fd.model, Settings::default()).unwrap();
    let fields = [fd.parts.unknowns[0], fd.parts.unknowns[3]];
    let before = fields.map(|f| measure::totals(&mut simulation.whole(), &fd.parts, f));
    simulation.advance(200).unwrap();
    for (field, before) in fields.into_iter().zip(before) {
        let after = measure::totals(&mut simulation.whole(), &fd.parts, field);
        assert!((after.integral / before.integral - 1.0).abs() < 1e-13, "{before:?} {after:?}");
    }
    let columns = simulation.columns();
    let (density, [mx, my]) = (
        columns.values(fd.parts.unknowns[0]),
        [1, 2].map(|f| columns.values(fd.parts.unknowns[f])),
    );
    let mut most = 0.0f64;
    for i in 0..40 {
        for j in 0..40 {
            let (here, mirrored) = (j * 40 + i, i * 40 + j);
            assert!((density[here] - density[mirrored]).abs() < 1e-11);
            assert!((mx[here] - my[mirrored]).abs() < 1e-11);
            most = most.max(mx[here].abs());
        }
    }
    assert!(most > 0.1, "{most}");
}
