//! Sparse Cholesky factorisation: the only place that knows faer.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    factorize_symbolic_cholesky, CholeskySymbolicParams, SymmetricOrdering,
};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use sprs::CsMat;

use crate::FieldError;

/// Solves `matrix * x = rhs` for each of the given columns, in place.
///
/// `matrix` is symmetric positive definite, in compressed columns. The
/// supernodal method is forced: the automatic choice falls back to a slower
/// one on planar meshes. One thread, so that results are the same everywhere.
pub(crate) fn solve(matrix: &CsMat<f64>, columns: &mut [Vec<f64>]) -> Result<(), FieldError> {
    let singular = |why: String| FieldError::SingularSystem { why };
    let count = matrix.rows();
    let pointers = matrix.indptr();
    let symbolic = SymbolicSparseColMatRef::new_checked(
        count,
        count,
        pointers.raw_storage(),
        None,
        matrix.indices(),
    );
    let view = SparseColMatRef::new(symbolic, matrix.data());
    let parameters = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    let symbolic = factorize_symbolic_cholesky(
        view.symbolic(),
        Side::Lower,
        SymmetricOrdering::Amd,
        parameters,
    )
    .map_err(|error| singular(format!("{error:?}")))?;
    let mut values = vec![0.0_f64; symbolic.len_val()];
    let mut memory = MemBuffer::new(StackReq::any_of(&[
        symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
        symbolic.solve_in_place_scratch::<f64>(BLOCK.min(columns.len()), Par::Seq),
    ]));
    let factor = symbolic
        .factorize_numeric_llt(
            &mut values,
            view,
            Side::Lower,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        )
        .map_err(|error| singular(format!("{error:?}")))?;
    for block in columns.chunks_mut(BLOCK) {
        let mut packed = block.concat();
        factor.solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut packed, count, block.len()),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        for (column, solved) in block.iter_mut().zip(packed.chunks_exact(count)) {
            let residual = residual(matrix, solved, column);
            if residual.is_nan() || residual > 1e-7 {
                return Err(singular(format!("relative residual {residual:e}")));
            }
            column.copy_from_slice(solved);
        }
    }
    Ok(())
}

/// Right-hand sides that are solved side by side: a pass through the factor
/// costs memory traffic, which they share.
const BLOCK: usize = 8;

/// Largest entry of `matrix * x - rhs`, over that of `|matrix| |x| + |rhs|`.
fn residual(matrix: &CsMat<f64>, x: &[f64], rhs: &[f64]) -> f64 {
    let mut error: Vec<f64> = rhs.iter().map(|b| -b).collect();
    let mut scale: Vec<f64> = rhs.iter().map(|b| b.abs()).collect();
    for (j, column) in matrix.outer_iterator().enumerate() {
        for (i, &entry) in column.iter() {
            error[i] += entry * x[j];
            scale[i] += (entry * x[j]).abs();
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

    fn matrix(diagonal: f64) -> CsMat<f64> {
        CsMat::new_csc(
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
}
