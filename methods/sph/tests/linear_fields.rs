//! Gradients of linear fields: exact to round-off with the corrected gradient, however particles
//! lie, in the middle of the fluid and beside a free surface; and no force at all where the pressure
//! is constant.

use finegrain_framework::space::cells::Region;
use finegrain_framework::{Rate, Settings, Simulation, space::Cells};
use finegrain_sph::{
    Fields, Fluid, Gradient, Packing, Physics, PressureForm, Scheme, Sph, Start, StateEquation,
    Viscosity,
};

const DENSITY: f64 = 2.0;
const SOUND_SPEED: f64 = 3.0;
const VISCOSITY: f64 = 0.5;
/// Gradient of the velocity, `d v_a / d x_b`, 1/s.
const SHEAR: [[f64; 3]; 3] = [[0.3, -1.2, 0.7], [0.5, 0.4, -0.8], [-0.6, 0.9, 1.1]];
/// Gradient of the density, kg/m^4.
const SLOPE: [f64; 3] = [0.03, -0.05, 0.02];
/// Background pressure in units of `rho c^2`.
const BACKGROUND: f64 = 1.0;

fn scheme(gradient: Gradient) -> Scheme {
    Scheme { gradient, pressure_form: PressureForm::Antisymmetric, ..Scheme::default() }
}

/// The first evaluation for a free ball of particles, far off a lattice, with a velocity and a
/// density that vary linearly.
fn ball(
    dims: usize,
    viscosity: Option<Viscosity>,
    gradient: Gradient,
    slope: [f64; 3],
) -> (Simulation<Cells<f64>>, Fields<f64>) {
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
    let velocity =
        |x: &[f64; 3]| std::array::from_fn(|a| (0..dims).map(|b| SHEAR[a][b] * x[b]).sum::<f64>());
    let start = Start {
        region: Region {
            lower: vec![-0.5; dims],
            upper: vec![0.5; dims],
            periodic: vec![false; dims],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        velocities: positions.iter().map(velocity).collect(),
        positions: positions.clone(),
    };
    let fluid = Fluid {
        density: DENSITY,
        sound_speed: SOUND_SPEED,
        kinematic_viscosity: VISCOSITY,
        state_equation: StateEquation::Linear { background: BACKGROUND },
    };
    let physics = Physics { viscosity, ..Physics::default() };
    let mut sph = Sph::<f64>::new(&start, &fluid, &physics, &scheme(gradient)).unwrap();
    let density = sph.model.columns.values_mut(sph.fields.density);
    for (rho, x) in density.iter_mut().zip(&positions) {
        *rho = DENSITY + (0..dims).map(|a| slope[a] * x[a]).sum::<f64>();
    }
    let mut simulation = Simulation::new(sph.model, Settings::default()).unwrap();
    simulation.begin().unwrap();
    (simulation, sph.fields)
}

/// Largest difference of a rate from what `exact` makes of a particle's density, over the largest
/// of these.
fn error(
    simulation: &Simulation<Cells<f64>>,
    fields: &Fields<f64>,
    rate: Rate<f64>,
    exact: impl Fn(f64) -> f64,
) -> f64 {
    let columns = simulation.columns();
    let (mut worst, mut scale) = (0.0f64, 0.0f64);
    for (&computed, &rho) in columns.values(rate).iter().zip(columns.values(fields.density)) {
        worst = worst.max((computed - exact(rho)).abs());
        scale = scale.max(exact(rho).abs());
    }
    worst / scale
}

#[test]
fn constant_pressure_makes_no_force_at_all() {
    for gradient in [Gradient::Kernel, Gradient::Corrected] {
        for dims in [2, 3] {
            let (simulation, fields) = ball(dims, None, gradient, [0.0; 3]);
            let columns = simulation.columns();
            let pressure = columns.values(fields.pressure.unwrap());
            assert!(pressure.iter().all(|&p| p == BACKGROUND * DENSITY * SOUND_SPEED.powi(2)));
            for &a in &fields.acceleration {
                assert!(columns.values(a).iter().all(|&a| a == 0.0), "{gradient:?} {dims}-D");
            }
        }
    }
}

/// Errors of the accelerations by a linear pressure, `- c^2 grad rho / rho`.
fn errors_of_pressure(dims: usize, gradient: Gradient) -> Vec<f64> {
    let (simulation, fields) = ball(dims, None, gradient, SLOPE);
    let of = |a: usize| {
        let exact = |rho| -SOUND_SPEED.powi(2) * SLOPE[a] / rho;
        error(&simulation, &fields, fields.acceleration[a], exact)
    };
    (0..dims).map(of).collect()
}

#[test]
fn pressure_gradient_is_exact_only_if_corrected() {
    for dims in [2, 3] {
        for error in errors_of_pressure(dims, Gradient::Corrected) {
            assert!(error < 1e-11, "{dims}-D: {error:e}");
        }
        for error in errors_of_pressure(dims, Gradient::Kernel) {
            assert!(error > 0.1, "{dims}-D: {error:e}");
        }
    }
}

/// Error of the rate of the density in a linear flow, `-rho div v`.
fn error_of_continuity(dims: usize, gradient: Gradient) -> f64 {
    let (simulation, fields) = ball(dims, None, gradient, SLOPE);
    let divergence: f64 = (0..dims).map(|a| SHEAR[a][a]).sum();
    error(&simulation, &fields, fields.density_rate.unwrap(), |rho| -rho * divergence)
}

#[test]
fn divergence_is_exact_only_if_corrected() {
    for dims in [2, 3] {
        let exact = error_of_continuity(dims, Gradient::Corrected);
        assert!(exact < 1e-12, "{dims}-D: {exact:e}");
        let plain = error_of_continuity(dims, Gradient::Kernel);
        assert!(plain > 0.1, "{dims}-D: {plain:e}");
    }
}

/// Errors of the components of `mu epsilon / rho^2` in a linear flow.
fn errors_of_strain_rate(dims: usize, gradient: Gradient) -> Vec<f64> {
    let (simulation, fields) = ball(dims, Some(Viscosity::StrainRate), gradient, SLOPE);
    let divergence: f64 = (0..dims).map(|a| SHEAR[a][a]).sum();
    let components = (0..dims).flat_map(|a| (0..=a).map(move |b| (a, b)));
    let errors = components.zip(&fields.stress_term).map(|((a, b), &stress)| {
        let trace = if a == b { 2.0 / 3.0 * divergence } else { 0.0 };
        let strain_rate = SHEAR[a][b] + SHEAR[b][a] - trace;
        error(&simulation, &fields, stress, |rho| DENSITY * VISCOSITY * strain_rate / (rho * rho))
    });
    errors.collect()
}

#[test]
fn strain_rate_is_exact_only_if_corrected() {
    for (dims, components) in [(2, 3), (3, 6)] {
        let exact = errors_of_strain_rate(dims, Gradient::Corrected);
        assert_eq!(exact.len(), components);
        for error in exact {
            assert!(error < 1e-11, "{dims}-D: {error:e}");
        }
        for error in errors_of_strain_rate(dims, Gradient::Kernel) {
            assert!(error > 0.1, "{dims}-D: {error:e}");
        }
    }
}
