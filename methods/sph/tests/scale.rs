//! Nothing depends on how long a metre is: with all lengths times a power of two, all bits but those of
//! exponents are the same, from atoms to galaxies.

use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation};
use finegrain_sph::{
    Fluid, Packing, Physics, Scheme, Sph, Start, StateEquation, Viscosity, measure,
};

/// Accelerations over the length of a metre after some steps, and neighbours.
fn outcome(metre: f64) -> (Vec<f64>, f64) {
    let lattice = Packing::Square.fit([1.0; 3], 0.0625).unwrap();
    let wave = |x: f64| (std::f64::consts::TAU * x).sin();
    let positions: Vec<_> = lattice.displaced_positions(0.1, 7).collect();
    let velocities = positions.iter().map(|x| [metre * wave(x[1]), metre * wave(x[0]), 0.0]);
    let start = Start {
        region: Region { lower: vec![0.0; 2], upper: vec![metre; 2], periodic: vec![true; 2] },
        spacing: 0.0625 * metre,
        particle_volume: (0.0625 * metre).powi(2),
        velocities: velocities.collect(),
        positions: positions.iter().map(|x| x.map(|x| metre * x)).collect(),
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed: 10.0 * metre,
        kinematic_viscosity: 0.01 * metre * metre,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let physics = Physics { viscosity: Some(Viscosity::Morris), ..Physics::default() };
    let sph = Sph::<f64>::new(&start, &fluid, &physics, &Scheme::default()).unwrap();
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    simulation.advance(5).unwrap();
    let neighbours = measure::mean_neighbours(&mut simulation.whole());
    let columns = simulation.columns();
    let all = sph.fields.acceleration.iter().flat_map(|&a| columns.values(a));
    (all.map(|a| a / metre).collect(), neighbours)
}

#[test]
fn from_atoms_to_galaxies() {
    let (expected, neighbours) = outcome(1.0);
    assert!(neighbours > 10.0 && expected.iter().any(|a| a.abs() > 0.1));
    for metre in [2f64.powi(-80), 2f64.powi(80)] {
        let (found, seen) = outcome(metre);
        assert_eq!(seen, neighbours);
        assert!(found == expected, "with a metre of {metre:e}");
    }
}
