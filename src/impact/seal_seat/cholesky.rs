//! Dense Cholesky factorisation in memory that is taken once.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::{factor, solve};
use faer::{MatMut, MatRef, Par};

/// Factor of a symmetric positive definite matrix of changing size.
pub(super) struct Cholesky {
    /// Lower triangle, column by column. Shape (size, size), the rest of the vector is room.
    values: Vec<f64>,
    size: usize,
    scratch: MemBuffer,
}

impl Cholesky {
    /// Room for matrices of at most `n` rows.
    pub fn with_capacity(n: usize) -> Self {
        let scratch = factor::cholesky_in_place_scratch::<f64>(n, Par::Seq, Default::default());
        Self { values: vec![0.0; n * n], size: 0, scratch: MemBuffer::new(scratch) }
    }

    /// Factorises the matrix whose lower triangle is `entry(row, column)`; whether it is positive definite.
    pub fn factorise(&mut self, size: usize, entry: impl Fn(usize, usize) -> f64) -> bool {
        self.size = size;
        for column in 0..size {
            for row in column..size {
                self.values[column * size + row] = entry(row, column);
            }
        }
        let matrix = MatMut::from_column_major_slice_mut(&mut self.values[..size * size], size, size);
        let stack = MemStack::new(&mut self.scratch);
        factor::cholesky_in_place(matrix, Default::default(), Par::Seq, stack, Default::default()).is_ok()
    }

    /// Solves for `rhs` in place.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        let size = self.size;
        let factor = MatRef::from_column_major_slice(&self.values[..size * size], size, size);
        let rhs = MatMut::from_column_major_slice_mut(rhs, size, 1);
        solve::solve_in_place(factor, rhs, Par::Seq, MemStack::new(&mut self.scratch));
    }
}

impl Clone for Cholesky {
    /// Room of the same size, without the factor.
    fn clone(&self) -> Self {
        Self::with_capacity(self.values.len().isqrt())
    }
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cholesky").field("size", &self.size).finish_non_exhaustive()
    }
}
