//! Each term against the derivative it stands for, on smooth fields with known derivatives: a
//! wrong sign, factor or component fails, and the error falls with the spacing.

use std::f64::consts::TAU;

use finegrain_framework::space::cells::Region;
use finegrain_framework::{Settings, Simulation};
use finegrain_sph::{
    Density, Edac, Fields, Fluid, Packing, Physics, PressureForm, Scheme, Sph, Start,
    StateEquation, Viscosity,
};

const DENSITY: f64 = 2.0;
const SOUND_SPEED: f64 = 3.0;
const VISCOSITY: f64 = 0.5;

/// A velocity with shear and compression in all components.
fn velocity([x, y, z]: [f64; 3], dims: usize) -> [f64; 3] {
    let z = if dims == 3 { z } else { 0.0 };
    [
        (TAU * y).sin() + 0.5 * (TAU * (x + z)).cos(),
        (TAU * x).cos() + 0.3 * (TAU * y).sin(),
        if dims == 3 { (TAU * (x + y)).sin() } else { 0.0 },
    ]
}

/// `d v_a / d x_b` by differences fine enough to count as exact here.
fn gradient(x: [f64; 3], dims: usize) -> [[f64; 3]; 3] {
    let step = 1e-4;
    let mut gradient = [[0.0; 3]; 3];
    for b in 0..dims {
        let (mut low, mut high) = (x, x);
        low[b] -= step;
        high[b] += step;
        let (low, high) = (velocity(low, dims), velocity(high, dims));
        for a in 0..dims {
            gradient[a][b] = (high[a] - low[a]) / (2.0 * step);
        }
    }
    gradient
}

/// `div(grad v + grad v^T - 2/3 div v)`, and `div grad v`.
fn viscous(x: [f64; 3], dims: usize) -> ([f64; 3], [f64; 3]) {
    let step = 1e-3;
    let (mut full, mut laplacian) = ([0.0; 3], [0.0; 3]);
    for b in 0..dims {
        let (mut low, mut high) = (x, x);
        low[b] -= step;
        high[b] += step;
        let (low, high) = (gradient(low, dims), gradient(high, dims));
        let trace = |g: [[f64; 3]; 3]| g[0][0] + g[1][1] + g[2][2];
        for a in 0..dims {
            let along = |f: fn(&[[f64; 3]; 3], usize, usize) -> f64| {
                (f(&high, a, b) - f(&low, a, b)) / (2.0 * step)
            };
            laplacian[a] += along(|g, a, b| g[a][b]);
            full[a] += along(|g, a, b| g[a][b] + g[b][a]);
            if a == b {
                full[a] -= 2.0 / 3.0 * (trace(high) - trace(low)) / (2.0 * step);
            }
        }
    }
    (full, laplacian)
}

struct Rates {
    position: Vec<[f64; 3]>,
    acceleration: Vec<[f64; 3]>,
    density_rate: Option<Vec<f64>>,
    energy_rate: Option<Vec<f64>>,
    density: Vec<f64>,
    pressure_rate: Option<Vec<f64>>,
    drift: Vec<[f64; 3]>,
}

/// The initial rates of a periodic unit box.
fn rates(
    dims: usize,
    cells: f64,
    physics: &Physics,
    density: impl Fn([f64; 3]) -> f64,
    moving: bool,
) -> Rates {
    // A wider kernel: the lattice sums are then exact to a part in a thousand.
    let scheme = Scheme { smoothing_ratio: 1.4, ..Scheme::default() };
    rates_of(dims, cells, 0.0, physics, &scheme, density, |_| 0.0, moving)
}

/// The initial rates with any scheme, for particles that are displaced by a wave of compression
/// along x, and with a pressure that evolves by itself where the scheme has that.
#[allow(clippy::too_many_arguments)]
fn rates_of(
    dims: usize,
    cells: f64,
    displacement: f64,
    physics: &Physics,
    scheme: &Scheme,
    density: impl Fn([f64; 3]) -> f64,
    pressure: impl Fn([f64; 3]) -> f64,
    moving: bool,
) -> Rates {
    let packing = if dims == 3 { Packing::Cubic } else { Packing::Square };
    let spacing = 1.0 / cells;
    let lattice = packing.fit([1.0; 3], spacing).unwrap();
    let positions: Vec<_> =
        lattice.positions().map(|[x, y, z]| [x + displacement * (TAU * x).sin(), y, z]).collect();
    let start = Start {
        region: Region {
            lower: vec![0.0; dims],
            upper: vec![1.0; dims],
            periodic: vec![true; dims],
        },
        spacing,
        particle_volume: lattice.volume_per_particle(),
        velocities: if moving {
            positions.iter().map(|&x| velocity(x, dims)).collect()
        } else {
            Vec::new()
        },
        positions: positions.clone(),
    };
    let fluid = Fluid {
        density: DENSITY,
        sound_speed: SOUND_SPEED,
        kinematic_viscosity: VISCOSITY,
        state_equation: StateEquation::Linear { background: 0.0 },
    };
    let Sph { mut model, fields, .. } = Sph::<f64>::new(&start, &fluid, physics, scheme).unwrap();
    if let Some(column) = fields.pressure {
        for (p, &x) in model.columns.values_mut(column).iter_mut().zip(&positions) {
            *p = pressure(x);
        }
    }
    for (rho, &x) in model.columns.values_mut(fields.density).iter_mut().zip(&positions) {
        *rho = density(x);
    }
    let mut simulation = Simulation::new(model, Settings::default()).unwrap();
    simulation.begin().unwrap();
    let columns = simulation.columns();
    let Fields { position, acceleration, density_rate, energy_rate, .. } = fields;
    let vector = |column: &[finegrain_framework::Rate<f64>], i: usize| {
        std::array::from_fn(|a| column.get(a).map_or(0.0, |&c| columns.values(c)[i]))
    };
    let all = 0..columns.points();
    let at = |i: usize, a: usize| position.get(a).map_or(0.0, |&c| columns.values(c)[i]);
    Rates {
        position: all.clone().map(|i| std::array::from_fn(|a| at(i, a))).collect(),
        acceleration: all.clone().map(|i| vector(&acceleration, i)).collect(),
        drift: all.map(|i| vector(&fields.drift, i)).collect(),
        density: columns.values(fields.density).to_vec(),
        density_rate: density_rate.map(|rate| columns.values(rate).to_vec()),
        pressure_rate: fields.pressure_rate.map(|rate| columns.values(rate).to_vec()),
        energy_rate: energy_rate.map(|e| columns.values(e).to_vec()),
    }
}

/// Relative L2 error of one list of vectors against another.
fn error(computed: &[[f64; 3]], exact: impl Iterator<Item = [f64; 3]>) -> f64 {
    let (mut difference, mut norm) = (0.0, 0.0);
    for (c, e) in computed.iter().zip(exact) {
        for a in 0..3 {
            difference += (c[a] - e[a]).powi(2);
            norm += e[a].powi(2);
        }
    }
    (difference / norm).sqrt()
}

/// Checks that the error at `cells` is below `bound` and falls at second order.
fn falls(error_at: impl Fn(f64) -> f64, cells: f64, bound: f64) {
    let (coarse, fine) = (error_at(0.5 * cells), error_at(cells));
    assert!(fine < bound, "error {fine:.4}, bound {bound}");
    let order = (coarse / fine).log2();
    assert!((1.7..2.3).contains(&order), "order {order:.2} from {coarse:.4} to {fine:.4}");
}

fn resolutions(dims: usize) -> (f64, f64) {
    if dims == 3 { (24.0, 0.07) } else { (48.0, 0.02) }
}

#[test]
fn continuity_is_minus_density_times_divergence() {
    for dims in [2, 3] {
        let (cells, bound) = resolutions(dims);
        let error_at = |cells| {
            let rates = rates(dims, cells, &Physics::default(), |_| DENSITY, true);
            let exact = rates.position.iter().map(|&x| {
                let g = gradient(x, dims);
                [-DENSITY * (g[0][0] + g[1][1] + g[2][2]), 0.0, 0.0]
            });
            let computed: Vec<_> =
                rates.density_rate.unwrap().iter().map(|&r| [r, 0.0, 0.0]).collect();
            error(&computed, exact)
        };
        falls(error_at, cells, bound);
    }
}

#[test]
fn pressure_gradient_accelerates_down_the_slope() {
    for dims in [2, 3] {
        let (cells, bound) = resolutions(dims);
        let amplitude = 1e-3;
        let error_at = |cells| {
            let density = |x: [f64; 3]| DENSITY * (1.0 + amplitude * (TAU * x[0]).sin());
            let rates = rates(dims, cells, &Physics::default(), density, false);
            let exact = rates.position.iter().map(|&x| {
                [-SOUND_SPEED * SOUND_SPEED * amplitude * TAU * (TAU * x[0]).cos(), 0.0, 0.0]
            });
            error(&rates.acceleration, exact)
        };
        // To first order in the amplitude, which is 1e-3.
        falls(error_at, cells, bound);
    }
}

#[test]
fn strain_rate_form_is_the_divergence_of_the_viscous_stress() {
    for dims in [2, 3] {
        // Finer than for one derivative: at 12 points a wave the kernel smooths away a third.
        let (cells, bound) = if dims == 3 { (36.0, 0.03) } else { (48.0, 0.02) };
        let error_at = |cells| {
            let physics = Physics { viscosity: Some(Viscosity::StrainRate), ..Physics::default() };
            let rates = rates(dims, cells, &physics, |_| DENSITY, true);
            let exact = rates.position.iter().map(|&x| viscous(x, dims).0.map(|f| VISCOSITY * f));
            error(&rates.acceleration, exact)
        };
        // Two derivatives smoothed by the kernel one after the other: twice its error.
        falls(error_at, cells, 2.5 * bound);
    }
}

#[test]
fn morris_form_is_the_laplacian_of_a_solenoidal_field() {
    let error_at = |cells: f64| {
        let physics = Physics { viscosity: Some(Viscosity::Morris), ..Physics::default() };
        let rates = rates(2, cells, &physics, |_| DENSITY, true);
        let exact = rates.position.iter().map(|&x| viscous(x, 2).1.map(|f| VISCOSITY * f));
        error(&rates.acceleration, exact)
    };
    // eta^2 = 0.01 h^2 weakens it by about 2 % however fine the lattice: not of second order.
    assert!(error_at(48.0) < 0.03, "{}", error_at(48.0));
}

#[test]
fn monaghan_form_is_the_laplacian_and_twice_the_gradient_of_the_divergence() {
    for dims in [2, 3] {
        let physics = Physics { viscosity: Some(Viscosity::Monaghan), ..Physics::default() };
        // A wide kernel: x x / r^2 is not smooth where the particle itself is, and sums over a lattice
        // are the nearer to integrals the less that place weighs.
        let scheme = Scheme { smoothing_ratio: 2.0, ..Scheme::default() };
        let rates = rates_of(dims, 48.0, 0.0, &physics, &scheme, |_| DENSITY, |_| 0.0, true);
        let exact = rates.position.iter().map(|&x| {
            // The full divergence of the stress has a third of the gradient of the divergence.
            let (full, laplacian) = viscous(x, dims);
            std::array::from_fn(|a| {
                let gradient = 3.0 * (full[a] - laplacian[a]);
                VISCOSITY * (laplacian[a] + 2.0 * gradient)
            })
        });
        let error = error(&rates.acceleration, exact);
        // As that of Morris is, it is weakened by eta^2.
        assert!(error < 0.03, "{dims}-D: {error}");
    }
}

#[test]
fn energy_is_heated_by_shear() {
    let physics =
        Physics { viscosity: Some(Viscosity::StrainRate), energy: true, ..Physics::default() };
    let error_at = |cells| {
        let rates = rates(2, cells, &physics, |_| DENSITY, true);
        let exact = rates.position.iter().map(|&x| {
            let g = gradient(x, 2);
            let divergence = g[0][0] + g[1][1];
            let mut contraction = 0.0;
            for a in 0..2 {
                for b in 0..2 {
                    let trace = if a == b { 2.0 / 3.0 * divergence } else { 0.0 };
                    contraction += (g[a][b] + g[b][a] - trace).powi(2);
                }
            }
            [0.5 * VISCOSITY * contraction, 0.0, 0.0]
        });
        let computed: Vec<_> =
            rates.energy_rate.as_ref().unwrap().iter().map(|&e| [e, 0.0, 0.0]).collect();
        error(&computed, exact)
    };
    falls(error_at, 48.0, 0.05);
}

#[test]
fn energy_is_raised_by_compression_without_viscosity() {
    let excess = 0.2;
    let error_at = |cells| {
        let physics = Physics { energy: true, ..Physics::default() };
        let density = DENSITY * (1.0 + excess);
        let rates = rates(2, cells, &physics, |_| density, true);
        let pressure = SOUND_SPEED * SOUND_SPEED * DENSITY * excess;
        // Particles keep their mass, so that at this density they fill less than the box: sums
        // over masses are those of the reference density.
        let filled = DENSITY / density;
        let exact = rates.position.iter().map(|&x| {
            let g = gradient(x, 2);
            [-pressure / density * (g[0][0] + g[1][1]) * filled, 0.0, 0.0]
        });
        let computed: Vec<_> =
            rates.energy_rate.as_ref().unwrap().iter().map(|&e| [e, 0.0, 0.0]).collect();
        error(&computed, exact)
    };
    falls(error_at, 48.0, 0.02);
}

#[test]
fn equations_of_state_are_their_closed_forms() {
    let tait = StateEquation::Tait { exponent: 7.0, background: 0.1 };
    let stiffness = SOUND_SPEED * SOUND_SPEED * DENSITY;
    let expected = stiffness * ((1.01f64.powi(7) - 1.0) / 7.0 + 0.1);
    let pressure = tait.pressure(1.01 * DENSITY, DENSITY, SOUND_SPEED);
    assert!((pressure / expected - 1.0).abs() < 1e-12);
    let linear = StateEquation::Linear { background: 0.0 };
    let pressure = linear.pressure(1.01 * DENSITY, DENSITY, SOUND_SPEED);
    assert!((pressure / (0.01 * stiffness) - 1.0).abs() < 1e-10);
}

/// Density as a sum, pressure that evolves by itself, and transport velocity.
fn edac() -> Scheme {
    Scheme {
        smoothing_ratio: 1.4,
        density: Density::Summation,
        edac: Some(Edac { diffusion: 0.5 }),
        pressure_form: PressureForm::DensityWeighted,
        transport: 1.0,
        ..Scheme::default()
    }
}

#[test]
fn density_as_a_sum_is_that_of_the_displaced_particles() {
    let displacement = 0.01;
    let error_at = |cells| {
        let rates = rates_of(
            2,
            cells,
            displacement,
            &Physics::default(),
            &edac(),
            |_| DENSITY,
            |_| 0.0,
            false,
        );
        // x + d sin(2 pi x) squeezes by 1 + 2 pi d cos(2 pi x); x is found by iteration.
        let excess = |y: f64| {
            let x = (0..50).fold(y, |x, _| y - displacement * (TAU * x).sin());
            1.0 / (1.0 + TAU * displacement * (TAU * x).cos()) - 1.0
        };
        let exact = rates.position.iter().map(|&x| [excess(x[0]), 0.0, 0.0]);
        let computed: Vec<_> =
            rates.density.iter().map(|&rho| [rho / DENSITY - 1.0, 0.0, 0.0]).collect();
        error(&computed, exact)
    };
    falls(error_at, 48.0, 0.02);
}

#[test]
fn drift_goes_down_the_slope_of_the_density() {
    // -tau p_b / rho_0 grad n / n, with tau = 0.25 h / c and p_b = rho_0 c^2: to first order in the
    // displacement.
    let displacement = 1e-4;
    let error_at = |cells: f64| {
        let physics = Physics::default();
        let rates =
            rates_of(2, cells, displacement, &physics, &edac(), |_| DENSITY, |_| 0.0, false);
        let strength = 0.25 * 1.4 / cells * SOUND_SPEED;
        let exact = rates
            .position
            .iter()
            .map(|x| [-strength * TAU * TAU * displacement * (TAU * x[0]).sin(), 0.0, 0.0]);
        error(&rates.drift, exact)
    };
    // Where the Gaussian is cut off leaves an error that does not fall.
    let (coarse, fine) = (error_at(24.0), error_at(48.0));
    assert!(fine < 0.02 && fine < 0.5 * coarse, "errors {coarse}, {fine}");
}

#[test]
fn weighted_pressure_gradient_and_viscosity_are_the_derivatives() {
    let pressure = |x: [f64; 3]| (TAU * x[0]).sin() * (TAU * x[1]).cos();
    let error_at = |cells| {
        let physics = Physics { viscosity: Some(Viscosity::Adami), ..Physics::default() };
        let rates = rates_of(2, cells, 0.0, &physics, &edac(), |_| DENSITY, pressure, true);
        let exact = rates.position.iter().map(|&x| {
            let gradient = [
                TAU * (TAU * x[0]).cos() * (TAU * x[1]).cos(),
                -TAU * (TAU * x[0]).sin() * (TAU * x[1]).sin(),
                0.0,
            ];
            let viscous = viscous(x, 2).1;
            std::array::from_fn(|a| -gradient[a] / DENSITY + VISCOSITY * viscous[a])
        });
        error(&rates.acceleration, exact)
    };
    falls(error_at, 48.0, 0.02);
}

#[test]
fn drift_carries_momentum() {
    // The difference that transport makes to the acceleration is div(rho v w) / rho.
    let displacement = 1e-3;
    let physics = Physics::default();
    let error_at = |cells: f64| {
        let of = |scheme: &Scheme| {
            rates_of(2, cells, displacement, &physics, scheme, |_| DENSITY, |_| 0.0, true)
        };
        let (with, without) = (of(&edac()), of(&Scheme { transport: 0.0, ..edac() }));
        let computed: Vec<_> = (with.acceleration.iter().zip(&without.acceleration))
            .map(|(a, b)| [a[0] - b[0], a[1] - b[1], 0.0])
            .collect();
        let strength = 0.25 * 1.4 / cells * SOUND_SPEED * TAU * TAU * displacement;
        let exact = with.position.iter().map(|&x| {
            let (v, g) = (velocity(x, 2), gradient(x, 2));
            // w = -strength sin(2 pi x) along x, to first order in the displacement.
            let w = -strength * (TAU * x[0]).sin();
            let slope = -strength * TAU * (TAU * x[0]).cos();
            [v[0] * slope + w * g[0][0], v[1] * slope + w * g[1][0], 0.0]
        });
        error(&computed, exact)
    };
    let (coarse, fine) = (error_at(24.0), error_at(48.0));
    assert!(fine < 0.05 && fine < coarse, "errors {coarse}, {fine}");
}

#[test]
fn pressure_evolves_by_compression_and_diffusion() {
    let pressure = |x: [f64; 3]| 30.0 * (TAU * x[0]).sin() * (TAU * x[1]).cos();
    let error_at = |cells: f64| {
        // Strong diffusion, so that it shows beside the compression.
        let scheme = Scheme { edac: Some(Edac { diffusion: 4.0 }), transport: 0.0, ..edac() };
        let rates =
            rates_of(2, cells, 0.0, &Physics::default(), &scheme, |_| DENSITY, pressure, true);
        let diffusivity = 4.0 * 1.4 / cells * SOUND_SPEED / 8.0;
        let exact = rates.position.iter().map(|&x| {
            let g = gradient(x, 2);
            let compression = -DENSITY * SOUND_SPEED * SOUND_SPEED * (g[0][0] + g[1][1]);
            [compression - 2.0 * TAU * TAU * diffusivity * pressure(x), 0.0, 0.0]
        });
        let computed: Vec<_> =
            rates.pressure_rate.as_ref().unwrap().iter().map(|&r| [r, 0.0, 0.0]).collect();
        error(&computed, exact)
    };
    falls(error_at, 48.0, 0.02);
}

#[test]
fn pressure_changes_by_what_particles_drift_into() {
    let pressure = |x: [f64; 3]| 30.0 * (TAU * x[0]).cos();
    let displacement = 1e-3;
    let error_at = |cells: f64| {
        let of = |transport: f64| {
            let scheme = Scheme { transport, ..edac() };
            rates_of(
                2,
                cells,
                displacement,
                &Physics::default(),
                &scheme,
                |_| DENSITY,
                pressure,
                false,
            )
        };
        let (with, without) = (of(1.0), of(0.0));
        let computed: Vec<_> = (with.pressure_rate.unwrap().iter())
            .zip(&without.pressure_rate.unwrap())
            .map(|(a, b)| [a - b, 0.0, 0.0])
            .collect();
        let strength = 0.25 * 1.4 / cells * SOUND_SPEED * TAU * TAU * displacement;
        let exact = with.position.iter().map(|x| {
            let wave = (TAU * x[0]).sin();
            [strength * wave * 30.0 * TAU * wave, 0.0, 0.0]
        });
        error(&computed, exact)
    };
    let (coarse, fine) = (error_at(24.0), error_at(48.0));
    assert!(fine < 0.05 && fine < coarse, "errors {coarse}, {fine}");
}
