//! Walls of virtual particles. Shear flow along one: where the velocity grows linearly from zero at the
//! surface, the viscous force vanishes, up to the surface. Fluid driven at one: it repels, and nothing
//! enters it (Monaghan 1994).

use finegrain_framework::shape::Shape;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation};
use finegrain_sph::{Fluid, Physics, Scheme, Sph, Start, StateEquation, Viscosity, WallPressure};

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

/// Least height over a wall, in spacings, that any of the particles `above` has while they fly at the wall with
/// a tenth of the speed of sound; and their mean velocity upwards at the end, over that speed.
fn driven_at_a_wall(above: &[[f64; 2]], viscosity: Viscosity) -> [f64; 2] {
    let (columns, rows, sound_speed) = (16, 8, 10.0);
    let speed = 0.1 * sound_speed;
    let mut positions = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let along = (f64::from(column) + 0.5) * SPACING;
            positions.push([along, (-f64::from(row) - 0.5) * SPACING, 0.0]);
        }
    }
    let in_wall = positions.len();
    positions.extend(above.iter().map(|[x, y]| [x * SPACING, y * SPACING, 0.0]));
    let mut velocities = vec![[0.0; 3]; in_wall];
    velocities.resize(positions.len(), [0.0, -speed, 0.0]);
    let start = Start {
        region: Region {
            lower: vec![0.0, -f64::from(rows) * SPACING],
            upper: vec![f64::from(columns) * SPACING, 3.0],
            periodic: vec![true, false],
        },
        spacing: SPACING,
        particle_volume: SPACING * SPACING,
        velocities,
        positions,
    };
    let fluid = Fluid {
        density: 1.0,
        sound_speed,
        kinematic_viscosity: 1e-3,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let wall = Shape::HalfSpace { point: [0.0; 3], outward: [0.0, 1.0, 0.0] };
    let physics =
        Physics { viscosity: Some(viscosity), bodies: vec![wall.into()], ..Physics::default() };
    let scheme = Scheme { wall_pressure: WallPressure::Evolved, ..Scheme::default() };
    let Sph { model, fields, .. } = Sph::<f64>::new(&start, &fluid, &physics, &scheme).unwrap();
    let mut simulation = Simulation::new(model, Settings::default()).unwrap();
    let (mut least, mut upwards) = (f64::INFINITY, 0.0);
    // Time to fly past the wall's depth.
    while simulation.clock().time() < f64::from(rows) * SPACING / speed {
        simulation.advance(1).unwrap();
        let columns = simulation.columns();
        let values = |of| columns.values(of).iter().copied();
        let depths = values(fields.wall_depth.unwrap());
        let moving = values(fields.position[1]).zip(values(fields.velocity[1])).zip(depths);
        let fluid: Vec<_> = moving.filter(|(_, depth)| *depth == 0.0).map(|(x, _)| x).collect();
        assert_eq!(fluid.len(), above.len());
        least = fluid.iter().map(|x| x.0 / SPACING).fold(least, f64::min);
        upwards = fluid.iter().map(|x| x.1 / speed).sum::<f64>() / above.len() as f64;
    }
    [least, upwards]
}

#[test]
fn nothing_enters_a_wall() {
    let block =
        || (0..6).flat_map(|k| (0..5).map(move |j| [5.5 + f64::from(k), 3.5 + f64::from(j)]));
    // A particle above one of the wall's and one between two, which bounce, and a drop, which spreads.
    let cases = [(vec![[8.5, 3.5]], 0.9), (vec![[8.0, 3.5]], 0.9), (block().collect(), 0.0)];
    for viscosity in [Viscosity::StrainRate, Viscosity::Morris] {
        for (above, bounce) in &cases {
            let [least, upwards] = driven_at_a_wall(above, viscosity);
            assert!(least > 0.3, "{viscosity:?}, {}: height {least}", above.len());
            assert!(upwards > *bounce, "{viscosity:?}, {}: {upwards}", above.len());
        }
    }
}
