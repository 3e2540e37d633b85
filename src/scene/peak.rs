//! Extrema between samples.

/// Place, in samples, and value of the top of the parabola through the largest value and its neighbours;
/// the largest value itself if it is at an end.
pub fn largest(values: &[f64]) -> (f64, f64) {
    let mut at = 0;
    for (i, value) in values.iter().enumerate() {
        if *value > values[at] {
            at = i;
        }
    }
    if at == 0 || at + 1 >= values.len() {
        return (at as f64, values.get(at).copied().unwrap_or(f64::NAN));
    }
    let [before, here, after] = [values[at - 1], values[at], values[at + 1]];
    let (slope, curvature) = (0.5 * (after - before), before - 2.0 * here + after);
    if curvature < 0.0 {
        (at as f64 - slope / curvature, here - 0.5 * slope * slope / curvature)
    } else {
        (at as f64, here)
    }
}

/// As [`largest`], of the least value.
pub fn least(values: &[f64]) -> (f64, f64) {
    let (at, value) = largest(&values.iter().map(|v| -v).collect::<Vec<_>>());
    (at, -value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_top_of_a_parabola_is_found_between_points() {
        let values: Vec<f64> = (0..9).map(|i| 3.0 - (f64::from(i) - 4.3).powi(2)).collect();
        let (at, value) = largest(&values);
        assert!((value - 3.0).abs() < 1e-14 && (at - 4.3).abs() < 1e-14);
        assert_eq!(largest(&[2.0, 1.0, 0.0]), (0.0, 2.0));
        assert_eq!(least(&[2.0, 1.0, 0.0]), (2.0, 0.0));
        assert!(largest(&[]).1.is_nan());
    }
}
