//! An axis laid out: its ends, and where its ticks are.

use std::ops::RangeInclusive;

use super::axis::{Axis, Scale};
use super::number::{fixed, power_of_ten, rounded};

/// A place on a ruler with the number written there.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    pub value: f64,
    pub label: String,
}

/// An axis from `low` to `high` with its ticks.
#[derive(Clone, Debug)]
pub(crate) struct Ruler {
    scale: Scale,
    low: f64,
    high: f64,
    /// Label and unit of the axis, with the factor taken out of the numbers.
    pub title: String,
    pub ticks: Vec<Tick>,
    /// Ticks without a number.
    pub minor: Vec<f64>,
}

impl Ruler {
    /// `axis` from `low` to `high`, with at most about `most` ticks, but at least 2.
    pub fn new(axis: &Axis, [low, high]: [f64; 2], most: usize) -> Self {
        let most = most.max(2);
        let mut ruler = Self {
            scale: axis.scale,
            low,
            high,
            title: axis.title(""),
            ticks: Vec::new(),
            minor: Vec::new(),
        };
        match axis.scale {
            Scale::Linear => {}
            Scale::Log2 => ruler.mark_powers_of_two(most),
            Scale::Log10 => ruler.mark_powers_of_ten(most),
        }
        if ruler.ticks.len() < 2 {
            let factor = ruler.mark_steps(most);
            ruler.title = axis.title(&factor);
        }
        ruler
    }

    /// Where `value` lies: 0 at the low end, 1 at the high end.
    pub fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.low) / (self.high - self.low),
            Scale::Log2 | Scale::Log10 => (value / self.low).ln() / (self.high / self.low).ln(),
        }
    }

    /// The inverse of [`Ruler::place`].
    pub fn value_at(&self, place: f64) -> f64 {
        match self.scale {
            Scale::Linear => self.low + place * (self.high - self.low),
            Scale::Log2 | Scale::Log10 => self.low * (self.high / self.low).powf(place),
        }
    }

    fn spans(&self, value: f64) -> bool {
        (-1e-9..=1.0 + 1e-9).contains(&self.place(value))
    }

    fn mark_powers_of_two(&mut self, most: usize) {
        let exponents = self.low.log2().ceil() as i32..=self.high.log2().floor() as i32;
        let stride = exponents.clone().count().div_ceil(most).max(1) as i32;
        for exponent in exponents.filter(|e| e % stride == 0) {
            let value = 2f64.powi(exponent);
            let decimals = exponent.min(0).unsigned_abs() as usize;
            self.ticks.push(Tick { value, label: fixed(value, decimals) });
        }
    }

    fn mark_powers_of_ten(&mut self, most: usize) {
        let exponents = self.low.log10().floor() as i32..=self.high.log10().ceil() as i32;
        let stride = exponents.clone().count().div_ceil(most).max(1) as i32;
        let digits: &[i32] =
            if (exponents.clone().count() - 1) * 3 <= most { &[1, 2, 5] } else { &[1] };
        for exponent in exponents {
            for digit in 1..=9 {
                let value = f64::from(digit) * 10f64.powi(exponent);
                if !self.spans(value) {
                } else if digits.contains(&digit) && exponent % stride == 0 {
                    self.ticks.push(Tick { value, label: rounded(digit, exponent) });
                } else if stride == 1 {
                    self.minor.push(value);
                }
            }
        }
    }

    /// Ticks at equal steps of 1, 2 or 5 times a power of ten; the factor taken out of them.
    fn mark_steps(&mut self, most: usize) -> String {
        let largest = self.low.abs().max(self.high.abs());
        let exponent = match largest.log10().floor() as i32 {
            -3..=4 => 0,
            exponent => exponent.div_euclid(3) * 3,
        };
        let (low, high) = (self.low / 10f64.powi(exponent), self.high / 10f64.powi(exponent));
        self.ticks.clear();
        self.minor.clear();
        // On a short axis two ticks may not fit into steps for as many: one alone says nothing.
        let steps = (most..).map(|most| {
            let (step, decimals) = step(high - low, most);
            let ends = (low / step - 1e-9).ceil() as i64..=(high / step + 1e-9).floor() as i64;
            (step, decimals, ends)
        });
        let has_two = |(_, _, ends): &(f64, usize, RangeInclusive<i64>)| ends.end() > ends.start();
        let Some((step, decimals, ends)) = steps.take(10).find(has_two) else {
            return String::new();
        };
        for k in ends {
            let value = k as f64 * step;
            self.ticks
                .push(Tick { value: value * 10f64.powi(exponent), label: fixed(value, decimals) });
        }
        if exponent == 0 { String::new() } else { power_of_ten(exponent) }
    }
}

/// The smallest of 1, 2, 5 times a power of ten of which `span` holds less than `most`, and the
/// decimals it is written with.
fn step(span: f64, most: usize) -> (f64, usize) {
    let rough = span / most as f64;
    let exponent = rough.log10().floor() as i32;
    let unit = 10f64.powi(exponent);
    for factor in [1.0, 2.0, 5.0] {
        if factor * unit >= rough {
            return (factor * unit, (-exponent).max(0) as usize);
        }
    }
    (10.0 * unit, (-exponent - 1).max(0) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: Axis, extent: [f64; 2], most: usize) -> Vec<String> {
        Ruler::new(&axis, extent, most).ticks.into_iter().map(|t| t.label).collect()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(
            labels(Axis::new("x"), [0.8, 1.05], 6),
            ["0.80", "0.85", "0.90", "0.95", "1.00", "1.05"]
        );
        assert_eq!(
            labels(Axis::new("x"), [-1.0, 1.0], 4),
            ["\u{2212}1.0", "\u{2212}0.5", "0.0", "0.5", "1.0"]
        );
    }

    #[test]
    fn a_short_axis_has_two_ticks() {
        assert_eq!(labels(Axis::new("y"), [0.0, 0.41], 2), ["0.0", "0.2", "0.4"]);
        assert_eq!(labels(Axis::new("y"), [0.3, 0.9], 2), ["0.4", "0.6", "0.8"]);
    }

    #[test]
    fn processors_are_powers_of_two() {
        let axis = Axis::new("processors").scale(Scale::Log2);
        assert_eq!(
            labels(axis.clone(), [0.9, 140.0], 10),
            ["1", "2", "4", "8", "16", "32", "64", "128"]
        );
        assert_eq!(labels(axis, [0.5, 2.0], 10), ["0.5", "1", "2"]);
    }

    #[test]
    fn a_factor_is_taken_out_of_small_numbers() {
        let ruler = Ruler::new(&Axis::new("p").unit("Pa"), [0.0, 4e-6], 5);
        assert_eq!(ruler.title, "p (10⁻⁶ Pa)");
        assert_eq!(ruler.ticks.last().unwrap().label, "4");
    }

    #[test]
    fn a_short_logarithmic_axis_has_ticks_too() {
        let axis = Axis::new("t").scale(Scale::Log10);
        assert!(labels(axis.clone(), [0.31, 0.39], 6).len() >= 2);
        assert_eq!(
            labels(axis, [1e-7, 1.0], 8),
            ["10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "0.001", "0.01", "0.1", "1"]
        );
    }

    #[test]
    fn places_and_values_are_inverse() {
        for scale in [Scale::Linear, Scale::Log2, Scale::Log10] {
            let ruler = Ruler::new(&Axis::new("x").scale(scale), [0.5, 80.0], 5);
            for value in [0.5, 3.0, 80.0] {
                assert!((ruler.value_at(ruler.place(value)) - value).abs() < 1e-12 * value);
            }
        }
    }
}
