//! The lattice of cells and blocks that fits the particles.

use super::lattice::Lattice;
use super::{Cells, position, values_of};
use crate::columns::Columns;
use crate::real::Real;
use crate::team::Team;

impl<T: Real> Cells<T> {
    /// The lattice for the present positions.
    pub(super) fn fit(&mut self, columns: &Columns, team: &mut Team) -> Lattice {
        let dims = self.dims();
        let (mut lower, mut length, mut periodic) = ([0.0; 3], [1.0; 3], [false; 3]);
        for a in 0..dims {
            periodic[a] = self.region.periodic[a];
            let (mut low, mut high) = (self.region.lower[a], self.region.upper[a]);
            if !periodic[a] {
                let values = columns.values(self.positions[a]);
                let (least, most) = values
                    .iter()
                    .fold((T::infinity(), T::neg_infinity()), |m, &x| (m.0.min(x), m.1.max(x)));
                if !values.is_empty() {
                    (low, high) = (least.as_f64(), most.as_f64());
                }
            }
            lower[a] = low;
            length[a] = high - low;
        }
        // Positions are put into cells with a rounding error, which must not part two particles
        // that are exactly the range away from one another.
        let size = (0..dims).map(|a| lower[a].abs() + length[a]).fold(0.0, f64::max);
        let range = self.range + self.skin;
        let range = range + (8.0 * f64::EPSILON * size).min(range);
        let mut lattice = Lattice::new(lower, length, periodic, dims, range);
        // Particles a cell holds where there are any: were empty cells counted, a single particle
        // that flies away would make blocks of all others as large as the space between.
        let at = values_of(columns, &self.positions);
        let cells = self.sorter.distinct(team, columns.points(), |i| {
            lattice.key(lattice.coordinates(position(&at[..dims], i)))
        });
        let per_cell = columns.points() as f64 / cells.max(1) as f64;
        // As long in every direction as can be, where there are few cells first: what is missing
        // there, the other directions make up for.
        let mut wanted = self.block_points as f64 / per_cell.max(1.0);
        let mut axes = [0, 1, 2];
        axes[..dims].sort_unstable_by_key(|&a| lattice.counts[a]);
        for (&a, left) in axes[..dims].iter().zip((1..=dims).rev()) {
            let edge = wanted.max(1.0).powf(1.0 / left as f64).round() as i64;
            lattice.block[a] = edge.min(lattice.counts[a]);
            wanted /= lattice.block[a] as f64;
        }
        lattice
    }
}
