//! The viscosity that a wave of shear shows, against the one that was asked for.

use std::f64::consts::TAU;

use finegrain_framework::{Settings, Simulation};
use finegrain_lbm::mesh::time_step_of_relaxation_time;
use finegrain_lbm::{Collision, Fluid, LatticeKind, Lbm, Mesh, Physics, Scheme, Start, measure};

const ALL: [Collision; 3] =
    [Collision::Bgk, Collision::Trt { magic: 3.0 / 16.0 }, Collision::Regularised];

/// Relative error of the viscosity on `n` sites a wave, by the decay of kinetic energy in a time in
/// which the wave decays to about two thirds. Diffusive scaling; the wave is slow.
fn error(lattice: LatticeKind, collision: Collision, n: usize) -> f64 {
    let (spacing, viscosity, speed) = (1.0 / n as f64, 0.01, 1e-4);
    let mesh = Mesh {
        shape: if lattice.dims() == 2 { [n, n, 1] } else { [4, n, 4] },
        corner: [0.0; 3],
        spacing,
        time_step: time_step_of_relaxation_time(spacing, viscosity, 0.8),
        periodic: [true; 3],
    };
    let fluid = Fluid { density: 1.0, kinematic_viscosity: viscosity, largest_speed: speed };
    let start = Start::with_velocity(move |[_, y, _]| [speed * (TAU * y).sin(), 0.0, 0.0]);
    let scheme = Scheme { collision, ..Scheme::on(lattice) };
    let lbm = Lbm::<f64>::new(&mesh, &fluid, &Physics::default(), &scheme, &start).unwrap();
    let mut simulation = Simulation::new(lbm.model, Settings::default()).unwrap();
    let mut energy = |steps| {
        simulation.advance(steps).unwrap();
        simulation.derive().unwrap();
        let energy = measure::totals(&mut simulation.whole(), &lbm.parts).kinetic_energy;
        (simulation.clock().time(), energy)
    };
    // What the start lacks in higher orders dies out in a few steps.
    let steps = (n * n / 10) as u64;
    let ((t0, e0), (t1, e1)) = (energy(steps), energy(steps));
    (e0 / e1).ln() / (2.0 * TAU * TAU * (t1 - t0)) / viscosity - 1.0
}

#[test]
fn its_error_falls_with_the_square_of_the_spacing() {
    for lattice in [LatticeKind::D2Q9, LatticeKind::D3Q19, LatticeKind::D3Q27] {
        for collision in ALL {
            let [coarse, fine] = [16, 32].map(|n| error(lattice, collision, n).abs());
            let order = (coarse / fine).log2();
            assert!((order - 2.0).abs() < 0.1, "{lattice:?} {collision:?}: {coarse} {fine}");
        }
    }
}
