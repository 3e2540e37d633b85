//! Derivatives and means half-way between points.

use super::Fraction;

/// Order of accuracy on a staggered grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StaggeredOrder {
    /// Second: two points.
    Second,
    /// Fourth: four points.
    Fourth,
}

/// Coefficients `a_k`, `k = 1, ..., R`, of the derivative half-way between points:
/// `h f'_{i+1/2} = sum_k a_k (f_{i+k} - f_{i+1-k})` (Fornberg & Ghrist 1999, SIAM J. Numer. Anal. 37,
/// table 2.1).
pub fn derivative(order: StaggeredOrder) -> Vec<Fraction> {
    match order {
        StaggeredOrder::Second => vec![Fraction::from(1)],
        StaggeredOrder::Fourth => vec![Fraction::new(9, 8), Fraction::new(-1, 24)],
    }
}

/// Coefficients `a_k`, `k = 1, ..., R`, of the value half-way between points:
/// `f_{i+1/2} = sum_k a_k (f_{i+k} + f_{i+1-k})`, which is Lagrange's interpolation.
pub fn mean(order: StaggeredOrder) -> Vec<Fraction> {
    match order {
        StaggeredOrder::Second => vec![Fraction::new(1, 2)],
        StaggeredOrder::Fourth => vec![Fraction::new(9, 16), Fraction::new(-1, 16)],
    }
}

#[cfg(test)]
mod tests {
    use super::super::exact::{Exact, degree, exact};
    use super::*;

    /// Places are counted from the point half-way, in half spacings.
    fn terms(coefficients: Vec<Fraction>, sign: i128) -> Vec<(Exact, Exact)> {
        let pairs = coefficients.into_iter().zip(1..);
        pairs
            .flat_map(|(c, k)| {
                let (place, c) = (Exact::from(2 * k - 1), exact(c));
                [(place, c), (-place, c * sign)]
            })
            .collect()
    }

    #[test]
    fn polynomials_are_treated_exactly() {
        for (order, p) in [(StaggeredOrder::Second, 2), (StaggeredOrder::Fourth, 4)] {
            let derivative = terms(derivative(order), -1);
            assert_eq!(degree(&derivative, |q| 2 * i128::from(q == 1)), Some(p));
            let mean = terms(mean(order), 1);
            assert_eq!(degree(&mean, |q| i128::from(q == 0)), Some(p - 1));
        }
    }
}
