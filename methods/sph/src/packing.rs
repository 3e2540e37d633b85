//! Packings: exactly periodic lattices to place particles on.

use finegrain_framework::{NoMemory, check_memory};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;
use thiserror::Error;

use crate::dimension::Dimension;

/// How particles are packed at the start.
///
/// Each packing repeats an orthogonal cell, so a whole number of cells in each direction is
/// periodic without a fault: every particle has all its nearest neighbours at the spacing `d`,
/// also through the faces of the box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Packing {
    /// Rows `d` apart in the plane; 4 nearest neighbours.
    Square,
    /// Rows `sqrt(3)/2 d` apart in the plane, every other one shifted by `d/2`; 6 nearest
    /// neighbours.
    Hexagonal,
    /// Square layers `d` apart; 6 nearest neighbours.
    Cubic,
    /// Hexagonal layers `sqrt(2/3) d` apart, in the order ABAB (hcp); 12 nearest neighbours. The
    /// packing of Holmes, Williams & Tilke (2011, section 5.1).
    HexagonalClosePacked,
}

/// Why a lattice cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum PackingError {
    /// The spacing is zero, negative or not finite.
    #[error("particle spacing must be finite and above zero, not {0}")]
    Spacing(f64),
    /// A side of the box holds less than half a cell, or is not finite.
    #[error("side {side} of the box must be finite and at least {least}, not {length}")]
    Side {
        /// The direction: 0, 1 or 2.
        side: usize,
        /// The length asked for.
        length: f64,
        /// The least length that can be filled: half a cell.
        least: f64,
    },
    /// The box holds more than 2^32 particles.
    #[error("the box holds {0:e} particles, more than 2^32")]
    Count(f64),
    /// The box holds more particles than the system has memory for.
    #[error("the box holds {particles} particles: {cause}; choose fewer")]
    Memory {
        /// How many.
        particles: usize,
        /// What they take.
        #[source]
        cause: NoMemory,
    },
}

/// What a particle takes at least, bytes: where it is put at the start, and its position, velocity and
/// acceleration in three directions of 32 bits.
const LEAST_BYTES: usize = 24 + 3 * 12;

impl Packing {
    /// The dimension of the space that is packed.
    pub const fn dimension(self) -> Dimension {
        match self {
            Packing::Square | Packing::Hexagonal => Dimension::Two,
            Packing::Cubic | Packing::HexagonalClosePacked => Dimension::Three,
        }
    }

    /// Sides of the repeated cell in spacings; 0 in `z` in the plane.
    fn cell(self) -> [f64; 3] {
        match self {
            Packing::Square => [1.0, 1.0, 0.0],
            Packing::Hexagonal => [1.0, 3.0_f64.sqrt(), 0.0],
            Packing::Cubic => [1.0, 1.0, 1.0],
            Packing::HexagonalClosePacked => [1.0, 3.0_f64.sqrt(), (8.0_f64 / 3.0).sqrt()],
        }
    }

    /// Particles of the repeated cell, in fractions of its sides; the outermost rows are equally
    /// far from opposite faces.
    fn basis(self) -> &'static [[f64; 3]] {
        const THIRD: f64 = 1.0 / 3.0;
        match self {
            Packing::Square => &[[0.5, 0.5, 0.0]],
            Packing::Hexagonal => &[[0.25, 0.25, 0.0], [0.75, 0.75, 0.0]],
            Packing::Cubic => &[[0.5, 0.5, 0.5]],
            Packing::HexagonalClosePacked => &[
                // Layer A, then layer B: shifted by d/2 in x and sqrt(3)/6 d in y.
                [0.25, 0.5 * THIRD, 0.25],
                [0.75, 2.0 * THIRD, 0.25],
                [0.75, THIRD, 0.75],
                [0.25, 2.5 * THIRD, 0.75],
            ],
        }
    }

    /// Fits a box of about the sides `wished` to whole cells of particles `spacing` apart.
    ///
    /// The spacing is kept and the box is moved: each side becomes the nearest whole number of
    /// cells, so it changes by half a cell at most. Half a cell is, in spacings, 1/2 for square
    /// and cubic packing, and for the hexagonal ones 1/2 in `x`, `sqrt(3)/2` in `y` and
    /// `sqrt(2/3)` in `z`. In the plane `wished[2]` is not used.
    ///
    /// # Errors
    /// [`PackingError`] if the spacing is not a length, a side cannot hold half a cell, or there
    /// are more particles than 2^32 or than the system has memory for.
    pub fn fit(self, wished: [f64; 3], spacing: f64) -> Result<Lattice, PackingError> {
        if !(spacing > 0.0 && spacing.is_finite()) {
            return Err(PackingError::Spacing(spacing));
        }
        let mut repeats = [1.0; 3];
        for side in 0..self.dimension().number() {
            let cell = self.cell()[side] * spacing;
            let length = wished[side];
            repeats[side] = (length / cell).round();
            if !(repeats[side] >= 1.0 && length.is_finite()) {
                let least = 0.5 * cell;
                return Err(PackingError::Side { side, length, least });
            }
        }
        let count = self.basis().len() as f64 * repeats.iter().product::<f64>();
        if count > 2.0_f64.powi(32) {
            return Err(PackingError::Count(count));
        }
        let lattice = Lattice { packing: self, spacing, repeats: repeats.map(|n| n as usize) };
        let particles = lattice.count();
        check_memory(particles, LEAST_BYTES)
            .map_err(|cause| PackingError::Memory { particles, cause })?;
        Ok(lattice)
    }
}

/// Particles packed into a periodic box with one corner at the origin.
///
/// ```
/// use finegrain_sph::packing::Packing;
///
/// let lattice = Packing::HexagonalClosePacked.fit([0.025, 0.025, 0.001], 0.0002)?;
/// assert_eq!(lattice.count(), 108_000);
/// let volume: f64 = lattice.lengths().iter().product();
/// assert!((lattice.count() as f64 * lattice.volume_per_particle() / volume - 1.0).abs() < 1e-12);
/// # Ok::<(), finegrain_sph::packing::PackingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    packing: Packing,
    spacing: f64,
    /// Number of cells in each direction; 1 in `z` in the plane.
    repeats: [usize; 3],
}

impl Lattice {
    /// Sides of the box after fitting, in metres; 0 in `z` in the plane.
    pub fn lengths(&self) -> [f64; 3] {
        let cell = self.cell();
        [0, 1, 2].map(|k| self.repeats[k] as f64 * cell[k])
    }

    /// Number of particles.
    pub fn count(&self) -> usize {
        self.packing.basis().len() * self.repeats.iter().product::<usize>()
    }

    /// Volume that belongs to a particle, in cubic metres: `d^3 / sqrt(2)` for hexagonal close
    /// packing, `d^3` for cubic. In the plane an area, in square metres: `sqrt(3)/2 d^2` for
    /// hexagonal packing, `d^2` for square.
    pub fn volume_per_particle(&self) -> f64 {
        let dimension = self.packing.dimension().number();
        let volume: f64 = self.cell()[..dimension].iter().product();
        volume / self.packing.basis().len() as f64
    }

    /// Positions of the particles, in metres, from 0 up to and without the sides of the box; 0 in
    /// `z` in the plane. Cell by cell, `x` first.
    pub fn positions(&self) -> impl Iterator<Item = [f64; 3]> {
        let cell = self.cell();
        let [columns, rows, layers] = self.repeats;
        let corners = (0..layers)
            .flat_map(move |k| (0..rows).flat_map(move |j| (0..columns).map(move |i| [i, j, k])));
        corners.flat_map(move |corner| {
            let basis = self.packing.basis().iter();
            basis.map(move |at| [0, 1, 2].map(|k| (corner[k] as f64 + at[k]) * cell[k]))
        })
    }

    /// The positions, each moved at random by up to `fraction` spacings in every direction of the
    /// packed space and wrapped into the box.
    ///
    /// Displacements are even in `[-fraction d, fraction d)`. The same `seed` gives the same bits
    /// on every machine and with every version of the libraries: the generator is PCG XSL RR
    /// 128/64 (O'Neill 2014) with its state and stream set here, each direction takes one 64-bit
    /// output, and its upper 53 bits are the number; a test compares with the published outputs.
    ///
    /// # Panics
    /// If `fraction` is negative or not finite.
    pub fn displaced_positions(&self, fraction: f64, seed: u64) -> impl Iterator<Item = [f64; 3]> {
        /// The stream of the generator's published outputs; any would do.
        const STREAM: u128 = 54;
        assert!(
            fraction >= 0.0 && fraction.is_finite(),
            "displacement must be finite and not negative, not {fraction}"
        );
        let mut generator = Pcg64::new(u128::from(seed), STREAM);
        let reach = fraction * self.spacing;
        let dimension = self.packing.dimension().number();
        let lengths = self.lengths();
        self.positions().map(move |mut x| {
            for k in 0..dimension {
                let even = (generator.next_u64() >> 11) as f64 * 2.0_f64.powi(-53);
                x[k] = wrap(x[k] + reach * (2.0 * even - 1.0), lengths[k]);
            }
            x
        })
    }

    /// Sides of the repeated cell in metres.
    fn cell(&self) -> [f64; 3] {
        self.packing.cell().map(|side| side * self.spacing)
    }
}

/// The periodic image of `x` that is in `[0, length)`.
fn wrap(x: f64, length: f64) -> f64 {
    let image = x.rem_euclid(length);
    // A tiny negative x rounds to the length itself.
    if image < length { image } else { 0.0 }
}

#[cfg(test)]
mod tests;
