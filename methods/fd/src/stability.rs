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

/// The largest eigenvalue of minus the second derivative with closed ends, by powers of it: in the norm of
/// the closure it is symmetric. It belongs to a wave at one of the ends, so that a short line will do.
fn closed_radius(line: &Line<f64>, order: Order, h: f64) -> f64 {
    let n = line.points.min(60);
    let short = Line { points: n, ..line.clone() };
    let inside: Vec<f64> = central::second_derivative(order).into_iter().map(value).collect();
    let Some(closure) = Closure::of(order) else { return 0.0 };
    let norm: Vec<f64> = (0..n).map(|i| value(closure.norm(i.min(n - 1 - i)))).collect();
    let apply = |u: &[f64]| -> Vec<f64> {
        (0..n)
            .map(|i| match short.row(i) {
                Some((row, _)) => {
                    let first = (i as isize + row.from) as usize;
                    row.second.iter().zip(&u[first..]).map(|(c, u)| c * u).sum()
                }
                None => {
                    let pairs = inside.iter().zip(1..);
                    pairs.map(|(b, k)| b * (u[i + k] - 2.0 * u[i] + u[i - k]) / (h * h)).sum()
                }
            })
            .collect()
    };
    let dot = |u: &[f64], v: &[f64]| -> f64 { (0..n).map(|i| norm[i] * u[i] * v[i]).sum() };
    let mut u: Vec<f64> = (0..n).map(|i| (i as f64 * 2.7).cos()).collect();
    let mut radius = 0.0;
    for _ in 0..2000 {
        let v = apply(&u);
        radius = (dot(&v, &v) / dot(&u, &u)).sqrt();
        let length = dot(&v, &v).sqrt();
        u = v.iter().map(|v| v / length).collect();
    }
    // From below it comes as near as this.
    radius * (1.0 + 1e-3)
}
