//! Where the pressure is constant, differences of it make no force at all, however particles lie.

use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation, space::Cells};
use finegrain_sph::{
    Fields, Fluid, Packing, Physics, PressureForm, Scheme, Sph, Start, StateEquation,
};

const DENSITY: f64 = 2.0;
const SOUND_SPEED: f64 = 3.0;
const VISCOSITY: f64 = 0.5;
/// Background pressure in units of `rho c^2`.
const BACKGROUND: f64 = 1.0;

/// The first evaluation for a free ball of particles at rest, far off a lattice.
fn ball(dims: usize) -> (Simulation<Cells<f64>>, Fields<f64>) {
    let (packing, spacing) =
        if dims == 3 { (Packing::Cubic, 0.1) } else { (Packing::Square, 0.05) };
    let lattice = packing.fit([1.0; 3], spacing).unwrap();
    let centred = lattice.displaced_positions(0.3, 5).map(|x| {
        let mut y = [0.0; 3];
        for a in 0..dims {
            y[a] = x[a] - 0.5;
        }
        y
    });
    let positions: Vec<_> =
        centred.filter(|x| x.iter().map(|x| x * x).sum::<f64>() < 0.4 * 0.4).collect();
    let start = Start {
        region: Region {
            lower: vec![-0.5; dims],
            upper: vec![0.5; dims],
            periodic: vec![false; dims],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        velocities: Vec::new(),
        positions,
    };
    let fluid = Fluid {
        density: DENSITY,
        sound_speed: SOUND_SPEED,
        kinematic_viscosity: VISCOSITY,
        state_equation: StateEquation::Linear { background: BACKGROUND },
    };
    let scheme = Scheme { pressure_form: PressureForm::Antisymmetric, ..Scheme::default() };
    let sph = Sph::<f64>::new(&start, &fluid, &Physics::default(), &scheme).unwrap();
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    simulation.begin().unwrap();
    (simulation, sph.fields)
}

#[test]
fn constant_pressure_makes_no_force_at_all() {
    for dims in [2, 3] {
        let (simulation, fields) = ball(dims);
        let columns = simulation.columns();
        let pressure = columns.values(fields.pressure.unwrap());
        assert!(pressure.iter().all(|&p| p == BACKGROUND * DENSITY * SOUND_SPEED.powi(2)));
        for &a in &fields.acceleration {
            assert!(columns.values(a).iter().all(|&a| a == 0.0), "{dims}-D");
        }
    }
}
