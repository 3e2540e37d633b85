//! Shear flow along a wall: where the velocity grows linearly from zero at the surface, the viscous
//! force vanishes, up to the surface.

use finegrain_framework::shape::Shape;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation};
use finegrain_sph::{Fluid, Physics, Scheme, Sph, Start, StateEquation, Viscosity};

const SPACING: f64 = 0.1;
const SHEAR: f64 = 2.0;
const VISCOSITY: f64 = 0.5;

/// Height above the wall, and acceleration, of the particles that see nothing of the fluid's upper
/// end.
fn accelerations(viscosity: Viscosity) -> Vec<(f64, [f64; 2])> {
    let (columns, wall_rows, fluid_rows) = (10, 7, 24);
    let mut positions = Vec::new();
    for row in -wall_rows..fluid_rows {
        for column in 0..columns {
            let along = (f64::from(column) + 0.5) * SPACING;
            positions.push([along, (f64::from(row) + 0.5) * SPACING, 0.0]);
        }
    }
    let start = Start {
        region: Region {
            lower: vec![0.0, -1.0],
            upper: vec![f64::from(columns) * SPACING, 3.0],
            periodic: vec![true, false],
        },
        spacing: SPACING,
        particle_volume: SPACING * SPACING,
        velocities: positions.iter().map(|x| [SHEAR * x[1], 0.0, 0.0]).collect(),
        positions,
    };
    let fluid = Fluid {
        density: 2.0,
        sound_speed: 10.0,
        kinematic_viscosity: VISCOSITY,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let wall = Shape::HalfSpace { point: [0.0; 3], outward: [0.0, 1.0, 0.0] };
    let physics =
        Physics { viscosity: Some(viscosity), bodies: vec![wall.into()], ..Physics::default() };
    // The first row of fluid sees wall particles 3 spacings deep from a height of half a one.
    let scheme = Scheme { beta_max: 10.0, ..Scheme::default() };
    let Sph { model, fields, .. } = Sph::<f64>::new(&start, &fluid, &physics, &scheme).unwrap();
    let mut simulation = Simulation::new(model, Settings::default()).unwrap();
    simulation.begin().unwrap();
    let columns = simulation.columns();
    let heights = columns.values(fields.position[1]).iter();
    let acceleration = fields.acceleration.iter().map(|&a| columns.values(a)).collect::<Vec<_>>();
    heights
        .enumerate()
        .filter(|&(_, &y)| y > 0.0 && y < (f64::from(fluid_rows) - 7.0) * SPACING)
        .map(|(i, &y)| (y, [acceleration[0][i], acceleration[1][i]]))
        .collect()
}

#[test]
fn linear_shear_feels_no_force() {
    for viscosity in [Viscosity::Morris, Viscosity::StrainRate, Viscosity::Monaghan] {
        // What one neighbour's share is of the order of.
        let scale = VISCOSITY * SHEAR / SPACING;
        let accelerations = accelerations(viscosity);
        assert_eq!(accelerations.len(), 170);
        for (y, [along, across]) in accelerations {
            let error = along.hypot(across) / scale;
            assert!(error < 1e-10, "{viscosity:?}: {error:e} at height {y}");
        }
    }
}
