//! The lattice of possible cells: where they lie, how they are numbered, which are near.

/// Geometry of the cells, decided anew at every sort where a direction is open.
///
/// Cell (i, j, k) has key `(k ny + j) nx + i` (Holmes et al. 2011, eq. 8).
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lattice {
    pub lower: [f64; 3],
    pub side: [f64; 3],
    /// Possible cells in each direction.
    pub counts: [i64; 3],
    /// Length of the period; 0 where a direction is open or does not exist.
    pub period: [f64; 3],
    /// How many cells away an interaction can reach.
    pub reach: [i64; 3],
    /// Cells of a block in each direction.
    pub block: [i64; 3],
}

impl Lattice {
    /// Cells over the box from `lower` with sides `length`, each side as long as `range` or a
    /// little longer. Across a thin box they are up to half as long: with one or two cells
    /// around it everything would be a candidate of everything.
    pub fn new(
        lower: [f64; 3],
        length: [f64; 3],
        periodic: [bool; 3],
        dims: usize,
        range: f64,
    ) -> Self {
        let mut lattice = Self {
            lower,
            side: [1.0; 3],
            counts: [1; 3],
            period: [0.0; 3],
            reach: [0; 3],
            block: [1; 3],
        };
        for a in 0..dims {
            let ranges = length[a] / range;
            let fit = if ranges < 3.0 { (2.0 * ranges).floor() } else { ranges.floor() };
            // More cells than an i32 counts would be a particle that has flown away; the keys
            // still fit 64 bits.
            let counts = fit.clamp(1.0, 1_000_000.0);
            lattice.counts[a] = counts as i64;
            lattice.side[a] = length[a] / counts;
            if periodic[a] {
                lattice.period[a] = length[a];
            } else {
                lattice.side[a] = lattice.side[a].max(0.5 * range);
            }
            lattice.reach[a] = (range / lattice.side[a]).ceil() as i64;
        }
        lattice
    }

    /// Cell coordinates of a position inside the box.
    #[inline]
    pub fn coordinates(&self, x: [f64; 3]) -> [i64; 3] {
        std::array::from_fn(|a| {
            let i = ((x[a] - self.lower[a]) / self.side[a]).floor() as i64;
            i.clamp(0, self.counts[a] - 1)
        })
    }

    /// Key of a cell.
    #[inline]
    pub fn key(&self, [i, j, k]: [i64; 3]) -> u64 {
        ((k * self.counts[1] + j) * self.counts[0] + i) as u64
    }

    /// Blocks in each direction.
    fn blocks(&self) -> [i64; 3] {
        std::array::from_fn(|a| (self.counts[a] + self.block[a] - 1) / self.block[a])
    }

    /// Key of a block of cells, from the coordinates of the block.
    #[inline]
    pub fn block_key(&self, [i, j, k]: [i64; 3]) -> u64 {
        let [nx, ny, _] = self.blocks();
        ((k * ny + j) * nx + i) as u64
    }

    /// The block that a cell belongs to.
    #[inline]
    pub fn block_of(&self, cell: [i64; 3]) -> [i64; 3] {
        std::array::from_fn(|a| cell[a] / self.block[a])
    }

    /// Coordinates of a block from its key.
    pub fn block_at(&self, key: u64) -> [i64; 3] {
        let [nx, ny, _] = self.blocks();
        let key = key as i64;
        [key % nx, key / nx % ny, key / (nx * ny)]
    }

    /// What particles are sorted by: block after block, within a block by key of the cell.
    #[inline]
    pub fn sort_key(&self, cell: [i64; 3]) -> u64 {
        let block = self.block_of(cell);
        let [bx, by, bz] = self.block;
        let inside: [i64; 3] = std::array::from_fn(|a| cell[a] - block[a] * self.block[a]);
        let inside = (inside[2] * by + inside[1]) * bx + inside[0];
        self.block_key(block) * (bx * by * bz) as u64 + inside as u64
    }

    /// Inverse of [`Lattice::sort_key`].
    pub fn cell_sorted(&self, sort_key: u64) -> [i64; 3] {
        let [bx, by, bz] = self.block;
        let volume = (bx * by * bz) as u64;
        let block = self.block_at(sort_key / volume);
        let inside = (sort_key % volume) as i64;
        let inside = [inside % bx, inside / bx % by, inside / (bx * by)];
        std::array::from_fn(|a| block[a] * self.block[a] + inside[a])
    }

    /// Largest sort key plus one.
    pub fn sort_keys(&self) -> u64 {
        let volume: i64 = self.block.iter().product();
        let blocks: i64 = self.blocks().iter().product();
        (volume * blocks) as u64
    }

    /// The cell at unwrapped coordinates along axis `a`, and the shift that brings its contents
    /// to where they are seen; `None` outside an open box.
    #[inline]
    pub fn image(&self, a: usize, i: i64) -> Option<(i64, f64)> {
        let n = self.counts[a];
        if (0..n).contains(&i) {
            Some((i, 0.0))
        } else if self.period[a] > 0.0 {
            Some((i.rem_euclid(n), i.div_euclid(n) as f64 * self.period[a]))
        } else {
            None
        }
    }

    /// Block coordinates along axis `a` that hold cells within reach of block `i`, ascending.
    pub fn near_blocks(&self, a: usize, i: i64, near: &mut Vec<i64>) {
        near.clear();
        let last = ((i + 1) * self.block[a]).min(self.counts[a]) - 1;
        for cell in i * self.block[a] - self.reach[a]..=last + self.reach[a] {
            if let Some((cell, _)) = self.image(a, cell) {
                near.push(cell / self.block[a]);
            }
        }
        near.sort_unstable();
        near.dedup();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_invertible() {
        let mut lattice = Lattice::new([0.0; 3], [7.0, 5.0, 4.0], [true; 3], 3, 1.0);
        lattice.block = [2, 3, 1];
        for k in 0..4 {
            for j in 0..5 {
                for i in 0..7 {
                    let cell = [i, j, k];
                    let sort_key = lattice.sort_key(cell);
                    assert_eq!(lattice.cell_sorted(sort_key), cell);
                    assert!(sort_key < lattice.sort_keys());
                }
            }
        }
    }

    #[test]
    fn a_thin_box_is_seen_through_several_images() {
        let lattice = Lattice::new([0.0; 3], [8.0, 0.4, 1.5], [true; 3], 3, 1.0);
        assert_eq!(lattice.counts, [8, 1, 3]);
        assert_eq!(lattice.reach, [1, 3, 2]);
        assert_eq!(lattice.image(1, -3), Some((0, -3.0 * 0.4)));
    }
}
