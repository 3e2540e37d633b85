//! Each choice against noise and clumping is what its equation says.

use std::f64::consts::{PI, TAU};

use finegrain_framework::shape::Shape;
use finegrain_framework::space::Cells;
use finegrain_framework::space::cells::Region;
use finegrain_framework::{Rate, Settings, Simulation, VectorField};
use finegrain_sph::{
    ArtificialViscosity, DensityDiffusion, DiffusionForm, Dimension, Fields, Fluid, Fringe, Kernel,
    Packing, Physics, Scheme, SmoothingFunction, Sph, Stabilisation, Start, StateEquation,
    WallPressure,
};

const DENSITY: f64 = 2.0;
const SOUND_SPEED: f64 = 3.0;
const RATIO: f64 = 2.5;

/// What is evaluated, in the plane.
struct Case {
    positions: Vec<[f64; 3]>,
    spacing: f64,
    is_periodic: bool,
    stabilisation: Stabilisation,
    physics: Physics,
}

impl Case {
    /// A unit square of particles, a little displaced if `fraction` is not 0.
    fn square(cells: f64, fraction: f64, is_periodic: bool, stabilisation: Stabilisation) -> Self {
        let spacing = 1.0 / cells;
        let lattice = Packing::Square.fit([1.0; 3], spacing).unwrap();
        let positions = lattice.displaced_positions(fraction, 5).collect();
        Self { positions, spacing, is_periodic, stabilisation, physics: Physics::default() }
    }

    fn mass(&self) -> f64 {
        DENSITY * self.spacing * self.spacing
    }

    /// Evaluates the rates for a velocity and density, at `time`.
    fn evaluate(
        &self,
        velocity: impl Fn([f64; 3]) -> [f64; 3],
        density: impl Fn([f64; 3]) -> f64,
    ) -> (Simulation<Cells<f64>>, Fields<f64>) {
        let start = Start {
            region: Region {
                lower: vec![0.0; 2],
                upper: vec![1.0; 2],
                periodic: vec![self.is_periodic; 2],
            },
            spacing: self.spacing,
            particle_volume: self.spacing * self.spacing,
            velocities: self.positions.iter().map(|&x| velocity(x)).collect(),
            positions: self.positions.clone(),
        };
        let fluid = Fluid {
            density: DENSITY,
            sound_speed: SOUND_SPEED,
            kinematic_viscosity: 0.0,
            state_equation: StateEquation::Linear { background: 0.0 },
        };
        let scheme = Scheme {
            kernel: SmoothingFunction::WendlandC2,
            smoothing_ratio: RATIO,
            stabilisation: self.stabilisation,
            wall_pressure: WallPressure::Extrapolated,
            ..Scheme::default()
        };
        let mut sph = Sph::<f64>::new(&start, &fluid, &self.physics, &scheme).unwrap();
        let column = sph.model.columns.values_mut(sph.fields.density);
        for (rho, &x) in column.iter_mut().zip(&self.positions) {
            *rho = density(x);
        }
        let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
        simulation.begin().unwrap();
        (simulation, sph.fields)
    }
}

/// The vectors of a rate by the number of the particle.
fn by_number(
    simulation: &Simulation<Cells<f64>>,
    fields: &Fields<f64>,
    rates: &[Rate<f64>],
) -> Vec<[f64; 2]> {
    let columns = simulation.columns();
    let mut sorted = vec![[0.0; 2]; columns.points()];
    for (i, &number) in columns.values(fields.identity).iter().enumerate() {
        for (value, &rate) in sorted[number as usize].iter_mut().zip(rates) {
            *value = columns.values(rate)[i];
        }
    }
    sorted
}

fn accelerations(
    case: &Case,
    velocity: impl Fn([f64; 3]) -> [f64; 3],
    density: impl Fn([f64; 3]) -> f64,
) -> Vec<[f64; 2]> {
    let (simulation, fields) = case.evaluate(velocity, density);
    by_number(&simulation, &fields, &fields.acceleration)
}

fn density_rates(case: &Case, density: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
    let (simulation, fields) = case.evaluate(at_rest, density);
    let rates = by_number(&simulation, &fields, &[fields.density_rate.unwrap()]);
    rates.into_iter().map(|[rate, _]| rate).collect()
}

fn at_rest(_: [f64; 3]) -> [f64; 3] {
    [0.0; 3]
}

fn diffusion(form: DiffusionForm) -> Stabilisation {
    Stabilisation {
        density_diffusion: Some(DensityDiffusion { form, delta: 0.1 }),
        ..Stabilisation::default()
    }
}

fn kernel(spacing: f64) -> Kernel<f64> {
    Kernel::new(SmoothingFunction::WendlandC2, Dimension::Two, RATIO * spacing)
}

/// `W` and `F` at a distance.
fn kernel_at(spacing: f64, distance: f64) -> (f64, f64) {
    let (mut w, mut f) = ([0.0], [0.0]);
    kernel(spacing).evaluate(&[distance * distance], &mut w, &mut f);
    (w[0], f[0])
}

#[test]
fn density_diffuses_with_delta_h_c() {
    let amplitude = 1e-4;
    let error_at = |cells: f64| {
        let case = Case::square(cells, 0.0, true, diffusion(DiffusionForm::MolteniColagrossi));
        let wave = |x: [f64; 3]| DENSITY * amplitude * (TAU * x[0]).sin();
        let diffusivity = 0.1 * RATIO / cells * SOUND_SPEED;
        let rates = density_rates(&case, |x| DENSITY + wave(x));
        let scale = diffusivity * TAU * TAU * DENSITY * amplitude;
        let off = rates
            .iter()
            .zip(&case.positions)
            .map(|(rate, &x)| (rate + diffusivity * TAU * TAU * wave(x)).abs() / scale);
        off.fold(0.0, f64::max)
    };
    assert!(error_at(48.0) < 0.03, "{}", error_at(48.0));
    assert!(error_at(48.0) < 0.5 * error_at(24.0));
}

#[test]
fn diffusion_leaves_what_it_must_and_keeps_the_volume() {
    let gravity = [0.0, -0.5, 0.0];
    let slope = DENSITY * gravity[1] / SOUND_SPEED.powi(2);
    let linear = |x: [f64; 3]| DENSITY + slope * (x[1] - 1.0);
    for (form, most) in [
        // Where a free surface cuts off the linear field, it is of the order of delta c slope.
        (DiffusionForm::MolteniColagrossi, f64::INFINITY),
        (DiffusionForm::Antuono, 1e-12),
        (DiffusionForm::Fourtakas, 1e-12),
    ] {
        let mut case = Case::square(16.0, 0.2, false, diffusion(form));
        case.physics.body_acceleration = gravity;
        let rates = density_rates(&case, linear);
        let most_rate = rates.iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        assert!(most_rate <= most, "{form:?} {most_rate}");
        let wavy = |x: [f64; 3]| linear(x) + 0.1 * (7.0 * x[0]).sin() * (5.0 * x[1]).cos();
        let rates = density_rates(&case, wavy);
        let (mut sum, mut sum_of_magnitudes) = (0.0, 0.0);
        for (rate, &x) in rates.iter().zip(&case.positions) {
            sum += rate / wavy(x);
            sum_of_magnitudes += rate.abs() / wavy(x);
        }
        assert!(sum.abs() < 1e-12 * sum_of_magnitudes, "{form:?}: {sum} of {sum_of_magnitudes}");
    }
}

/// Where all particles approach, it is a viscosity `alpha c h / 8` in the plane (with a volume
/// viscosity of twice that).
#[test]
fn artificial_viscosity_acts_like_a_viscosity() {
    let alpha = 0.3;
    let viscosity = ArtificialViscosity { alpha, beta: 0.0 };
    let stabilisation =
        Stabilisation { artificial_viscosity: Some(viscosity), ..Stabilisation::default() };
    let cells = 48.0;
    let case = Case::square(cells, 0.0, false, stabilisation);
    let shear = |x: [f64; 3]| 1e-3 * (TAU * x[1]).sin();
    let found = accelerations(&case, |x| [shear(x) - x[0], -x[1], 0.0], |_| DENSITY);
    // The 0.01 h^2 under the fraction takes off 0.01 B(2, 4) / (4 B(4, 4)) of it, from the integrals
    // over this kernel.
    let viscosity = (1.0 - 0.0175) * alpha * SOUND_SPEED * RATIO / cells / 8.0;
    let scale = viscosity * TAU * TAU * 1e-3;
    for (a, &x) in found.iter().zip(&case.positions) {
        if x[0].min(1.0 - x[0]).min(x[1]).min(1.0 - x[1]) > 2.0 * RATIO / cells {
            let expected = -viscosity * TAU * TAU * shear(x);
            assert!((a[0] - expected).abs() < 0.03 * scale, "{} {expected} at {x:?}", a[0]);
            assert!(a[1].abs() < 1e-9 * scale.max(1.0));
        }
    }
    // Nothing where all particles draw apart.
    let apart = accelerations(&case, |x| [x[0], x[1], 0.0], |_| DENSITY);
    assert!(apart.iter().flatten().all(|a| a.abs() < 1e-12));
}

#[test]
fn artificial_pressure_pushes_a_pair_under_tension_apart() {
    let spacing = 0.1;
    let pair = |strength: Option<f64>, distance: f64| {
        let case = Case {
            positions: vec![[0.4, 0.5, 0.0], [0.4 + distance, 0.5, 0.0]],
            spacing,
            is_periodic: false,
            stabilisation: Stabilisation {
                artificial_pressure: strength,
                ..Stabilisation::default()
            },
            physics: Physics::default(),
        };
        let mass = case.mass();
        (accelerations(&case, at_rest, |_| 0.99 * DENSITY), mass)
    };
    for distance in [0.07, 0.1, 0.13] {
        let ((with, mass), (without, _)) = (pair(Some(0.2), distance), pair(None, distance));
        let (w, f) = kernel_at(spacing, distance);
        let tension = 0.01 * DENSITY * SOUND_SPEED.powi(2) / (0.99 * DENSITY).powi(2);
        let ratio = w / kernel_at(spacing, spacing).0;
        let expected = -mass * 2.0 * 0.2 * tension * ratio.powi(4) * f * distance;
        for (i, sign) in [(0, -1.0), (1, 1.0)] {
            let push = with[i][0] - without[i][0];
            assert!((push / (sign * expected) - 1.0).abs() < 1e-10, "{push} {expected}");
        }
    }
}

#[test]
fn under_even_tension_particles_stay_where_they_are_with_tensile_control() {
    let most_inside = |tensile_control: bool| {
        let stabilisation = Stabilisation { tensile_control, ..Stabilisation::default() };
        let case = Case::square(16.0, 0.2, false, stabilisation);
        let found = accelerations(&case, at_rest, |_| 0.99 * DENSITY);
        let inside = case.positions.iter().zip(found).filter(|(x, _)| {
            let edge = x[0].min(1.0 - x[0]).min(x[1]).min(1.0 - x[1]);
            // Particles displaced over the edge come back on the other side: far from that.
            edge > 5.5 / 16.0
        });
        inside.fold(0.0, |most: f64, (_, a)| most.max(a[0].hypot(a[1])))
    };
    assert!(most_inside(false) > 1e-2);
    assert!(most_inside(true) < 1e-12, "{}", most_inside(true));
}

#[test]
fn particles_drift_down_the_gradient_of_their_concentration() {
    let speed = 0.7;
    let stabilisation = Stabilisation { shifting: Some(speed), ..Stabilisation::default() };
    let case = Case::square(20.0, 0.2, true, stabilisation);
    let (simulation, fields) = case.evaluate(at_rest, |_| DENSITY);
    let drift = by_number(&simulation, &fields, &fields.drift);
    let spacing = case.spacing;
    let reach = 2.0 * RATIO * spacing;
    let (at_spacing, _) = kernel_at(spacing, spacing);
    for (found, x) in drift.iter().zip(&case.positions) {
        let mut expected = [0.0; 2];
        for y in &case.positions {
            let d = [0, 1].map(|a| (x[a] - y[a]) - (x[a] - y[a]).round());
            let (w, f) = kernel_at(spacing, d[0].hypot(d[1]));
            for a in 0..2 {
                let weight = spacing * spacing * (1.0 + 0.2 * (w / at_spacing).powi(4));
                expected[a] -= speed * reach * weight * f * d[a];
            }
        }
        let most = 0.5 * speed / expected[0].hypot(expected[1]);
        let expected = expected.map(|e| e * most.min(1.0));
        for a in 0..2 {
            assert!((found[a] - expected[a]).abs() < 1e-11, "{found:?} {expected:?}");
        }
    }
}

#[test]
fn a_free_surface_does_not_drift_across_itself() {
    let stabilisation = Stabilisation { shifting: Some(1.0), ..Stabilisation::default() };
    let case = Case::square(20.0, 0.0, false, stabilisation);
    let (simulation, fields) = case.evaluate(at_rest, |_| DENSITY);
    let drift = by_number(&simulation, &fields, &fields.drift);
    for (drift, x) in drift.iter().zip(&case.positions) {
        // The uppermost row, far from corners: the surface is flat.
        if x[1] > 0.95 && (x[0] - 0.5).abs() < 0.2 {
            assert!(drift[0].hypot(drift[1]) < 1e-12, "{drift:?} at {x:?}");
        }
    }
}

#[test]
fn particles_of_walls_repel_what_is_nearer_than_a_spacing() {
    let spacing = 0.1;
    let strength = 1.7;
    let wall: Vec<_> = (0..20)
        .flat_map(|i| (0..4).map(move |j| (i, j)))
        .map(|(i, j)| [0.05 + 0.1 * f64::from(i), -0.05 - 0.1 * f64::from(j), 0.0])
        .collect();
    let at = [0.93, 0.03, 0.0];
    let case = |strength: Option<f64>| Case {
        positions: wall.iter().copied().chain([at]).collect(),
        spacing,
        is_periodic: false,
        stabilisation: Stabilisation { repulsion: strength, ..Stabilisation::default() },
        physics: Physics {
            bodies: vec![Shape::HalfSpace { point: [0.0; 3], outward: [0.0, 1.0, 0.0] }.into()],
            ..Physics::default()
        },
    };
    let acceleration =
        |strength| *accelerations(&case(strength), at_rest, |_| DENSITY).last().unwrap();
    let mut expected = [0.0; 2];
    for y in &wall {
        let d = [at[0] - y[0], at[1] - y[1]];
        let r = d[0].hypot(d[1]);
        if r < spacing {
            let force = strength * ((spacing / r).powi(4) - (spacing / r).powi(2)) / (r * r);
            expected = [0, 1].map(|a| expected[a] + force * d[a]);
        }
    }
    let (with, without) = (acceleration(Some(strength)), acceleration(None));
    assert!(expected[1] > 1.0);
    for a in 0..2 {
        assert!((with[a] - without[a] - expected[a]).abs() < 1e-10 * expected[1]);
    }
}

#[test]
fn an_acceleration_that_varies_is_asked_where_and_when_a_particle_is() {
    let mut case = Case::square(10.0, 0.2, true, Stabilisation::default());
    let field = |x: [f64; 3], t: f64| [x[0] * x[1] + t, (PI * x[0]).sin(), 0.0];
    case.physics.acceleration_field = Some(VectorField::new(field));
    for (a, &x) in accelerations(&case, at_rest, |_| DENSITY).iter().zip(&case.positions) {
        let expected = field(x, 0.0);
        assert!((a[0] - expected[0]).abs() < 1e-12 && (a[1] - expected[1]).abs() < 1e-12);
    }
    case.physics.acceleration_field = Some(VectorField::new(|_, t| [1.0 + t, 0.0, 0.0]));
    let (mut simulation, fields) = case.evaluate(at_rest, |_| DENSITY);
    simulation.advance(20).unwrap();
    let t = simulation.clock().time();
    let columns = simulation.columns();
    for &v in columns.values(fields.velocity[0]) {
        assert!((v - (t + 0.5 * t * t)).abs() < 1e-12, "{v} at {t}");
    }
}

#[test]
fn a_fringe_brings_the_fluid_to_its_velocity_and_leaves_the_rest_alone() {
    let mut case = Case::square(10.0, 0.2, true, Stabilisation::default());
    let velocity = VectorField::new(|[_, y, _], _| [1.0 + y, -2.0, 0.0]);
    // The weight is 1 from half of its length on, to three quarters.
    case.physics.fringe = Some(Fringe { from: 0.3, to: 0.9, rate: 7.0, velocity });
    let moving = |_: [f64; 3]| [0.5, 0.25, 0.0];
    let mut seen = [0; 3];
    for (a, &[x, y, _]) in accelerations(&case, moving, |_| DENSITY).iter().zip(&case.positions) {
        let full = [7.0 * (0.5 + y), 7.0 * -2.25];
        let (zone, least, most) = match x {
            0.6..=0.75 => (0, 1.0, 1.0),
            0.3..0.9 => (1, 0.0, 1.0),
            _ => (2, 0.0, 0.0),
        };
        seen[zone] += 1;
        let weight = a[1] / full[1];
        assert!((least - 1e-12..=most + 1e-12).contains(&weight), "{weight} at {x}");
        assert!((a[0] - weight * full[0]).abs() < 1e-12);
    }
    assert!(seen.iter().all(|&count| count > 0), "{seen:?}");
}

#[test]
fn elastic_energy_is_the_integral_of_the_pressure() {
    for equation in [
        StateEquation::Linear { background: 0.02 },
        StateEquation::Tait { exponent: 7.0, background: 0.01 },
        StateEquation::Tait { exponent: 1.0, background: 0.0 },
    ] {
        assert_eq!(equation.elastic_energy(1.0, SOUND_SPEED), 0.0);
        for ratio in [0.97, 1.0, 1.04] {
            let step = 1e-5;
            let [low, high] = [ratio - step, ratio + step]
                .map(|ratio| equation.elastic_energy(ratio, SOUND_SPEED));
            let slope = (high - low) / (2.0 * step * DENSITY);
            let rho = ratio * DENSITY;
            let expected = equation.pressure(rho, DENSITY, SOUND_SPEED) / (rho * rho);
            assert!((slope - expected).abs() < 1e-8, "{equation:?}: {slope} {expected}");
        }
    }
}
