//! Summation by parts: what takes the place of central differences next to a boundary.
//!
//! With the norm `H`, a diagonal matrix of quadrature weights, the first derivative obeys
//! `H D_1 + (H D_1)^T = B` and the second `H D_2 = -M + B S` with `M` symmetric and not negative, where
//! `B = diag(-1, 0, ..., 0, 1)` and `S` is the derivative on the boundary: the discrete counterparts of
//! `int u v' + int u' v = [u v]` and `int u v'' + int u' v' = [u v']` (Kreiss & Scherer 1974; Strand
//! 1994, J. Comput. Phys. 110; Mattsson & Nordstrom 2004, J. Comput. Phys. 199). With boundary
//! conditions imposed by penalties that fit, the semi-discrete energy cannot grow.
//!
//! Inside the order is `2 p`, next to the boundary `p`, so that solutions are of order `p + 1` for first and
//! `p + 2` for second derivatives, at most `2 p`
//! (Svard & Nordstrom 2006).

use super::Fraction;
use super::central::Order;

/// A row of coefficients, numerators and denominators, from the point on the boundary on.
type Row = &'static [(i64, i64)];

/// The operators next to the lower end, in units of the spacing. At the upper end they are mirrored,
/// first derivatives with the other sign.
#[derive(Debug)]
pub struct Closure {
    /// The diagonal of the norm; 1 further inside.
    norm: Row,
    first: &'static [Row],
    second: &'static [Row],
    boundary: Row,
    /// The largest `a` with which `M - a h S^T S` is not negative, S being of both ends (Mattsson, Ham
    /// & Iaccarino 2008, J. Sci. Comput. 41, table 1): how strong a penalty must be that imposes a value.
    pub borrowing: f64,
}

impl Closure {
    /// The closure of central differences; `None` for order 8, of which no closure is here.
    pub fn of(order: Order) -> Option<&'static Self> {
        match order {
            Order::Second => Some(&SECOND),
            Order::Fourth => Some(&FOURTH),
            Order::Sixth => Some(&SIXTH),
            Order::Eighth => None,
        }
    }

    /// Number of points with rows of their own.
    pub fn rows(&self) -> usize {
        self.norm.len()
    }

    /// Weight of a point in the norm.
    pub fn norm(&self, point: usize) -> Fraction {
        self.norm.get(point).map_or(Fraction::from(1), |&(n, d)| Fraction::new(n, d))
    }

    /// Coefficients of the first derivative at a point, from that of the boundary on.
    pub fn first_derivative(&self, point: usize) -> Vec<Fraction> {
        fractions(self.first[point])
    }

    /// Coefficients of the second derivative at a point, from that of the boundary on.
    pub fn second_derivative(&self, point: usize) -> Vec<Fraction> {
        fractions(self.second[point])
    }

    /// Coefficients of the derivative on the boundary, into the domain.
    pub fn boundary_derivative(&self) -> Vec<Fraction> {
        fractions(self.boundary)
    }
}

fn fractions(row: Row) -> Vec<Fraction> {
    row.iter().map(|&(n, d)| Fraction::new(n, d)).collect()
}

static SECOND: Closure = Closure {
    norm: &[(1, 2)],
    first: &[&[(-1, 1), (1, 1)]],
    second: &[&[(1, 1), (-2, 1), (1, 1)]],
    boundary: &[(-3, 2), (2, 1), (-1, 2)],
    borrowing: 0.4,
};

/// Strand (1994); Mattsson & Nordstrom (2004), appendix C.2.
static FOURTH: Closure = Closure {
    norm: &[(17, 48), (59, 48), (43, 48), (49, 48)],
    first: &[
        &[(-24, 17), (59, 34), (-4, 17), (-3, 34)],
        &[(-1, 2), (0, 1), (1, 2)],
        &[(4, 43), (-59, 86), (0, 1), (59, 86), (-4, 43)],
        &[(3, 98), (0, 1), (-59, 98), (0, 1), (32, 49), (-4, 49)],
    ],
    second: &[
        &[(2, 1), (-5, 1), (4, 1), (-1, 1)],
        &[(1, 1), (-2, 1), (1, 1)],
        &[(-4, 43), (59, 43), (-110, 43), (59, 43), (-4, 43)],
        &[(-1, 49), (0, 1), (59, 49), (-118, 49), (64, 49), (-4, 49)],
    ],
    boundary: &[(-11, 6), (3, 1), (-3, 2), (1, 3)],
    borrowing: 0.2508560249,
};

/// Of the family of Strand (1994) the first derivative of Mattsson, Svard & Shoeybi (2008, J. Comput.
/// Phys. 227); the second of Mattsson & Nordstrom (2004), appendix C.3.
static SIXTH: Closure = Closure {
    norm: &[
        (13649, 43200),
        (12013, 8640),
        (2711, 4320),
        (5359, 4320),
        (7877, 8640),
        (43801, 43200),
    ],
    first: &[
        &[
            (-21600, 13649),
            (104009, 54596),
            (30443, 81894),
            (-33311, 27298),
            (16863, 27298),
            (-15025, 163788),
        ],
        &[
            (-104009, 240260),
            (0, 1),
            (-311, 72078),
            (20229, 24026),
            (-24337, 48052),
            (36661, 360390),
        ],
        &[(-30443, 162660), (311, 32532), (0, 1), (-11155, 16266), (41287, 32532), (-21999, 54220)],
        &[
            (33311, 107180),
            (-20229, 21436),
            (485, 1398),
            (0, 1),
            (4147, 21436),
            (25427, 321540),
            (72, 5359),
        ],
        &[
            (-16863, 78770),
            (24337, 31508),
            (-41287, 47262),
            (-4147, 15754),
            (0, 1),
            (342523, 472620),
            (-1296, 7877),
            (144, 7877),
        ],
        &[
            (15025, 525612),
            (-36661, 262806),
            (21999, 87602),
            (-25427, 262806),
            (-342523, 525612),
            (0, 1),
            (32400, 43801),
            (-6480, 43801),
            (720, 43801),
        ],
    ],
    second: &[
        &[
            (114170, 40947),
            (-438107, 54596),
            (336409, 40947),
            (-276997, 81894),
            (3747, 13649),
            (21035, 163788),
        ],
        &[(6173, 5860), (-2066, 879), (3283, 1758), (-303, 293), (2111, 3516), (-601, 4395)],
        &[
            (-52391, 81330),
            (134603, 32532),
            (-21982, 2711),
            (112915, 16266),
            (-46969, 16266),
            (30409, 54220),
        ],
        &[
            (68603, 321540),
            (-12423, 10718),
            (112915, 32154),
            (-75934, 16077),
            (53369, 21436),
            (-54899, 160770),
            (48, 5359),
        ],
        &[
            (-7053, 39385),
            (86551, 94524),
            (-46969, 23631),
            (53369, 15754),
            (-87904, 23631),
            (820271, 472620),
            (-1296, 7877),
            (96, 7877),
        ],
        &[
            (21035, 525612),
            (-24641, 131403),
            (30409, 87602),
            (-54899, 131403),
            (820271, 525612),
            (-117600, 43801),
            (64800, 43801),
            (-6480, 43801),
            (480, 43801),
        ],
    ],
    boundary: &[(-25, 12), (4, 1), (-3, 1), (4, 3), (-1, 4)],
    borrowing: 0.1878715026,
};

#[cfg(test)]
mod tests {
    use super::super::central;
    use super::super::exact::{Exact, degree, exact};
    use super::*;

    const ORDERS: [Order; 3] = [Order::Second, Order::Fourth, Order::Sixth];

    /// A derivative on `n` points as a matrix; `sign` is that of the upper end.
    fn matrix(
        closure: &Closure,
        n: usize,
        row: impl Fn(usize) -> Vec<Fraction>,
        inside: impl Fn(usize, usize) -> Fraction,
        sign: i128,
    ) -> Vec<Vec<Exact>> {
        let mut matrix = vec![vec![Exact::from(0); n]; n];
        for i in 0..n {
            for j in 0..n {
                matrix[i][j] = exact(inside(i, j));
            }
        }
        for i in 0..closure.rows() {
            matrix[i].fill(Exact::from(0));
            matrix[n - 1 - i].fill(Exact::from(0));
            for (j, c) in row(i).into_iter().enumerate() {
                matrix[i][j] = exact(c);
                matrix[n - 1 - i][n - 1 - j] = exact(c) * sign;
            }
        }
        matrix
    }

    fn points(closure: &Closure) -> usize {
        4 * closure.rows() + 6
    }

    fn first(order: Order) -> Vec<Vec<Exact>> {
        let closure = Closure::of(order).unwrap();
        let coefficients = central::first_derivative(order);
        let inside = |i: usize, j: usize| match i.abs_diff(j) {
            0 => Fraction::from(0),
            k if k > order.reach() => Fraction::from(0),
            k if j > i => coefficients[k - 1],
            k => -coefficients[k - 1],
        };
        matrix(closure, points(closure), |i| closure.first_derivative(i), inside, -1)
    }

    fn second(order: Order) -> Vec<Vec<Exact>> {
        let closure = Closure::of(order).unwrap();
        let coefficients = central::second_derivative(order);
        let inside = |i: usize, j: usize| match i.abs_diff(j) {
            0 => -coefficients.iter().sum::<Fraction>() * 2,
            k if k > order.reach() => Fraction::from(0),
            k => coefficients[k - 1],
        };
        matrix(closure, points(closure), |i| closure.second_derivative(i), inside, 1)
    }

    fn norm(order: Order, i: usize) -> Exact {
        let closure = Closure::of(order).unwrap();
        exact(closure.norm(i.min(points(closure) - 1 - i)))
    }

    #[test]
    fn first_derivatives_sum_by_parts() {
        for order in ORDERS {
            let d = first(order);
            let n = d.len();
            for i in 0..n {
                for j in 0..n {
                    let sum = norm(order, i) * d[i][j] + norm(order, j) * d[j][i];
                    let ends = [0, n - 1].map(|end| i128::from(i == end && j == end));
                    assert_eq!(sum, Exact::from(ends[1] - ends[0]), "{order}: {i}, {j}");
                }
            }
        }
    }

    /// `M = -H D_2 + B S`.
    fn stiffness(order: Order) -> Vec<Vec<Exact>> {
        let mut m = second(order);
        let n = m.len();
        for (i, row) in m.iter_mut().enumerate() {
            for c in row {
                *c *= -norm(order, i);
            }
        }
        let boundary = Closure::of(order).unwrap().boundary_derivative();
        for (j, c) in boundary.into_iter().enumerate() {
            m[0][j] -= exact(c);
            m[n - 1][n - 1 - j] -= exact(c);
        }
        m
    }

    #[test]
    fn second_derivatives_sum_by_parts() {
        for order in ORDERS {
            let m = stiffness(order);
            for i in 0..m.len() {
                for j in 0..m.len() {
                    assert_eq!(m[i][j], m[j][i], "{order}: {i}, {j}");
                }
            }
        }
    }

    /// Whether a symmetric matrix is not negative, up to rounding: by the pivots of its elimination.
    fn is_not_negative(mut a: Vec<Vec<f64>>) -> bool {
        let n = a.len();
        for k in 0..n {
            if a[k][k] < -1e-9 {
                return false;
            }
            for i in k + 1..n {
                let factor = if a[k][k].abs() < 1e-9 { 0.0 } else { a[i][k] / a[k][k] };
                for j in k + 1..n {
                    a[i][j] -= factor * a[k][j];
                }
            }
        }
        true
    }

    #[test]
    fn as_much_as_is_said_can_be_borrowed_and_no_more() {
        for order in ORDERS {
            let closure = Closure::of(order).unwrap();
            let m = stiffness(order);
            let n = m.len();
            let s: Vec<f64> =
                closure.boundary_derivative().into_iter().map(super::super::value).collect();
            let less = |a: f64| {
                let mut rest: Vec<Vec<f64>> = m
                    .iter()
                    .map(|row| row.iter().map(|c| *c.numer() as f64 / *c.denom() as f64).collect())
                    .collect();
                for i in 0..s.len() {
                    for j in 0..s.len() {
                        rest[i][j] -= a * s[i] * s[j];
                        rest[n - 1 - i][n - 1 - j] -= a * s[i] * s[j];
                    }
                }
                rest
            };
            assert!(is_not_negative(less(closure.borrowing)), "{order}");
            assert!(!is_not_negative(less(1.01 * closure.borrowing)), "{order}");
        }
    }

    /// The norm is a quadrature; derivatives are exact to the orders of the module's front.
    #[test]
    fn polynomials_are_treated_exactly() {
        for (order, p) in ORDERS.into_iter().zip(1..) {
            let closure = Closure::of(order).unwrap();
            // Places are counted from the point of the row.
            let terms = |row: Vec<Fraction>, at: usize| -> Vec<(Exact, Exact)> {
                let row = row.into_iter().enumerate();
                row.map(|(j, c)| (Exact::from(j as i128 - at as i128), exact(c))).collect()
            };
            for i in 0..closure.rows() {
                let first = terms(closure.first_derivative(i), i);
                let exact_to = degree(&first, |q| i128::from(q == 1)).unwrap();
                assert!(exact_to >= p, "{order}: {i}");
                let second = terms(closure.second_derivative(i), i);
                let exact_to = degree(&second, |q| 2 * i128::from(q == 2)).unwrap();
                assert!(exact_to > p, "{order}: {i}");
            }
            let boundary = terms(closure.boundary_derivative(), 0);
            assert_eq!(degree(&boundary, |q| i128::from(q == 1)), Some(p + 1), "{order}");
            let n = points(closure);
            let length = Exact::from(n as i128 - 1);
            for q in 0..2 * p {
                let sum: Exact =
                    (0..n).map(|i| norm(order, i) * Exact::from(i as i128).pow(q)).sum();
                assert_eq!(sum * i128::from(q + 1), length.pow(q + 1), "{order}: degree {q}");
            }
        }
    }
}
