//! Values between samples, by cubics through four of them.

/// Lagrange's weights of samples at -1, 0, 1, 2 for a place, between 0 and 1 if it lies among them.
pub fn weights(x: f64) -> [f64; 4] {
    [
        -x * (x - 1.0) * (x - 2.0) / 6.0,
        (x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0,
        -(x + 1.0) * x * (x - 2.0) / 2.0,
        (x + 1.0) * x * (x - 1.0) / 6.0,
    ]
}

/// The value at a place counted in samples from the first, of which there are at least four; next to
/// the ends and beyond them that of the cubic through the outermost.
pub fn value(samples: &[f64], place: f64) -> f64 {
    let last = samples.len() as isize - 3;
    let first = (place.floor() as isize).clamp(1, last);
    let around = &samples[first as usize - 1..];
    around.iter().zip(weights(place - first as f64)).map(|(value, weight)| value * weight).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_are_exact() {
        let cubic = |x: f64| 1.0 - 2.0 * x + 0.3 * x * x - 0.1 * x.powi(3);
        let samples: Vec<f64> = (0..7).map(|i| cubic(f64::from(i))).collect();
        for x in [-0.5, 0.0, 0.3, 2.0, 3.7, 5.9, 6.0, 6.4] {
            assert!((value(&samples, x) - cubic(x)).abs() < 1e-13, "{x}");
        }
    }
}
