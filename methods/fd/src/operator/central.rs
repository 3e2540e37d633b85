//! Central differences on evenly spaced points.

use std::fmt;

use num_rational::Ratio;
use serde::{Deserialize, Serialize};

use super::Fraction;

/// Order of accuracy of central differences.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Order {
    /// Second: three points.
    Second,
    /// Fourth: five points.
    Fourth,
    /// Sixth: seven points.
    Sixth,
    /// Eighth: nine points.
    Eighth,
}

impl Order {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Second, Self::Fourth, Self::Sixth, Self::Eighth];

    /// The order with this number; `None` if there is none.
    pub fn of(number: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|order| order.number() == number)
    }

    /// As a number.
    pub fn number(self) -> u32 {
        2 * self.reach() as u32
    }

    /// How many points to either side are read.
    pub fn reach(self) -> usize {
        match self {
            Self::Second => 1,
            Self::Fourth => 2,
            Self::Sixth => 3,
            Self::Eighth => 4,
        }
    }
}

impl fmt::Display for Order {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.number())
    }
}

/// `(R!)^2 / ((R - k)! (R + k)!)`, with the sign of `(-1)^(k + 1)`.
fn binomials(reach: usize, k: usize) -> Fraction {
    let (reach, k) = (reach as i64, k as i64);
    let product = (1..=k).map(|i| Ratio::new(reach - i + 1, reach + i)).product::<Fraction>();
    if k % 2 == 1 { product } else { -product }
}

/// Coefficients `a_k`, `k = 1, ..., R`, of the first derivative of order `2 R`:
/// `h f'_i = sum_k a_k (f_{i+k} - f_{i-k})` (Fornberg 1990, Geophysics 55, eq. for even orders).
pub fn first_derivative(order: Order) -> Vec<Fraction> {
    (1..=order.reach()).map(|k| binomials(order.reach(), k) / k as i64).collect()
}

/// Coefficients `b_k`, `k = 1, ..., R`, of the second derivative of order `2 R`:
/// `h^2 f''_i = sum_k b_k (f_{i+k} - 2 f_i + f_{i-k})`.
pub fn second_derivative(order: Order) -> Vec<Fraction> {
    (1..=order.reach()).map(|k| binomials(order.reach(), k) * 2 / (k * k) as i64).collect()
}

/// What the first derivative makes of a wave, over what it should: `k*/k` at `k h = angle`, radians.
pub fn first_modified_wavenumber(order: Order, angle: f64) -> f64 {
    let terms = first_derivative(order).into_iter().zip(1..);
    let sum: f64 = terms.map(|(a, k)| super::value(a) * (f64::from(k) * angle).sin()).sum();
    2.0 * sum / angle
}

/// What the second derivative makes of a wave, over what it should: `(k*/k)^2` at `k h = angle`,
/// radians.
pub fn second_modified_wavenumber(order: Order, angle: f64) -> f64 {
    let terms = second_derivative(order).into_iter().zip(1..);
    let sum: f64 = terms.map(|(b, k)| super::value(b) * (1.0 - (f64::from(k) * angle).cos())).sum();
    2.0 * sum / (angle * angle)
}

#[cfg(test)]
mod tests {
    use super::super::exact::{Exact, degree, exact};
    use super::*;

    fn terms(coefficients: &[Fraction], sign: i128) -> Vec<(Exact, Exact)> {
        let pairs = coefficients.iter().zip(1..);
        pairs
            .flat_map(|(&c, k)| {
                let (c, k) = (exact(c), Exact::from(k));
                [(k, c), (-k, c * sign)]
            })
            .collect()
    }

    /// Taylor's conditions: exact up to the order, and not beyond.
    #[test]
    fn polynomials_are_treated_exactly() {
        for order in Order::ALL {
            let first = terms(&first_derivative(order), -1);
            let wanted = |q| if q == 1 { 1 } else { 0 };
            assert_eq!(degree(&first, wanted), Some(order.number() as i32), "{order}");
            let mut second = terms(&second_derivative(order), 1);
            let here: Exact = second.iter().map(|&(_, c)| -c).sum();
            second.push((Exact::from(0), here));
            let wanted = |q| if q == 2 { 2 } else { 0 };
            assert_eq!(degree(&second, wanted), Some(order.number() as i32 + 1), "{order}");
        }
    }

    /// Rows of `08_fd_modified_wavenumber.csv`: k h / pi, first derivative of order 2 and 4, and the
    /// Laplacian of three points.
    const WAVENUMBERS: [[f64; 4]; 5] = [
        [0.05, 0.9958927352, 0.999979766, 0.9979455228],
        [0.25, 0.9003163162, 0.9882151641, 0.9496412036],
        [0.45, 0.6986465851, 0.8950979785, 0.8441586023],
        [0.75, 0.3001054387, 0.4708761152, 0.6149905055],
        [0.95, 0.05241540712, 0.08714390498, 0.4463045659],
    ];

    #[test]
    fn wavenumbers_are_those_of_the_reference() {
        for [angle, second, fourth, laplacian] in WAVENUMBERS {
            let angle = angle * std::f64::consts::PI;
            let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-9, "{a} for {b} at {angle}");
            close(first_modified_wavenumber(Order::Second, angle), second);
            close(first_modified_wavenumber(Order::Fourth, angle), fourth);
            close(second_modified_wavenumber(Order::Second, angle), laplacian);
        }
    }
}
