//! What follows from the moment matrix of a particle's neighbours: the correction of the kernel
//! gradient, the gradient of the density, and how near the free surface is.

use finegrain_framework::space::Cells;
use finegrain_framework::{Fault, Moment, Own, Real, Stage, UpdateStage};
use nalgebra::Matrix3;

use crate::evaluation::{Piece, Update};
use crate::fields::Fields;
use crate::quantity::{Quantity, component};
use crate::term::moment::{DensitySlope, MomentMatrix};
use crate::term::{AnyTerm, Term};

/// The least eigenvalue of a moment matrix that is inverted: below it, in a free surface's
/// outermost particles and spray, gradients stay as they are (half of the unit matrix is what a
/// flat surface leaves across itself).
const LEAST_EIGENVALUE: f64 = 0.1;

/// The update after the sums of [`crate::term::moment`]; the correction is the inverse of the moment
/// matrix (Bonet & Lok 1999, eq. 46).
#[derive(Clone, Debug)]
pub(crate) struct Correction<T, P> {
    fields: Fields<T, P>,
}

impl<T: Real, P: Real> Correction<T, P> {
    /// The sums and the update for what `terms` read of it; none if that is nothing.
    pub fn pieces(dims: usize, terms: &[AnyTerm<T>]) -> Vec<Piece<T, P>> {
        let is_ours = |q: &Quantity| {
            use Quantity::{Correction, DensityGradient, Fullness};
            matches!(q, Correction(_) | DensityGradient(_) | Fullness)
        };
        let reads = terms.iter().flat_map(|term| term.reads(dims));
        let wanted: Vec<_> = reads.filter(is_ours).collect();
        if wanted.is_empty() {
            return Vec::new();
        }
        let mut pieces =
            vec![Self::update(dims, &wanted), Piece::Term(MomentMatrix::default().into())];
        if wanted.contains(&Quantity::DensityGradient(0)) {
            pieces.push(Piece::Term(DensitySlope::default().into()));
        }
        pieces
    }

    /// The update that writes those of the quantities that are in `wanted`.
    fn update(dims: usize, wanted: &[Quantity]) -> Piece<T, P> {
        let moments = Quantity::symmetric(Quantity::Moment, dims);
        let slopes = Quantity::vector(Quantity::DensitySlope, dims)
            .filter(|_| wanted.contains(&Quantity::DensityGradient(0)));
        let writes = Quantity::symmetric(Quantity::Correction, dims)
            .chain(Quantity::vector(Quantity::DensityGradient, dims))
            .chain([Quantity::Fullness]);
        Piece::Update(Update {
            reads: moments.chain(slopes).collect(),
            writes: writes.filter(|q| wanted.contains(q)).collect(),
            amends: false,
            stage: Box::new(|fields| Stage::update(Self { fields: fields.clone() })),
        })
    }
}

impl<T: Real, P: Real> UpdateStage<Cells<P>> for Correction<T, P> {
    type Scratch = ();

    fn name(&self) -> &str {
        "correction of the kernel gradient"
    }

    fn update(&self, own: &mut Own<'_, Cells<P>>, _: &mut (), _: &Moment) -> Result<(), Fault> {
        let fields = &self.fields;
        let dims = fields.position.len();
        let mut moment = [&[][..]; 6];
        for (moment, &column) in moment.iter_mut().zip(&fields.moment) {
            *moment = own.rate(column).whole();
        }
        let mut slope = [&[][..]; 3];
        for (slope, &column) in slope.iter_mut().zip(&fields.density_slope) {
            *slope = own.rate(column).whole();
        }
        let mut correction = [(); 6].map(|()| &mut [][..]);
        for (correction, &column) in correction.iter_mut().zip(&fields.correction) {
            *correction = own.state_mut(column).whole();
        }
        let mut gradient = [(); 3].map(|()| &mut [][..]);
        for (gradient, &column) in gradient.iter_mut().zip(&fields.density_gradient) {
            *gradient = own.state_mut(column).whole();
        }
        let fullness = match fields.fullness {
            Some(column) => own.state_mut(column).whole(),
            None => &mut [],
        };
        for i in 0..moment[0].len() {
            // In fewer dimensions the rest is the unit matrix, which changes nothing.
            let mut matrix = Matrix3::identity();
            for a in 0..dims {
                for b in 0..dims {
                    matrix[(a, b)] = moment[component(a, b)][i].as_f64();
                }
            }
            let least = least_eigenvalue(&matrix, dims);
            let is_invertible = least > LEAST_EIGENVALUE;
            let inverse = Some(matrix).filter(|_| is_invertible).and_then(Matrix3::try_inverse);
            let inverse = inverse.unwrap_or_else(Matrix3::identity);
            if let Some(fullness) = fullness.get_mut(i) {
                *fullness = T::of(least);
            }
            for a in 0..fields.density_gradient.len() {
                let sum: f64 = (0..dims).map(|b| inverse[(a, b)] * slope[b][i].as_f64()).sum();
                gradient[a][i] = T::of(sum);
            }
            if !fields.correction.is_empty() {
                for a in 0..dims {
                    for b in 0..=a {
                        correction[component(a, b)][i] = T::of(inverse[(a, b)]);
                    }
                }
            }
        }
        Ok(())
    }
}

/// Smallest eigenvalue of a symmetric matrix of which only the first `dims` rows and columns count.
fn least_eigenvalue(matrix: &Matrix3<f64>, dims: usize) -> f64 {
    match dims {
        1 => matrix[(0, 0)],
        2 => {
            let (mean, half) =
                (0.5 * (matrix[(0, 0)] + matrix[(1, 1)]), 0.5 * (matrix[(0, 0)] - matrix[(1, 1)]));
            mean - half.hypot(matrix[(0, 1)])
        }
        _ => matrix.symmetric_eigenvalues().min(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_eigenvalue_in_two_dimensions_is_that_of_the_general_case() {
        let plane = Matrix3::new(0.9, 0.2, 0.0, 0.2, 0.5, 0.0, 0.0, 0.0, 7.0);
        assert!((least_eigenvalue(&plane, 2) - plane.symmetric_eigenvalues().min()).abs() < 1e-14);
        assert_eq!(least_eigenvalue(&plane, 1), 0.9);
    }
}
