//! Particles of a start in bins, to find those around a point before there are cells.

use finegrain_framework::space::cells::Region;

/// Particles in bins about a spacing wide, periodic where the region is.
pub(crate) struct Bins<'a> {
    positions: &'a [[f64; 3]],
    lower: [f64; 3],
    side: [f64; 3],
    /// Number of bins in a period; 0 where there is none.
    counts: [i64; 3],
    /// Bin and number of every particle, in order.
    sorted: Vec<([i64; 3], u32)>,
}

impl<'a> Bins<'a> {
    /// Sorts particles into bins at least `side` wide, less than twice as wide where the box is
    /// wider.
    pub fn new(region: &Region, side: f64, positions: &'a [[f64; 3]]) -> Self {
        let mut bins = Self {
            positions,
            lower: [0.0; 3],
            side: [side; 3],
            counts: [0; 3],
            sorted: Vec::with_capacity(positions.len()),
        };
        for a in 0..region.lower.len() {
            bins.lower[a] = region.lower[a];
            if region.periodic[a] {
                let length = region.upper[a] - region.lower[a];
                let count = (length / side).floor().max(1.0);
                bins.counts[a] = count as i64;
                bins.side[a] = length / count;
            }
        }
        for (number, &x) in positions.iter().enumerate() {
            let bin = bins.bin(x);
            bins.sorted.push((std::array::from_fn(|a| bins.wrapped(a, bin[a])), number as u32));
        }
        bins.sorted.sort_unstable();
        bins
    }

    /// The first particle found, of those nearer to `x` than `radius`, that `is_wanted`.
    pub fn find(
        &self,
        x: [f64; 3],
        radius: f64,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Option<usize> {
        let (first, last) = (self.bin(x.map(|x| x - radius)), self.bin(x.map(|x| x + radius)));
        for k in first[2]..=last[2] {
            for j in first[1]..=last[1] {
                for i in first[0]..=last[0] {
                    let unwrapped = [i, j, k];
                    let bin = std::array::from_fn(|a| self.wrapped(a, unwrapped[a]));
                    let start = self.sorted.partition_point(|&(other, _)| other < bin);
                    let inside =
                        self.sorted[start..].iter().take_while(|&&(other, _)| other == bin);
                    let mut found = inside.map(|&(_, number)| number as usize).filter(|&number| {
                        self.distance(x, self.positions[number]) < radius && is_wanted(number)
                    });
                    if let Some(number) = found.next() {
                        return Some(number);
                    }
                }
            }
        }
        None
    }

    /// Distance of two points, or of the nearest of their periodic images.
    pub fn distance(&self, x: [f64; 3], y: [f64; 3]) -> f64 {
        let squares = (0..3).map(|a| {
            let period = self.counts[a] as f64 * self.side[a];
            let d = x[a] - y[a];
            let images = if period > 0.0 { (d / period).round() } else { 0.0 };
            (d - images * period).powi(2)
        });
        squares.sum::<f64>().sqrt()
    }

    fn bin(&self, x: [f64; 3]) -> [i64; 3] {
        std::array::from_fn(|a| ((x[a] - self.lower[a]) / self.side[a]).floor() as i64)
    }

    fn wrapped(&self, a: usize, i: i64) -> i64 {
        if self.counts[a] > 0 { i.rem_euclid(self.counts[a]) } else { i }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_near_is_found_across_the_period_and_nothing_else() {
        let region =
            Region { lower: vec![0.0; 2], upper: vec![1.0; 2], periodic: vec![true, false] };
        let positions = [[0.02, 0.5, 0.0], [0.5, 0.97, 0.0], [0.5, 0.5, 0.0]];
        let bins = Bins::new(&region, 0.1, &positions);
        let found = |x: f64, y: f64| bins.find([x, y, 0.0], 0.08, |_| true);
        assert_eq!(found(0.97, 0.5), Some(0));
        assert_eq!(found(-0.97, 0.5), Some(0));
        assert_eq!(found(0.5, 0.02), None);
        assert_eq!(found(0.5, 1.02), Some(1));
        assert_eq!(found(0.43, 0.46), None);
        assert_eq!(bins.find([0.5, 0.5, 0.0], 0.08, |i| i != 2), None);
    }
}
