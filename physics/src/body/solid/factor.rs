//! Sparse Cholesky factorisation in which chosen unknowns, the interface, are eliminated last.
//!
//! The factor's last block then is the Cholesky factor of the interface's Schur complement, whose inverse is the static
//! flexibility of the interface: it costs no solution with the whole factor.

use crate::error::{Error, Result};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::inverse::{inverse, inverse_scratch};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky, supernodal::SupernodalLltRef,
};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use faer::{Conj, Mat, MatMut, Par, Side};

/// Cholesky factor of a sparse symmetric positive definite matrix.
pub(super) struct Factor {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    /// Number of unknowns eliminated last.
    interface: usize,
}

impl Factor {
    /// Factorises the matrix with the given lower triangle; the unknowns in `interface` come last, in this order.
    ///
    /// # Errors
    /// [`Error::Solver`] if the matrix is not positive definite.
    pub fn new(lower: &SparseColMat<usize, f64>, interface: &[usize]) -> Result<Self> {
        let n = lower.ncols();
        let defect =
            |e: faer::sparse::FaerError| Error::Internal(format!("ordering the solid's stiffness: {e:?}"));
        let forward = ordering(lower, interface).map_err(defect)?;
        let mut inverse = vec![0; n];
        forward.iter().enumerate().for_each(|(new, &old)| inverse[old] = new);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let order = SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, n));
        let symbolic =
            factorize_symbolic_cholesky(lower.symbolic(), Side::Lower, order, params).map_err(defect)?;
        let mut values = vec![0.0; symbolic.len_val()];
        let mut memory =
            MemBuffer::new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()));
        symbolic
            .factorize_numeric_llt(
                &mut values,
                lower.as_ref(),
                Side::Lower,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(|e| {
                Error::Solver(format!(
                    "the stiffness of the solid ({n} degrees of freedom) is not positive definite ({e:?}): it is not held, or too nearly incompressible for double precision"
                ))
            })?;
        Ok(Self { symbolic, values, interface: interface.len() })
    }

    /// Solves for `rhs` in place.
    pub fn solve(&self, rhs: &mut [f64]) {
        let n = rhs.len();
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, 1),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    /// The interface's rows and columns of the inverse, in the interface's order: its lower triangle. Shape (interface, interface).
    pub fn interface_flexibility(&self) -> Mat<f64> {
        let m = self.interface;
        let mut flexibility = Mat::zeros(m, m);
        let mut memory = MemBuffer::new(inverse_scratch::<f64>(m, Par::Seq));
        inverse(flexibility.as_mut(), self.last_block().as_ref(), Par::Seq, MemStack::new(&mut memory));
        flexibility
    }

    /// Lower triangle of the factor's last block.
    fn last_block(&self) -> Mat<f64> {
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else {
            unreachable!("the supernodal method is forced");
        };
        let first = symbolic.nrows() - self.interface;
        let mut block = Mat::zeros(self.interface, self.interface);
        let factor = SupernodalLltRef::new(symbolic, &self.values);
        for (s, &end) in symbolic.supernode_end().iter().enumerate() {
            if end <= first {
                continue;
            }
            let node = factor.supernode(s);
            let (start, values) = (node.start(), node.val());
            let width = values.ncols();
            for j in first.saturating_sub(start)..width {
                for i in j..width {
                    block[(start + i - first, start + j - first)] = values[(i, j)];
                }
                for (k, &row) in node.pattern().iter().enumerate() {
                    block[(row - first, start + j - first)] = values[(width + k, j)];
                }
            }
        }
        block
    }
}

/// Order of elimination: the rest by approximate minimum degree, then the interface.
fn ordering(
    lower: &SparseColMat<usize, f64>,
    interface: &[usize],
) -> std::result::Result<Vec<usize>, faer::sparse::FaerError> {
    let n = lower.ncols();
    let mut number = vec![0; n];
    interface.iter().for_each(|&i| number[i] = usize::MAX);
    let rest: Vec<usize> = (0..n).filter(|&i| number[i] == 0).collect();
    rest.iter().enumerate().for_each(|(new, &old)| number[old] = new);
    // upper triangle of the rest, by columns: a row of the lower one is a column of the upper
    let mut columns = vec![Vec::new(); rest.len()];
    for j in rest.iter().copied() {
        for i in lower.symbolic().row_idx_of_col(j).filter(|&i| number[i] != usize::MAX) {
            columns[number[i]].push(number[j]);
        }
    }
    let mut start = vec![0];
    start.extend(columns.iter().scan(0, |end, column| {
        *end += column.len();
        Some(*end)
    }));
    let upper = SymbolicSparseColMat::new_checked(rest.len(), rest.len(), start, None, columns.concat());
    let (mut forward, mut inverse) = (vec![0; rest.len()], vec![0; rest.len()]);
    let entries = upper.compute_nnz();
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(rest.len(), entries));
    let stack = MemStack::new(&mut memory);
    amd::order(&mut forward, &mut inverse, upper.as_ref(), amd::Control::default(), stack)?;
    Ok(forward.into_iter().map(|i| rest[i]).chain(interface.iter().copied()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::sparse::Triplet;

    /// Lower triangle of the Laplacian of a grid of n x n points plus 0.1 at each.
    fn laplacian(n: usize) -> SparseColMat<usize, f64> {
        let mut entries = Vec::new();
        for i in 0..n * n {
            entries.push(Triplet::new(i, i, 4.1));
            if i % n + 1 < n {
                entries.push(Triplet::new(i + 1, i, -1.0));
            }
            if i + n < n * n {
                entries.push(Triplet::new(i + n, i, -1.0));
            }
        }
        SparseColMat::try_new_from_triplets(n * n, n * n, &entries).expect("matrix")
    }

    #[test]
    fn the_interface_s_flexibility_is_that_of_solutions_with_unit_loads() {
        let n = 17;
        let matrix = laplacian(n);
        // in no order, neighbours and nodes far apart
        let interface = [200, 3, 4, 21, 288, 0, 150];
        let factor = Factor::new(&matrix, &interface).expect("positive definite");
        let flexibility = factor.interface_flexibility();
        for (column, &loaded) in interface.iter().enumerate() {
            let mut u = vec![0.0; n * n];
            u[loaded] = 1.0;
            factor.solve(&mut u);
            // the solution is one: A u = e
            let mut residual = vec![0.0; n * n];
            residual[loaded] = -1.0;
            for t in matrix.triplet_iter() {
                residual[t.row] += t.val * u[t.col];
                if t.row != t.col {
                    residual[t.col] += t.val * u[t.row];
                }
            }
            assert!(residual.iter().all(|r| r.abs() < 1e-14));
            for (row, &seen) in interface.iter().enumerate().skip(column) {
                assert!((flexibility[(row, column)] - u[seen]).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_refused() {
        let entries = [Triplet::new(0, 0, 1.0), Triplet::new(1, 0, 2.0), Triplet::new(1, 1, 1.0)];
        let matrix = SparseColMat::try_new_from_triplets(2, 2, &entries).expect("matrix");
        let Err(error) = Factor::new(&matrix, &[1]) else { panic!("factorised") };
        assert!(error.to_string().contains("not positive definite"));
    }
}
