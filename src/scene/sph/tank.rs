//! The tank in SPH: a square lattice of water, and as many layers of it in the walls as particles
//! see.

use finegrain_framework::run::{Every, History, Run};
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Near, Real, State, Whole};
use finegrain_sph::{Fields, Fluid, Physics, Scheme, Slip, Stabilisation, Start, WallPressure};

use super::free_surface;
use crate::scene::Report;
use crate::scene::parameter::{Parameter, Parameters};
use crate::scene::tank::{DENSITY, GRAVITY, Tank};

/// Parameters that scenes in a tank have besides.
pub(super) const PARAMETERS: [Parameter; 2] = [
    Parameter::choice(
        "walls",
        &["extrapolated", "evolved"],
        "pressure in the walls: from the fluid (Adami et al. 2012), or virtual particles that \
         repel by being compressed (Monaghan 1994)",
    ),
    Parameter::number(
        "repulsion",
        0.0,
        [0.0, 10.0],
        "",
        "repulsion of what is nearer than a spacing to particles of walls (Monaghan 1994), in \
         units of the square of the largest speed",
    ),
];

/// Water with a numerical sound speed, m/s.
pub(super) fn water(parameters: &Parameters, sound_speed: f64) -> Fluid {
    Fluid {
        density: DENSITY,
        sound_speed,
        kinematic_viscosity: 0.0,
        state_equation: free_surface::state_equation(parameters),
    }
}

/// Gravity and walls without friction.
pub(super) fn physics(tank: &Tank) -> Physics {
    Physics {
        body_acceleration: [0.0, -GRAVITY, 0.0],
        bodies: tank.walls().map(Into::into).to_vec(),
        slip: Slip::Free,
        ..Physics::default()
    }
}

/// The scheme that the parameters name, for a flow with this largest speed, m/s.
pub(super) fn scheme(parameters: &Parameters, speed: f64) -> Scheme {
    let scheme = free_surface::scheme(parameters, speed);
    let repulsion = parameters.number("repulsion") * speed * speed;
    Scheme {
        stabilisation: Stabilisation {
            repulsion: (repulsion > 0.0).then_some(repulsion),
            ..scheme.stabilisation
        },
        wall_pressure: match parameters.choice("walls") {
            "evolved" => WallPressure::Evolved,
            _ => WallPressure::Extrapolated,
        },
        ..scheme
    }
}

/// The tank with its width a whole number of spacings.
pub(super) fn fit(tank: Tank, spacing: f64) -> Tank {
    Tank { width: (tank.width / spacing).round().max(1.0) * spacing, ..tank }
}

/// Particles at rest in the tank where `is_filled`, and in its walls.
pub(super) fn start(
    tank: &Tank,
    spacing: f64,
    scheme: &Scheme,
    is_filled: impl Fn([f64; 3]) -> bool,
) -> Start {
    let range = scheme.kernel.support() * scheme.smoothing_ratio * spacing;
    let layers = (range / spacing).ceil() as i32;
    let columns = (tank.width / spacing).round() as i32;
    let rows = (tank.height / spacing).ceil() as i32;
    let at = |i: i32| (f64::from(i) + 0.5) * spacing;
    let mut positions = Vec::new();
    for j in -layers..rows {
        for i in -layers..columns + layers {
            let x = [at(i), at(j), 0.0];
            let is_wall = j < 0 || i < 0 || i >= columns;
            if is_wall || is_filled(x) {
                positions.push(x);
            }
        }
    }
    Start {
        region: Region {
            lower: vec![-range; 2],
            upper: vec![tank.width + range, tank.height],
            periodic: vec![false; 2],
        },
        spacing,
        particle_volume: spacing * spacing,
        positions,
        velocities: Vec::new(),
    }
}

/// Moves the water of a start up to `depth` to where it is in equilibrium as the slightly
/// compressible fluid that it is: rows are closer where the pressure is higher, so that the
/// density of the equation of state is that with which particles lie, to first order in
/// `g depth / c^2`.
pub(super) fn settle(start: &mut Start, tank: &Tank, depth: f64, sound_speed: f64) {
    let compression = GRAVITY / (sound_speed * sound_speed);
    for x in &mut start.positions {
        if x[0] > 0.0 && x[0] < tank.width && x[1] > 0.0 {
            x[1] -= compression * (depth - 0.5 * x[1]) * x[1];
        }
    }
}

/// Number of particles of the water beyond a wall, the largest x among them, and the largest speed.
pub(super) fn watch<T: Real, P: Real>(
    whole: &mut Whole<'_, Cells<P>>,
    fields: &Fields<T, P>,
    tank: &Tank,
) -> [f64; 3] {
    let width = P::of(tank.width);
    let value =
        |near: &Near<'_, Cells<P>>, handle: State<T>, i: usize| near.state(handle).own().whole()[i];
    let coordinate = |near: &Near<'_, Cells<P>>, a: usize, i: usize| {
        near.state(fields.position[a]).own().whole()[i]
    };
    let is_water = |near: &Near<'_, Cells<P>>, i: usize| {
        fields.wall_depth.is_none_or(|depth| value(near, depth, i) == T::zero())
    };
    let [beyond] = whole.sum(|near| {
        let count = (0..near.spans()[0].len()).filter(|&i| {
            let [x, y] = [0, 1].map(|a| coordinate(near, a, i));
            is_water(near, i) && (x < P::zero() || x > width || y < P::zero())
        });
        [count.count() as f64]
    });
    let [front, squared] = whole.max(|near| {
        let mut most = [f64::NEG_INFINITY, 0.0];
        for i in (0..near.spans()[0].len()).filter(|&i| is_water(near, i)) {
            let squared: f64 =
                fields.velocity.iter().map(|&v| value(near, v, i).as_f64().powi(2)).sum();
            most[0] = most[0].max(coordinate(near, 0, i).as_f64());
            most[1] = most[1].max(squared);
        }
        most
    });
    [beyond, front, squared.sqrt()]
}

/// Monitors energy, and what [`watch`] sees.
pub(super) fn monitor<T: Real, P: Real>(
    run: Run<Cells<P>>,
    every: Every,
    fields: &Fields<T, P>,
    fluid: Fluid,
    mass: f64,
    tank: Tank,
) -> Run<Cells<P>> {
    let run =
        free_surface::monitor_energy(run, every, fields, fluid, mass, |[_, y, _]| GRAVITY * y);
    let fields = fields.clone();
    run.monitor("water", every, ["through_walls", "front", "largest_speed"], move |whole| {
        watch(whole, &fields, &tank)
    })
}

/// Adds `through_walls`, the most particles beyond a wall at any time.
pub(super) fn judge_walls(report: &mut Report, histories: &[History]) {
    let water = histories.iter().find(|history| history.name() == "water");
    if let Some(beyond) = water.and_then(|water| water.column("through_walls")) {
        report.result("through_walls", beyond.fold(0.0, f64::max), None);
    }
}
