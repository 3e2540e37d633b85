//! Values at the nearest of many points of a plane.

/// Points in square bins, to find the one that is nearest to a place.
pub(super) struct Nearest<'a> {
    points: &'a [([f64; 2], f64)],
    /// Side of the bins, and how far away a point counts as near.
    reach: f64,
    /// Lower corner of the first bin.
    low: [f64; 2],
    /// Number of bins in each direction.
    shape: [usize; 2],
    /// Indices of the points, bin by bin.
    sorted: Vec<usize>,
    /// Where in `sorted` each bin begins; one more for the end.
    start: Vec<usize>,
}

impl<'a> Nearest<'a> {
    /// Points that count as near within `reach`.
    pub fn new(points: &'a [([f64; 2], f64)], reach: f64) -> Self {
        let extreme = |a: usize, of: fn(f64, f64) -> f64| {
            points.iter().map(|(position, _)| position[a]).reduce(of).unwrap_or(0.0)
        };
        let low = [0, 1].map(|a| extreme(a, f64::min));
        let shape = [0, 1].map(|a| ((extreme(a, f64::max) - low[a]) / reach) as usize + 1);
        let mut nearest = Self { points, reach, low, shape, sorted: Vec::new(), start: Vec::new() };
        let bins: Vec<_> = points
            .iter()
            .map(|&(position, _)| {
                let [i, j] = nearest.bin(position);
                j as usize * shape[0] + i as usize
            })
            .collect();
        nearest.sorted = (0..points.len()).collect();
        nearest.sorted.sort_by_key(|&k| bins[k]);
        nearest.start = (0..=shape[0] * shape[1])
            .map(|bin| nearest.sorted.partition_point(|&k| bins[k] < bin))
            .collect();
        nearest
    }

    /// The bin of a place, which need not exist.
    fn bin(&self, place: [f64; 2]) -> [i64; 2] {
        [0, 1].map(|a| ((place[a] - self.low[a]) / self.reach).floor() as i64)
    }

    /// Value of the point that is nearest to `place`, if one is near; of several the first.
    pub fn value_at(&self, place: [f64; 2]) -> Option<f64> {
        let [column, row] = self.bin(place);
        let around = |at: i64, bins: usize| (at - 1).max(0)..(at + 2).min(bins as i64);
        let (mut least, mut value) = (self.reach * self.reach, None);
        for j in around(row, self.shape[1]) {
            for i in around(column, self.shape[0]) {
                let bin = j as usize * self.shape[0] + i as usize;
                for &k in &self.sorted[self.start[bin]..self.start[bin + 1]] {
                    let (position, of) = self.points[k];
                    let squared: f64 =
                        [0, 1].map(|a| (position[a] - place[a]).powi(2)).iter().sum();
                    if squared < least {
                        (least, value) = (squared, Some(of));
                    }
                }
            }
        }
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_within_reach_and_nothing_beyond() {
        let points = [([0.0, 0.0], 1.0), ([1.0, 0.0], 2.0), ([-0.9, -0.9], 3.0)];
        let nearest = Nearest::new(&points, 0.8);
        assert_eq!(nearest.value_at([0.4, 0.1]), Some(1.0));
        assert_eq!(nearest.value_at([0.6, 0.1]), Some(2.0));
        assert_eq!(nearest.value_at([-0.5, -0.5]), Some(3.0));
        assert_eq!(nearest.value_at([0.5, 0.7]), None);
        assert_eq!(nearest.value_at([f64::NAN, 0.0]), None);
    }
}
