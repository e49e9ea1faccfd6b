//! Sparse Cholesky factorisation: the only place that knows `faer`.

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::linalg::cholesky::{
    factorize_symbolic_cholesky, CholeskySymbolicParams, LltRef, SymbolicCholesky,
    SymmetricOrdering,
};
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// A symmetric matrix in compressed columns, both halves present, rows sorted
/// within each column.
#[derive(Clone, Debug)]
pub(super) struct Matrix {
    pub(super) size: usize,
    pub(super) starts: Vec<usize>,
    pub(super) rows: Vec<usize>,
    pub(super) values: Vec<f64>,
}

impl Matrix {
    /// Sums up triplets; both halves must be given.
    pub(super) fn assemble(size: usize, triplets: &[(usize, usize, f64)]) -> Self {
        let mut sum = sprs::TriMat::with_capacity((size, size), triplets.len());
        for &(i, j, v) in triplets {
            sum.add_triplet(i, j, v);
        }
        let (starts, rows, values) = sum.to_csc::<usize>().into_raw_storage();
        Self {
            size,
            starts,
            rows,
            values,
        }
    }

    /// The entries of a column, as (row, value).
    pub(super) fn column(&self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[j]..self.starts[j + 1];
        self.rows[range.clone()]
            .iter()
            .copied()
            .zip(self.values[range].iter().copied())
    }

    /// The product with a vector.
    pub(super) fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.size];
        for (j, &x) in x.iter().enumerate() {
            for (i, v) in self.column(j) {
                y[i] += v * x;
            }
        }
        y
    }

    /// As faer sees it, without a copy.
    fn view(&self) -> SparseColMatRef<'_, usize, f64> {
        SparseColMatRef::new(
            SymbolicSparseColMatRef::new_checked(
                self.size,
                self.size,
                &self.starts,
                None,
                &self.rows,
            ),
            &self.values,
        )
    }
}

/// A Cholesky factor whose symbolic part outlives changes of the values.
///
/// Supernodal always (faer's choice by size would change how a singular
/// matrix is reported), one thread (two make solves slower at our sizes).
pub(super) struct Factor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    memory: MemBuffer,
}

impl Factor {
    /// Analyses the pattern of a matrix. `None` if memory does not suffice.
    pub(super) fn analyse(matrix: &Matrix) -> Option<Self> {
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let symbolic = factorize_symbolic_cholesky(
            matrix.view().symbolic(),
            Side::Lower,
            SymmetricOrdering::Amd,
            params,
        )
        .ok()?;
        let memory = MemBuffer::try_new(StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ]))
        .ok()?;
        Some(Self {
            values: vec![0.0; symbolic.len_val()],
            symbolic,
            memory,
        })
    }

    /// Factors a matrix of the analysed pattern. `false` if it is not
    /// positive definite.
    pub(super) fn refactor(&mut self, matrix: &Matrix) -> bool {
        self.symbolic
            .factorize_numeric_llt(
                &mut self.values,
                matrix.view(),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut self.memory),
                Default::default(),
            )
            .is_ok()
    }

    /// Solves in place with the last factor.
    pub(super) fn solve(&mut self, x: &mut [f64]) {
        let size = x.len();
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(x, size, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }
}

impl std::fmt::Debug for Factor {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Factor")
            .field("values", &self.values.len())
            .finish_non_exhaustive()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn factors_solves_and_refuses() {
        let full = |d: f64| {
            Matrix::assemble(
                2,
                &[
                    (0, 0, d),
                    (1, 1, 2.0),
                    (0, 1, 1.0),
                    (1, 0, 0.5),
                    (1, 0, 0.5),
                ],
            )
        };
        let matrix = full(2.0);
        let mut factor = Factor::analyse(&matrix).unwrap();
        assert!(factor.refactor(&matrix));
        let mut x = vec![4.0, 5.0];
        factor.solve(&mut x);
        assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
        assert_eq!(matrix.times(&[1.0, 2.0]), [4.0, 5.0]);
        assert!(!factor.refactor(&full(0.1)));
    }
}
