//! The linear system of a step, and its sparse factor.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::cholesky::{
    LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::lu::{LuRef, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::{Conj, MatMut, Par, Side};
use finegrain_framework::Fault;

use super::operator::Operator;
use crate::error::FdError;

/// `W (1 - c L) x = r`, solved by one thread, so that the bits do not depend on how many there are.
///
/// Where numbers are not zero does not depend on `c`: what follows from that is found out once, and numbers are
/// factorised whenever `c` changes.
pub struct System {
    operator: Operator,
    /// The `c` of the present factor.
    coefficient: Option<f64>,
    factor: Factor,
    scratch: MemBuffer,
}

enum Factor {
    Cholesky {
        symbolic: SymbolicCholesky<usize>,
        values: Vec<f64>,
    },
    /// Of what is not symmetric: exchange with what is beyond by ghost points, in orders above 2.
    Lu {
        symbolic: SymbolicLu<usize>,
        numeric: Box<NumericLu<usize, f64>>,
    },
}

impl System {
    /// Finds out about the factor; there are no numbers yet.
    pub fn new(operator: Operator) -> Result<Self, FdError> {
        let refused = |cause: String| FdError::Factor { points: operator.points(), cause };
        let matrix = operator.system(1.0);
        let (factor, scratch) = if operator.is_symmetric() {
            let symbolic = factorize_symbolic_cholesky(
                matrix.symbolic(),
                Side::Lower,
                SymmetricOrdering::Amd,
                Default::default(),
            )
            .map_err(|why| refused(why.to_string()))?;
            let scratch = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
            let mut values = Vec::new();
            values.try_reserve_exact(symbolic.len_val()).map_err(|why| refused(why.to_string()))?;
            values.resize(symbolic.len_val(), 0.0);
            (Factor::Cholesky { symbolic, values }, scratch)
        } else {
            let symbolic = factorize_symbolic_lu(matrix.symbolic(), Default::default())
                .map_err(|why| refused(why.to_string()))?;
            let scratch = symbolic.solve_in_place_scratch::<f64>(1, Par::Seq);
            (Factor::Lu { symbolic, numeric: Box::default() }, scratch)
        };
        Ok(Self { operator, coefficient: None, factor, scratch: MemBuffer::new(scratch) })
    }

    /// Makes the factor that of `c`, if it is not.
    pub fn prepare(&mut self, c: f64) -> Result<(), Fault> {
        if self.coefficient == Some(c) {
            return Ok(());
        }
        let matrix = self.operator.system(c);
        let failed =
            |why: String| Fault::new(format!("the matrix of the step has no factor: {why}"));
        match &mut self.factor {
            Factor::Cholesky { symbolic, values } => {
                let scratch =
                    symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
                symbolic
                    .factorize_numeric_llt(
                        values,
                        matrix.as_ref(),
                        Side::Lower,
                        Default::default(),
                        Par::Seq,
                        MemStack::new(&mut MemBuffer::new(scratch)),
                        Default::default(),
                    )
                    .map_err(|why| failed(why.to_string()))?;
            }
            Factor::Lu { symbolic, numeric } => {
                let scratch =
                    symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default());
                symbolic
                    .factorize_numeric_lu(
                        numeric,
                        matrix.as_ref(),
                        Par::Seq,
                        MemStack::new(&mut MemBuffer::new(scratch)),
                        Default::default(),
                    )
                    .map_err(|why| failed(why.to_string()))?;
            }
        }
        self.coefficient = Some(c);
        Ok(())
    }

    /// Puts the solution in the place of the right-hand side; [`System::prepare`] comes first.
    pub fn solve(&mut self, values: &mut [f64]) {
        let points = values.len();
        let right = MatMut::from_column_major_slice_mut(values, points, 1);
        let stack = MemStack::new(&mut self.scratch);
        match &self.factor {
            Factor::Cholesky { symbolic, values } => {
                LltRef::new(symbolic, values).solve_in_place_with_conj(
                    Conj::No,
                    right,
                    Par::Seq,
                    stack,
                );
            }
            Factor::Lu { symbolic, numeric } => {
                LuRef::new_unchecked(symbolic, numeric).solve_in_place_with_conj(
                    Conj::No,
                    right,
                    Par::Seq,
                    stack,
                );
            }
        }
    }
}
