//! Fields on points of the plane, from the particles around.

use finegrain_framework::{Columns, Real, State};
use finegrain_sph::Fields;

/// Velocity at each of `points`, see [`values`].
pub fn velocities<T: Real, P: Real>(
    columns: &Columns,
    fields: &Fields<T, P>,
    points: &[[f64; 2]],
    spacing: f64,
    cell: Option<[f64; 2]>,
) -> Vec<[f64; 2]> {
    let velocity = [fields.velocity[0], fields.velocity[1]];
    values(columns, fields, velocity, points, spacing, cell)
}

/// The values of `quantities` at each of `points`: a linear fit to the particles of the fluid within
/// three spacings, weighted with a Gaussian. NaN where there are too few. With the sides of a cell,
/// the particles are those of its periodic images, too.
pub fn values<T: Real, P: Real, const N: usize>(
    columns: &Columns,
    fields: &Fields<T, P>,
    quantities: [State<T>; N],
    points: &[[f64; 2]],
    spacing: f64,
    cell: Option<[f64; 2]>,
) -> Vec<[f64; N]> {
    // Sums of w (1, x, y) (1, x, y)^T, and of w (1, x, y) times each quantity.
    let mut sums = vec![([[0.0; 3]; 3], [[0.0; N]; 3]); points.len()];
    for i in 0..columns.points() {
        if fields.wall_depth.is_some_and(|depth| columns.values(depth)[i] > T::zero()) {
            continue;
        }
        let own = quantities.map(|column| columns.values(column)[i].as_f64());
        let at = [0, 1].map(|a| columns.values(fields.position[a])[i].as_f64());
        for ((matrix, right), point) in sums.iter_mut().zip(points) {
            let mut x = [at[0] - point[0], at[1] - point[1]];
            if let Some(cell) = cell {
                for a in 0..2 {
                    x[a] -= cell[a] * (x[a] / cell[a]).round();
                }
            }
            let x = x.map(|x| x / spacing);
            let squared = x[0] * x[0] + x[1] * x[1];
            if squared < 9.0 {
                let (weight, basis) = ((-squared).exp(), [1.0, x[0], x[1]]);
                for j in 0..3 {
                    for k in 0..3 {
                        matrix[j][k] += weight * basis[j] * basis[k];
                    }
                    for n in 0..N {
                        right[j][n] += weight * basis[j] * own[n];
                    }
                }
            }
        }
    }
    sums.iter()
        .map(|(matrix, right)| {
            std::array::from_fn(|n| first_unknown(matrix, right.map(|right| right[n])))
        })
        .collect()
}

/// The first unknown of three linear equations, by Cramer's rule.
fn first_unknown(matrix: &[[f64; 3]; 3], right: [f64; 3]) -> f64 {
    let determinant = |m: &[[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
            - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let mut replaced = *matrix;
    for (row, right) in replaced.iter_mut().zip(right) {
        row[0] = right;
    }
    determinant(&replaced) / determinant(matrix)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_equations_are_solved() {
        let matrix = [[2.0, 1.0, 0.0], [1.0, 3.0, 1.0], [0.0, 1.0, 4.0]];
        // Of (1, 2, 3).
        assert!((first_unknown(&matrix, [4.0, 10.0, 14.0]) - 1.0).abs() < 1e-14);
    }
}
