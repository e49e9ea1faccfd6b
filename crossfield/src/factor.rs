//! Sparse Cholesky factorisation: the only place that knows faer.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    factorize_symbolic_cholesky, CholeskySymbolicParams, LltRef, SymbolicCholesky,
    SymmetricOrdering,
};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use sprs::{CsMatI, SpIndex};

use crate::FieldError;

/// Solves `matrix * x = rhs` for each of the given columns, in place: a
/// [`Factor`] for one use.
pub(crate) fn solve<I: SpIndex + faer::Index>(
    matrix: &CsMatI<f64, I>,
    columns: &mut [Vec<f64>],
) -> Result<(), FieldError> {
    Factor::new(matrix)?.solve(columns)
}

/// The Cholesky factor of a symmetric positive definite matrix in compressed
/// columns, of which the upper triangle alone is read, and need be there.
///
/// The supernodal method is forced: the automatic choice falls back to a
/// slower one on planar meshes. One thread, so that results are the same
/// everywhere (and two are slower).
#[derive(Debug)]
pub(crate) struct Factor<'a, I: SpIndex + faer::Index> {
    matrix: &'a CsMatI<f64, I>,
    symbolic: SymbolicCholesky<I>,
    values: Vec<f64>,
}

impl<'a, I: SpIndex + faer::Index> Factor<'a, I> {
    pub(crate) fn new(matrix: &'a CsMatI<f64, I>) -> Result<Self, FieldError> {
        let count = matrix.rows();
        let pointers = matrix.indptr();
        let pattern = SymbolicSparseColMatRef::new_checked(
            count,
            count,
            pointers.raw_storage(),
            None,
            matrix.indices(),
        );
        let parameters = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(pattern, Side::Upper, SymmetricOrdering::Amd, parameters)
                .map_err(|error| singular(format!("{error:?}")))?;
        let mut values = vec![0.0_f64; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(pattern, matrix.data()),
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut MemBuffer::new(scratch)),
                Default::default(),
            )
            .map_err(|error| singular(format!("{error:?}")))?;
        Ok(Self {
            matrix,
            symbolic,
            values,
        })
    }

    /// Solves for all columns, in place.
    pub(crate) fn solve(&self, columns: &mut [Vec<f64>]) -> Result<(), FieldError> {
        let count = self.matrix.rows();
        let widest = BLOCK.min(columns.len());
        let scratch = self
            .symbolic
            .solve_in_place_scratch::<f64>(widest, Par::Seq);
        let mut memory = MemBuffer::new(scratch);
        let factor = LltRef::new(&self.symbolic, &self.values);
        for block in columns.chunks_mut(BLOCK) {
            let mut packed = block.concat();
            factor.solve_in_place_with_conj(
                Conj::No,
                MatMut::from_column_major_slice_mut(&mut packed, count, block.len()),
                Par::Seq,
                MemStack::new(&mut memory),
            );
            for (column, solved) in block.iter_mut().zip(packed.chunks_exact(count)) {
                let residual = residual(self.matrix, solved, column);
                if residual.is_nan() || residual > 1e-7 {
                    return Err(singular(format!("relative residual {residual:e}")));
                }
                column.copy_from_slice(solved);
            }
        }
        Ok(())
    }
}

/// Right-hand sides that are solved side by side: a pass through the factor
/// costs memory traffic, which they share.
const BLOCK: usize = 8;

fn singular(why: String) -> FieldError {
    FieldError::SingularSystem { why }
}

/// Largest entry of `matrix * x - rhs`, over that of `|matrix| |x| + |rhs|`,
/// from the upper triangle.
fn residual<I: SpIndex>(matrix: &CsMatI<f64, I>, x: &[f64], rhs: &[f64]) -> f64 {
    let mut error: Vec<f64> = rhs.iter().map(|b| -b).collect();
    let mut scale: Vec<f64> = rhs.iter().map(|b| b.abs()).collect();
    for (j, column) in matrix.outer_iterator().enumerate() {
        for (i, &entry) in column.iter().filter(|&(i, _)| i <= j) {
            error[i] += entry * x[j];
            scale[i] += (entry * x[j]).abs();
            if i < j {
                error[j] += entry * x[i];
                scale[j] += (entry * x[i]).abs();
            }
        }
    }
    let largest = |all: &[f64]| {
        all.iter().fold(
            0.0,
            |m: f64, v| if v.is_nan() { f64::NAN } else { m.max(v.abs()) },
        )
    };
    let scale = largest(&scale);
    if scale > 0.0 {
        largest(&error) / scale
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(diagonal: f64) -> CsMatI<f64, u32> {
        CsMatI::new_csc(
            (2, 2),
            vec![0, 2, 4],
            vec![0, 1, 0, 1],
            vec![diagonal, 1.0, 1.0, diagonal],
        )
    }

    #[test]
    fn solves_and_refuses() {
        let mut columns = [vec![5.0, 4.0], vec![0.0, 0.0]];
        solve(&matrix(2.0), &mut columns).expect("definite");
        assert!((columns[0][0] - 2.0).abs() < 1e-12 && (columns[0][1] - 1.0).abs() < 1e-12);
        assert_eq!(columns[1], [0.0, 0.0]);
        assert!(matches!(
            solve(&matrix(0.5), &mut columns),
            Err(FieldError::SingularSystem { .. })
        ));
        assert!(solve(&matrix(f64::NAN), &mut columns).is_err());
    }

    #[test]
    fn columns_in_blocks_are_as_columns_alone() {
        let matrix = matrix(2.0);
        let all: Vec<Vec<f64>> = (0..19).map(|k| vec![f64::from(k), 3.0]).collect();
        let mut together = all.clone();
        solve(&matrix, &mut together).expect("definite");
        for (k, rhs) in all.into_iter().enumerate() {
            let mut alone = [rhs];
            solve(&matrix, &mut alone).expect("definite");
            for (a, b) in alone[0].iter().zip(&together[k]) {
                assert!((a - b).abs() < 1e-14 * 19.0);
            }
        }
        solve(&matrix, &mut []).expect("nothing to do");
    }
}
