//! How long a time step may be.

use std::f64::consts::PI;

use finegrain_framework::Integrator;
use num_complex::Complex64;

use crate::boundary::Boundary;
use crate::error::{FdError, positive};
use crate::line::{Ends, Line};
use crate::mesh::{AXES, Mesh, Spread};
use crate::operator::face::Face;
use crate::operator::sbp::Closure;
use crate::operator::staggered::StaggeredOrder;
use crate::operator::{Order, central, value};

/// By how much a time step may exceed its limit: rounding of how it was computed.
const ROUNDING: f64 = 1e-12;

/// Refuses a time step that is not stable.
pub(crate) fn check_time_step(time_step: f64, limit: f64, scheme: String) -> Result<(), FdError> {
    positive("time_step", time_step)?;
    if time_step > limit * (1.0 + ROUNDING) {
        return Err(FdError::TimeStep { time_step, limit, scheme });
    }
    Ok(())
}

/// Refuses a mesh that does not go with stencils of an order.
pub(crate) fn check_mesh(mesh: &Mesh, order: Order) -> Result<(), FdError> {
    mesh.check(|spread| match (spread, Closure::of(order)) {
        // Closures of both ends stay apart; of order 2, penalties reach three points.
        (Spread::Ends, Some(closure)) => 2 * closure.rows().max(3) + 2,
        _ => 2 * order.reach() + 1,
    })
}

/// `|1 + z + ... + z^s / s!|`: what a step makes of a wave that grows as `z = lambda dt` says. All
/// Runge-Kutta methods of `s` stages and order `s` have this one; leapfrog has it with 2, by how it
/// predicts, for decay up to 1 only.
fn amplification(integrator: Integrator, z: Complex64) -> f64 {
    let stages = match integrator {
        Integrator::Euler | Integrator::SymplecticEuler => 1,
        Integrator::Leapfrog | Integrator::Rk2 => 2,
        Integrator::SspRk3 => 3,
        Integrator::Rk4 => 4,
    };
    let mut term = Complex64::from(1.0);
    let mut sum = term;
    for k in 1..=stages {
        term *= z / f64::from(k);
        sum += term;
    }
    sum.norm()
}

/// The largest factor up to which no wave is amplified, `lambda(angle)` being its rate; 0 if there is
/// none.
fn largest_factor(integrator: Integrator, lambda: impl Fn(f64) -> Complex64) -> f64 {
    let rates: Vec<_> = (1..=720).map(|k| lambda(PI * f64::from(k) / 720.0)).collect();
    let is_stable = |factor: f64| {
        rates.iter().all(|&rate| amplification(integrator, rate * factor) <= 1.0 + 1e-10)
    };
    let (mut stable, mut factor) = (0.0, 1e-3);
    while is_stable(factor) && factor < 100.0 {
        stable = factor;
        factor *= 1.01;
    }
    if stable == 0.0 {
        return 0.0;
    }
    for _ in 0..40 {
        let middle = 0.5 * (stable + factor);
        *if is_stable(middle) { &mut stable } else { &mut factor } = middle;
    }
    stable
}

/// How fast a decay an integrator takes: the largest `k dt` of `y' = -k y`.
pub(crate) fn decay_extent(integrator: Integrator) -> f64 {
    if integrator == Integrator::Leapfrog {
        // Its corrected prediction is stable up to 1 (see the integrator).
        return 1.0;
    }
    largest_factor(integrator, |angle| Complex64::from(-angle / PI))
}

/// How waves along an axis turn and decay, both over the most: the curve in the plane of complex rates
/// `-decay + i turn` that the angle from 0 to pi traces, its other half being the mirror image.
#[derive(Clone, Debug)]
pub(crate) struct Symbol(Vec<[f64; 2]>);

impl Symbol {
    /// Of staggered central differences.
    pub fn new(order: StaggeredOrder) -> Self {
        const ANGLES: u32 = 360;
        let angles = (0..=ANGLES).map(|k| PI * f64::from(k) / f64::from(ANGLES));
        let of = |angle: f64| match order {
            StaggeredOrder::Second => [angle.sin(), 0.5 * (1.0 - angle.cos())],
            StaggeredOrder::Fourth => {
                let turn = 9.0 / 8.0 * angle.sin() - (3.0 * angle).sin() / 24.0;
                let decay = 2.5 - 8.0 / 3.0 * angle.cos() + (2.0 * angle).cos() / 6.0;
                [turn / (7.0 / 6.0), decay / (16.0 / 3.0)]
            }
        };
        Self(angles.map(of).collect())
    }

    /// The point furthest in the direction `(nx, ny)`, `ny` not below 0, where waves turn at rates up to
    /// `turn` and decay at rates up to `decay`.
    fn furthest(&self, turn: f64, decay: f64, nx: f64, ny: f64) -> Complex64 {
        if turn == 0.0 && decay == 0.0 {
            return Complex64::ZERO;
        }
        let (mut most, mut furthest) = (f64::NEG_INFINITY, Complex64::ZERO);
        for &[y, x] in &self.0 {
            let at = Complex64::new(-decay * x, turn * y);
            let distance = at.re * nx + at.im * ny;
            if distance > most {
                (most, furthest) = (distance, at);
            }
        }
        furthest
    }
}

/// The longest stable time step, s, of advection and diffusion by central differences together: along
/// each axis waves oscillate at rates up to `turns` and decay at rates up to `decays`, 1/s. What all axes
/// together come to lies in the sum of their symbols' hulls, whose rim must be stable.
pub(crate) fn advection_diffusion_limit(
    integrator: Integrator,
    symbol: &Symbol,
    turns: [f64; 3],
    decays: [f64; 3],
) -> f64 {
    const RIM: usize = 180;
    let rim: Vec<Complex64> = (0..=RIM)
        .map(|k| {
            // Directions lie closer about that of the origin, which the rim only touches.
            let closer = 0.5 * (1.0 - (PI * k as f64 / RIM as f64).cos());
            let (ny, nx) = (PI * closer).sin_cos();
            let points = turns.iter().zip(&decays);
            points.map(|(&turn, &decay)| symbol.furthest(turn, decay, nx, ny)).sum()
        })
        .collect();
    let largest = rim.iter().map(|rate| rate.norm()).fold(f64::MIN_POSITIVE, f64::max);
    // No integrator here takes more than 4 of either.
    let (mut stable, mut limit) = (0.0, 4.0 / largest);
    for _ in 0..24 {
        let middle = 0.5 * (stable + limit);
        let is_stable =
            rim.iter().all(|&rate| amplification(integrator, rate * middle) <= 1.0 + 1e-10);
        *if is_stable { &mut stable } else { &mut limit } = middle;
    }
    stable
}

/// The largest Courant number, `|v| dt / h` summed over the axes, with which advection is stable: of
/// WENO schemes that of the linear one of their order.
pub(crate) fn advection_limit(face: Face, integrator: Integrator) -> Result<f64, FdError> {
    // Coefficients of the value right of point 0, of points -2 to 2.
    let coefficients = match face {
        Face::Upwind1 => [0.0, 0.0, 1.0, 0.0, 0.0],
        Face::Upwind3 => [0.0, -1.0 / 6.0, 5.0 / 6.0, 2.0 / 6.0, 0.0],
        Face::Weno5 | Face::Weno5Z => {
            [2.0 / 60.0, -13.0 / 60.0, 47.0 / 60.0, 27.0 / 60.0, -3.0 / 60.0]
        }
    };
    let limit = largest_factor(integrator, |angle| {
        let wave = |shift: f64| Complex64::from_polar(1.0, shift * angle);
        let face: Complex64 =
            (-2i32..).zip(coefficients).map(|(i, c)| wave(f64::from(i)) * c).sum();
        -face * (1.0 - wave(-1.0))
    });
    // Slow growth of long waves passes for stable up to some 1e-3 without being so.
    if limit < 0.01 || integrator == Integrator::Leapfrog {
        let scheme = format!("{} with {}", face.name(), integrator.name());
        return Err(FdError::NeverStable { scheme });
    }
    Ok(limit)
}

/// The largest eigenvalue of minus the Laplacian, 1/m^2, with its boundary conditions.
pub(crate) fn laplacian_radius(
    mesh: &Mesh,
    order: Order,
    boundary: &Boundary,
) -> Result<f64, FdError> {
    check_mesh(mesh, order)?;
    boundary.check(mesh)?;
    let mut radius = 0.0;
    for ((side, conditions), axis) in mesh.sides().iter().zip(&boundary.0).zip(AXES) {
        if side.spread == Spread::Ends {
            for (condition, end) in conditions.iter().zip(["lower", "upper"]) {
                if condition.factors().is_none() {
                    let cause = "a second derivative needs one".to_owned();
                    return Err(FdError::Condition { axis, end, cause });
                }
            }
        }
        let h = side.spacing();
        // The shortest wave.
        let terms = central::second_derivative(order).into_iter().zip(1..);
        let inside: f64 =
            terms.map(|(b, k)| 2.0 * value(b) * (1.0 - (PI * f64::from(k)).cos())).sum();
        let line = Line::<f64>::new(side, order, conditions)?;
        radius += match line.ends {
            Ends::Closed(_) => closed_radius(&line, order, h).max(inside / (h * h)),
            _ => inside / (h * h),
        };
    }
    Ok(radius)
}

/// How fast an oscillation an integrator takes: the largest `w dt` of `y' = i w y`; with closed ends, where what
/// oscillates may decay as well, of all rates of that size that do not grow.
pub(crate) fn oscillation_extent(integrator: Integrator, mesh: &Mesh) -> Result<f64, FdError> {
    let is_closed = mesh.sides().iter().any(|side| side.spread == Spread::Ends);
    let extent = largest_factor(integrator, |angle| match is_closed {
        true => Complex64::from_polar(1.0, 0.5 * (PI + angle)),
        false => Complex64::new(0.0, angle / PI),
    });
    if extent < 0.01 || integrator == Integrator::Leapfrog {
        let scheme = format!("central differences with {}", integrator.name());
        return Err(FdError::NeverStable { scheme });
    }
    Ok(extent)
}

/// The norm of the derivative along a velocity, m/s, with its boundary conditions, 1/s: without closed ends the
/// rate of the wave that is carried fastest.
pub(crate) fn gradient_norm(
    mesh: &Mesh,
    order: Order,
    boundary: &Boundary,
    velocity: [f64; 3],
) -> Result<f64, FdError> {
    check_mesh(mesh, order)?;
    boundary.check(mesh)?;
    let mut norm = 0.0;
    for ((side, conditions), v) in mesh.sides().iter().zip(&boundary.0).zip(velocity) {
        let h = side.spacing();
        let line = Line::<f64>::new(side, order, conditions)?;
        let wave = |k: i32| {
            let angle = PI * f64::from(k) / 720.0;
            angle * central::first_modified_wavenumber(order, angle) / h
        };
        let inside = (1..=720).map(wave).fold(0.0, f64::max);
        norm += v.abs()
            * match line.ends {
                Ends::Closed(_) => closed_norm(&line, order, h, 1).max(inside),
                _ => inside,
            };
    }
    Ok(norm)
}

/// The largest eigenvalue of minus the second derivative with closed ends: in the norm of the closure it is
/// symmetric.
fn closed_radius(line: &Line<f64>, order: Order, h: f64) -> f64 {
    closed_norm(line, order, h, 2)
}

/// The norm of the first or second derivative with closed ends, by powers of it and its adjoint, in the norm of
/// the closure. It belongs to a wave at one of the ends, so that a short line will do.
fn closed_norm(line: &Line<f64>, order: Order, h: f64, derivative: usize) -> f64 {
    let n = line.points.min(60);
    let short = Line { points: n, ..line.clone() };
    let Some(closure) = Closure::of(order) else { return 0.0 };
    let weights: Vec<f64> = (0..n).map(|i| value(closure.norm(i.min(n - 1 - i))).sqrt()).collect();
    // In the coordinates in which the norm is that of Euclid.
    let mut matrix = vec![vec![0.0; n]; n];
    for i in 0..n {
        let own = short.row(i).map(|(row, _)| {
            let from = (i as isize + row.from) as usize;
            (from, if derivative == 1 { row.first.clone() } else { row.second.clone() })
        });
        let (from, coefficients) =
            own.unwrap_or_else(|| (i - order.reach(), inside(order, h, derivative)));
        for (j, c) in (from..).zip(coefficients) {
            matrix[i][j] = weights[i] * c / weights[j];
        }
    }
    let mut u: Vec<f64> = (0..n).map(|i| (i as f64 * 2.7).cos()).collect();
    let mut norm = 0.0;
    for _ in 0..500 {
        let v: Vec<f64> =
            matrix.iter().map(|row| row.iter().zip(&u).map(|(c, u)| c * u).sum()).collect();
        let back = |j: usize| matrix.iter().zip(&v).map(|(row, v)| row[j] * v).sum();
        let w: Vec<f64> = (0..n).map(back).collect();
        let length = w.iter().map(|w| w * w).sum::<f64>().sqrt();
        norm = length.sqrt();
        u = w.iter().map(|w| w / length).collect();
    }
    // From below it comes as near as this.
    norm * (1.0 + 1e-3)
}

/// Coefficients of a derivative away from boundaries, from the first point read on.
fn inside(order: Order, h: f64, derivative: usize) -> Vec<f64> {
    let reach = order.reach();
    let mut coefficients = vec![0.0; 2 * reach + 1];
    let given = central::first_derivative(order).into_iter().zip(central::second_derivative(order));
    for (k, (a, b)) in (1..).zip(given) {
        if derivative == 1 {
            coefficients[reach + k] = value(a) / h;
            coefficients[reach - k] = -value(a) / h;
        } else {
            let b = value(b) / (h * h);
            coefficients[reach + k] = b;
            coefficients[reach - k] = b;
            coefficients[reach] -= 2.0 * b;
        }
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::Condition;
    use crate::mesh::Side;

    fn close(value: f64, expected: f64, within: f64) {
        assert!((value / expected - 1.0).abs() < within, "{value} for {expected}");
    }

    /// Hairer & Wanner (1996), Solving Ordinary Differential Equations II, section IV.2.
    #[test]
    fn integrators_take_what_is_known_of_them() {
        close(decay_extent(Integrator::Euler), 2.0, 1e-6);
        close(decay_extent(Integrator::Rk2), 2.0, 1e-6);
        close(decay_extent(Integrator::SspRk3), 2.5127, 1e-4);
        close(decay_extent(Integrator::Rk4), 2.7853, 1e-4);
    }

    /// Upwind with Euler's method up to 1 (Courant, Friedrichs & Lewy 1928); the linear scheme of fifth
    /// order up to 1.43 with three stages and 1.73 with four (Wang & Spiteri 2007, SIAM J. Numer. Anal. 45).
    #[test]
    fn advection_is_stable_up_to_what_is_known() {
        let limit = |face, integrator| advection_limit(face, integrator).unwrap();
        close(limit(Face::Upwind1, Integrator::Euler), 1.0, 1e-6);
        close(limit(Face::Weno5, Integrator::SspRk3), 1.43, 0.005);
        close(limit(Face::Weno5Z, Integrator::Rk4), 1.73, 0.005);
        for face in [Face::Upwind3, Face::Weno5] {
            assert!(advection_limit(face, Integrator::Euler).is_err(), "{}", face.name());
        }
    }

    /// Without flow the limit of diffusion; almost without viscosity that of RK4 for oscillations, 2 sqrt(2); and by
    /// Euler's method `2 nu / u^2` if that is less (Hindmarsh, Gresho & Griffiths 1984, Int. J. Numer. Methods Fluids 4).
    #[test]
    fn advection_and_diffusion_are_stable_up_to_what_is_known() {
        let second = Symbol::new(StaggeredOrder::Second);
        let limit = |integrator, turns, decays| {
            advection_diffusion_limit(integrator, &second, turns, decays)
        };
        let still = limit(Integrator::Rk4, [0.0; 3], [3.0, 5.0, 0.0]);
        close(still, 2.7853 / 8.0, 1e-4);
        close(limit(Integrator::Rk4, [3.0, 0.0, 5.0], [1e-9; 3]), 8f64.sqrt() / 8.0, 1e-3);
        // u = 1, h = 0.1, nu = 0.01: turns u / h, decays 4 nu / h^2.
        close(limit(Integrator::Euler, [10.0, 0.0, 0.0], [4.0, 0.0, 0.0]), 0.02, 1e-3);
        close(limit(Integrator::Euler, [10.0, 0.0, 0.0], [40.0, 0.0, 0.0]), 0.05, 1e-3);
    }

    /// The largest eigenvalue is that of the shortest wave: 4, 16/3, 272/45 and 2048/315 over `h^2` and
    /// direction.
    #[test]
    fn the_shortest_wave_limits_the_laplacian() {
        let boundary = Boundary::all(Condition::Outflow);
        let shortest = [4.0, 16.0 / 3.0, 272.0 / 45.0, 2048.0 / 315.0];
        for (order, expected) in Order::ALL.into_iter().zip(shortest) {
            let mesh = Mesh::new([Side::periodic(20, 0.0, 1.0), Side::periodic(40, 0.0, 1.0)]);
            let radius = laplacian_radius(&mesh, order, &boundary).unwrap();
            close(radius, expected * (400.0 + 1600.0), 1e-12);
        }
    }

    /// Waves of all angles, by the differences themselves.
    #[test]
    fn at_the_limit_of_advection_and_diffusion_no_wave_grows() {
        let differences = |order: StaggeredOrder, angle: f64| {
            let wave = |steps: f64| Complex64::from_polar(1.0, steps * angle);
            match order {
                StaggeredOrder::Second => (
                    0.5 * (wave(1.0) - wave(-1.0)),
                    (wave(1.0) - 2.0 + wave(-1.0)).re / 4.0,
                    [1.0, 1.0],
                ),
                StaggeredOrder::Fourth => (
                    9.0 / 16.0 * (wave(1.0) - wave(-1.0)) - (wave(3.0) - wave(-3.0)) / 48.0,
                    (-wave(2.0) + 16.0 * wave(1.0) - 30.0 + 16.0 * wave(-1.0) - wave(-2.0)).re
                        / 12.0,
                    [7.0 / 6.0, 16.0 / 3.0],
                ),
            }
        };
        for order in [StaggeredOrder::Second, StaggeredOrder::Fourth] {
            let symbol = Symbol::new(order);
            for integrator in [Integrator::Rk2, Integrator::SspRk3, Integrator::Rk4] {
                for decay in [0.01, 0.1, 0.3, 1.0, 3.0, 30.0] {
                    for across in [0.0, 0.7] {
                        let (turns, decays) = ([1.0, across, 0.0], [decay, across * decay, 0.0]);
                        let dt = advection_diffusion_limit(integrator, &symbol, turns, decays);
                        let mut most = [0.0f64; 2];
                        let angle = |k: u32| 2.0 * PI * f64::from(k) / 90.0;
                        for (k, l) in (0..90).flat_map(|k| (0..90).map(move |l| (k, l))) {
                            let rate = |angle: f64, share: f64| {
                                let (turn, decays, most) = differences(order, angle);
                                share * (turn / most[0] + decay * decays / most[1])
                            };
                            let rate = rate(angle(k), 1.0) + rate(angle(l), across);
                            for (most, dt) in most.iter_mut().zip([dt, 1.1 * dt]) {
                                *most = most.max(amplification(integrator, rate * dt));
                            }
                        }
                        let case = format!("{order:?} {integrator:?} {decay} {across}");
                        assert!(most[0] <= 1.0 + 1e-4, "{case}: {most:?}");
                        assert!(most[1] > 1.0 + 1e-4, "{case}: {most:?}, the limit is not tight");
                    }
                }
            }
        }
    }
}
