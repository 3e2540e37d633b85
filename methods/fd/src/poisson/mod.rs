//! Poisson's equation on a box, solved directly: fast diagonalisation, one axis after the other.
//!
//! Along an axis that is periodic or lies between walls, waves are the eigenvectors of the difference operators,
//! whatever their order (Lynch, Rice & Thomas 1964; Schumann & Sweet 1988, J. Comput. Phys. 75), and so they are, of
//! second order, where the solution vanishes at the upper end. With the
//! eigenvalues of the *discrete* operator the discrete equation is solved to round-off, in `O(N log N)`.
//! Every row is transformed by one worker, so that the bits do not depend on how many there are.

pub(crate) mod axis;

use finegrain_framework::space::Grid;
use finegrain_framework::{Fault, Rate, Team, Whole, WholeStage};

use crate::model::Compiled;
use axis::{Axis, Scratch};

/// Rows that are transposed together: a cache line of each is read.
const BLOCK: usize = 16;

/// Solves `-sum_a lambda_a p = q`: one eigenvalue for each wave of each axis, none below zero. Where all vanish, for
/// the mean, the solution is taken to have none. Beyond the place at the end of an open axis where it vanishes, the
/// right-hand side does not count, and the solution is the odd continuation.
pub(crate) struct Solver<T: Compiled> {
    axes: Vec<Axis<T>>,
    eigenvalues: Vec<Vec<f64>>,
    turned: Vec<T>,
    scratch: Vec<Scratch<T>>,
}

impl<T: Compiled> Solver<T> {
    /// For an operator along each of 2 or 3 axes, that takes waves by their angle per spacing, radians, to its
    /// eigenvalue.
    pub fn new(axes: Vec<Axis<T>>, eigenvalue: impl Fn(usize, f64) -> f64) -> Self {
        let of_axis = |(a, axis): (usize, &Axis<T>)| {
            axis.angles().into_iter().map(|angle| eigenvalue(a, angle)).collect()
        };
        let eigenvalues = axes.iter().enumerate().map(of_axis).collect();
        let points = axes.iter().map(Axis::points).product();
        Self { axes, eigenvalues, turned: vec![T::zero(); points], scratch: Vec::new() }
    }

    /// Puts the solution in the place of the right-hand side, x running fastest.
    pub fn solve(&mut self, team: &mut Team, values: &mut [T]) {
        let Self { axes, eigenvalues, turned, scratch } = self;
        scratch.resize_with(team.workers().max(scratch.len()), Scratch::default);
        let scale = 1.0 / axes.iter().map(Axis::gain).product::<f64>();
        let inverse = |sum: f64| T::of(if sum > 0.0 { -scale / sum } else { 0.0 });
        let [nx, ny] = [axes[0].points(), axes[1].points()];
        team.for_each_chunk_with(scratch, values, BLOCK * nx, |scratch, _, rows| {
            rows.chunks_exact_mut(nx).for_each(|row| axes[0].forward(row, scratch));
        });
        if let [_, y] = &axes[..] {
            let task = |scratch: &mut Scratch<T>, block: usize, rows: &mut [T]| {
                transpose(values, [ny, nx], block * BLOCK, rows);
                for (row, &lambda) in
                    rows.chunks_exact_mut(ny).zip(&eigenvalues[0][block * BLOCK..])
                {
                    y.forward(row, scratch);
                    for (u, mu) in row.iter_mut().zip(&eigenvalues[1]) {
                        *u *= inverse(lambda + mu);
                    }
                    y.back(row, scratch);
                }
            };
            team.for_each_chunk_with(scratch, turned, BLOCK * ny, task);
        } else {
            let nz = axes[2].points();
            for (from, to) in values.chunks_exact(nx * ny).zip(turned.chunks_exact_mut(nx * ny)) {
                team.for_each_chunk_with(scratch, to, BLOCK * ny, |scratch, block, rows| {
                    transpose(from, [ny, nx], block * BLOCK, rows);
                    rows.chunks_exact_mut(ny).for_each(|row| axes[1].forward(row, scratch));
                });
            }
            team.for_each_chunk_with(scratch, values, BLOCK * nz, |scratch, block, rows| {
                transpose(turned, [nz, nx * ny], block * BLOCK, rows);
                for (n, row) in (block * BLOCK..).zip(rows.chunks_exact_mut(nz)) {
                    let lambda = eigenvalues[0][n / ny] + eigenvalues[1][n % ny];
                    axes[2].forward(row, scratch);
                    for (u, mu) in row.iter_mut().zip(&eigenvalues[2]) {
                        *u *= inverse(lambda + mu);
                    }
                    axes[2].back(row, scratch);
                }
            });
            team.for_each_chunk_with(scratch, turned, nx * ny, |scratch, plane, rows| {
                transpose(values, [nx * ny, nz], plane, rows);
                rows.chunks_exact_mut(ny).for_each(|row| axes[1].back(row, scratch));
            });
        }
        for (from, to) in turned.chunks_exact(nx * ny).zip(values.chunks_exact_mut(nx * ny)) {
            team.for_each_chunk_with(scratch, to, BLOCK * nx, |scratch, block, rows| {
                transpose(from, [nx, ny], block * BLOCK, rows);
                rows.chunks_exact_mut(nx).for_each(|row| axes[0].back(row, scratch));
            });
        }
    }
}

/// Fills `to` with columns of a matrix of `[rows, columns]`, from column `first` on. A few rows at a time, for the
/// elements of a column are a power of two apart where meshes are, and such lines push each other out of the cache.
fn transpose<T: Copy>(matrix: &[T], [rows, columns]: [usize; 2], first: usize, to: &mut [T]) {
    const ROWS: usize = 8;
    for (n, band) in matrix.chunks(ROWS * columns).enumerate() {
        for (c, to) in to.chunks_exact_mut(rows).enumerate() {
            let to = to[n * ROWS..].iter_mut();
            to.zip(band[first + c..].iter().step_by(columns)).for_each(|(to, &value)| *to = value);
        }
    }
}

/// The whole-domain stage that puts the solution in the place of the right-hand side.
pub(crate) struct Poisson<T: Compiled> {
    pub solver: Solver<T>,
    pub column: Rate<T>,
}

impl<T: Compiled> WholeStage<Grid> for Poisson<T> {
    fn name(&self) -> &str {
        "pressure solve"
    }

    fn run(&mut self, whole: &mut Whole<'_, Grid>) -> Result<(), Fault> {
        self.solver.solve(whole.team, whole.columns.values_mut(self.column));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::axis::Waves::{self, Closed, Open, Periodic};
    use super::*;

    /// Applies the operator of second order that the eigenvalues below are of; beyond an open axis it is 0.
    fn apply(shape: [usize; 3], ends: [Waves; 3], p: &[f64]) -> Vec<f64> {
        let at = |x: [usize; 3]| p[(x[2] * shape[1] + x[1]) * shape[0] + x[0]];
        let value = |n: usize| {
            let x = point(shape, n);
            let mut sum = 0.0;
            for a in 0..3 {
                if ends[a] == Open && x[a] + 1 == shape[a] {
                    return 0.0;
                }
                for by in [-1, 1] {
                    let moved = x[a] as isize + by;
                    let inside = (0..shape[a] as isize).contains(&moved);
                    let mut y = x;
                    y[a] = moved.rem_euclid(shape[a] as isize) as usize;
                    if inside || ends[a] == Periodic {
                        sum += (at(y) - at(x)) * (a + 1) as f64;
                    }
                }
            }
            sum
        };
        (0..p.len()).map(value).collect()
    }

    fn point(shape: [usize; 3], n: usize) -> [usize; 3] {
        [n % shape[0], n / shape[0] % shape[1], n / (shape[0] * shape[1])]
    }

    #[test]
    fn the_discrete_equation_is_solved_to_round_off_with_the_same_bits() {
        for (shape, ends) in [
            ([12, 9, 1], [Periodic, Periodic, Periodic]),
            ([33, 20, 1], [Closed, Closed, Periodic]),
            ([16, 37, 1], [Periodic, Closed, Periodic]),
            ([41, 18, 1], [Open, Closed, Periodic]),
            ([24, 30, 1], [Periodic, Open, Periodic]),
            ([20, 18, 24], [Periodic, Closed, Periodic]),
            ([17, 6, 5], [Closed, Periodic, Closed]),
            ([21, 16, 8], [Open, Closed, Periodic]),
            ([10, 8, 17], [Closed, Periodic, Open]),
        ] {
            let dims = if shape[2] == 1 { 2 } else { 3 };
            let solver = || {
                let axes = (0..dims).map(|a| Axis::new(shape[a], ends[a])).collect();
                Solver::<f64>::new(axes, |a, angle| {
                    (2.0 * (0.5 * angle).sin()).powi(2) * (a + 1) as f64
                })
            };
            let points = shape.iter().product::<usize>();
            let mut wanted: Vec<f64> = (0..points).map(|i| (0.9 * i as f64).sin()).collect();
            if let Some(a) = ends.iter().position(|&ends| ends == Open) {
                let stride: usize = shape[..a].iter().product();
                for n in (0..points).filter(|&n| point(shape, n)[a] + 1 == shape[a]) {
                    wanted[n] = -wanted[n - stride];
                }
            } else {
                let mean = wanted.iter().sum::<f64>() / points as f64;
                wanted.iter_mut().for_each(|p| *p -= mean);
            }
            let source = apply(shape, ends, &wanted);
            let solved = |workers| {
                let mut values = source.clone();
                solver().solve(&mut Team::new(workers).unwrap(), &mut values);
                values
            };
            let found = solved(1);
            let difference = found.iter().zip(&wanted).map(|(p, w)| (p - w).abs());
            let largest = difference.fold(0.0, f64::max);
            assert!(largest < 2e-13, "{shape:?}: {largest:e}");
            assert_eq!(solved(3), found);
        }
    }
}
