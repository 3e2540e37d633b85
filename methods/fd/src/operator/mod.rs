//! Difference operators: their coefficients, exact, and what is known of their accuracy.
//!
//! | file | holds |
//! |---|---|
//! | [`central`] | first and second derivatives of order 2, 4, 6 and 8, away from boundaries |
//! | [`sbp`] | what takes their place next to a boundary: summation by parts |
//! | [`staggered`] | derivatives and means half-way between points |
//! | [`face`] | values on faces from one side: upwind and weighted essentially non-oscillatory |

pub mod central;
pub mod face;
pub mod sbp;
pub mod staggered;

pub use central::Order;

/// A coefficient, exact.
pub type Fraction = num_rational::Ratio<i64>;

/// A coefficient, rounded.
pub(crate) fn value(fraction: Fraction) -> f64 {
    // Numerators and denominators are far below 2^53.
    *fraction.numer() as f64 / *fraction.denom() as f64
}

/// Exact sums over powers, for tests.
#[cfg(test)]
pub(crate) mod exact {
    use num_rational::Ratio;

    use super::Fraction;

    /// A number that does not overflow in sums of many coefficients.
    pub type Exact = Ratio<i128>;

    pub fn exact(fraction: Fraction) -> Exact {
        Exact::new(i128::from(*fraction.numer()), i128::from(*fraction.denom()))
    }

    /// The greatest degree to which every polynomial is treated exactly: what the terms (place,
    /// coefficient) make of `x^q` is `wanted(q)`.
    pub fn degree(terms: &[(Exact, Exact)], wanted: impl Fn(i32) -> i128) -> Option<i32> {
        let is_exact = |q: i32| {
            let sum: Exact = terms.iter().map(|&(place, c)| c * place.pow(q)).sum();
            sum == Exact::from(wanted(q))
        };
        (0..20).take_while(|&q| is_exact(q)).last()
    }
}
