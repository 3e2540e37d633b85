//! The difference operators along one axis, with its boundary conditions.

use finegrain_framework::Real;

use crate::boundary::Condition;
use crate::error::FdError;
use crate::mesh::{Side, Spread};
use crate::operator::sbp::Closure;
use crate::operator::{Order, central, value};

/// Penalties of imposed values over the least that is stable.
const SAFETY: f64 = 1.2;

/// A point next to a boundary: coefficients of its own, from one point on.
#[derive(Clone, Debug, Default)]
pub(crate) struct Row<T> {
    /// The first point read, counted from this one.
    pub from: isize,
    pub first: Vec<T>,
    pub second: Vec<T>,
    /// Coefficients of the value given on the boundary.
    pub first_data: T,
    pub second_data: T,
}

impl<T> Row<T> {
    /// One past the last point read, counted from this one.
    pub fn to(&self) -> isize {
        self.from + self.first.len() as isize
    }
}

/// A ghost point: `keep` of the point that mirrors it, or of the one on the end, and `data` of the
/// value given.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ghost<T> {
    /// How far in it has its value from, in points.
    pub source: usize,
    pub keep: T,
    pub data: T,
}

/// What an axis has at its ends.
#[derive(Clone, Debug)]
pub(crate) enum Ends<T> {
    Periodic,
    /// Rows of the points from each end on.
    Closed([Vec<Row<T>>; 2]),
    /// Ghost points from each end on.
    Ghosts([Vec<Ghost<T>>; 2]),
}

/// Derivatives along an axis.
#[derive(Clone, Debug)]
pub(crate) struct Line<T> {
    pub points: usize,
    /// Position of its ends.
    pub limits: [f64; 2],
    pub conditions: [Condition; 2],
    pub ends: Ends<T>,
}

impl<T: Real> Line<T> {
    pub fn new(side: &Side, order: Order, conditions: &[Condition; 2]) -> Result<Self, FdError> {
        let h = side.spacing();
        let ends = match side.spread {
            Spread::Periodic => Ends::Periodic,
            Spread::Cells => {
                let ghosts = |c: &Condition| {
                    (0..order.reach().max(3)).map(|depth| ghost(c, depth, h)).collect()
                };
                Ends::Ghosts([ghosts(&conditions[0]), ghosts(&conditions[1])])
            }
            Spread::Ends => {
                let closure = Closure::of(order).ok_or(FdError::NoClosure(order))?;
                let lower = closed(closure, order, h, &conditions[0]);
                let upper = closed(closure, order, h, &conditions[1]);
                Ends::Closed([
                    lower.iter().map(Dense::row).collect(),
                    upper.iter().map(Dense::mirrored).collect(),
                ])
            }
        };
        let (limits, conditions) = ([side.lower, side.upper], conditions.clone());
        Ok(Self { points: side.points, limits, conditions, ends })
    }

    /// Number of points next to each end that have rows of their own.
    pub fn closed(&self) -> usize {
        match &self.ends {
            Ends::Closed([rows, _]) => rows.len(),
            _ => 0,
        }
    }

    /// The row of a point next to an end, and which end.
    pub fn row(&self, point: usize) -> Option<(&Row<T>, usize)> {
        let Ends::Closed(rows) = &self.ends else { return None };
        let at = |end: usize| rows[end].get(self.counted_from(point, end)).map(|row| (row, end));
        at(0).or_else(|| at(1))
    }

    /// Whether derivatives at a point are central differences of points that there are, so many to either side.
    pub fn is_inner(&self, point: usize, reach: usize) -> bool {
        match &self.ends {
            Ends::Periodic => true,
            Ends::Closed(_) => self.row(point).is_none(),
            Ends::Ghosts(_) => reach <= point && point + reach < self.points,
        }
    }

    /// The point, or how far in it is, counted from an end.
    pub fn counted_from(&self, point: usize, end: usize) -> usize {
        if end == 0 { point } else { self.points - 1 - point }
    }
}

/// A ghost point so that, half-way between it and the point that mirrors it, the condition holds: of
/// second order, and exact where the solution is odd or even about the boundary.
fn ghost<T: Real>(condition: &Condition, depth: usize, h: f64) -> Ghost<T> {
    let Some([value, slope]) = condition.factors() else {
        return Ghost { source: 0, keep: T::one(), data: T::zero() };
    };
    let distance = (2 * depth + 1) as f64 * h;
    let (mean, difference) = (0.5 * value, slope / distance);
    let sum = mean + difference;
    Ghost { source: depth, keep: T::of((difference - mean) / sum), data: T::of(1.0 / sum) }
}

/// Coefficients of a point next to the lower end, from the point on the boundary on.
struct Dense {
    point: usize,
    first: Vec<f64>,
    second: Vec<f64>,
    first_data: f64,
    second_data: f64,
}

impl Dense {
    fn row<T: Real>(&self) -> Row<T> {
        Row {
            from: -(self.point as isize),
            first: self.first.iter().map(|&c| T::of(c)).collect(),
            second: self.second.iter().map(|&c| T::of(c)).collect(),
            first_data: T::of(self.first_data),
            second_data: T::of(self.second_data),
        }
    }

    /// As a point next to the upper end.
    fn mirrored<T: Real>(&self) -> Row<T> {
        Row {
            from: self.point as isize + 1 - self.first.len() as isize,
            first: self.first.iter().rev().map(|&c| T::of(-c)).collect(),
            second: self.second.iter().rev().map(|&c| T::of(c)).collect(),
            first_data: T::of(-self.first_data),
            second_data: T::of(self.second_data),
        }
    }
}

/// The rows of the points next to a lower end, with penalties for what is imposed there.
///
/// Of the second derivative, `H D_2 = -M + B S`, a condition on the derivative replaces that on the
/// boundary: `D_2 u - H^-1 (du/dn - g)` (Carpenter, Gottlieb & Abarbanel 1994). One on the value makes the
/// operator symmetric, too: `D_2 u + H^-1 (S_n^T - t / h) (u_0 - g)`, not negative in the norm if `t` is at
/// least one over what `M` can lend (Mattsson, Ham & Iaccarino 2009, J. Sci. Comput. 41). Of the first
/// derivative, one on the value is that of an inflow: `D_1 u + H^-1 (u_0 - g)` (Carpenter et al. 1994).
fn closed(closure: &Closure, order: Order, h: f64, condition: &Condition) -> Vec<Dense> {
    let outward: Vec<f64> = closure.boundary_derivative().iter().map(|&c| -value(c) / h).collect();
    let count = closure.rows().max(outward.len());
    let mut rows: Vec<Dense> = (0..count).map(|i| inside(closure, order, h, i)).collect();
    let weight = |i: usize| 1.0 / (value(closure.norm(i)) * h);
    match condition.factors() {
        None => {}
        Some([_, 0.0]) => {
            rows[0].first[0] += weight(0);
            rows[0].first_data -= weight(0);
            let strength = SAFETY / (closure.borrowing * h);
            for (i, row) in rows.iter_mut().enumerate() {
                let lifted = outward.get(i).copied().unwrap_or(0.0);
                let penalty = weight(i) * (lifted - if i == 0 { strength } else { 0.0 });
                row.second[0] += penalty;
                row.second_data -= penalty;
            }
        }
        Some([value, slope]) => {
            for (c, outward) in rows[0].second.iter_mut().zip(&outward) {
                *c -= weight(0) * outward;
            }
            rows[0].second[0] -= weight(0) * value / slope;
            rows[0].second_data += weight(0) / slope;
        }
    }
    rows
}

/// A point of the lower end without penalties, in as many coefficients as any of them needs.
fn inside(closure: &Closure, order: Order, h: f64, point: usize) -> Dense {
    let last = point + order.reach();
    let mut first = vec![0.0; last + 1];
    let mut second = vec![0.0; last + 1];
    if point < closure.rows() {
        let given = [closure.first_derivative(point), closure.second_derivative(point)];
        let length = given.iter().map(Vec::len).max().unwrap_or(0).max(last + 1);
        for (row, given) in [&mut first, &mut second].into_iter().zip(given) {
            row.clear();
            row.extend(given.into_iter().map(value));
            row.resize(length, 0.0);
        }
    } else {
        let given =
            central::first_derivative(order).into_iter().zip(central::second_derivative(order));
        for (k, (a, b)) in (1..).zip(given) {
            first[point + k] += value(a);
            first[point - k] -= value(a);
            second[point + k] += value(b);
            second[point - k] += value(b);
            second[point] -= 2.0 * value(b);
        }
    }
    for c in &mut first {
        *c /= h;
    }
    for c in &mut second {
        *c /= h * h;
    }
    Dense { point, first, second, first_data: 0.0, second_data: 0.0 }
}
