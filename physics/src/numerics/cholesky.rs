//! Dense Cholesky factorisation in memory that is taken once, to which rows can be added and from which they can be taken.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::{factor, solve, update};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{ColMut, MatMut, MatRef, Par};

/// Factor of a symmetric positive definite matrix of changing size.
pub(crate) struct Cholesky {
    /// Lower triangle, column by column with room for `capacity` rows. Shape (capacity, capacity).
    values: Vec<f64>,
    capacity: usize,
    size: usize,
    /// A column. Shape (capacity).
    column: Vec<f64>,
    scratch: MemBuffer,
}

impl Cholesky {
    /// Room for matrices of at most `capacity` rows.
    pub fn with_capacity(capacity: usize) -> Self {
        let scratch = factor::cholesky_in_place_scratch::<f64>(capacity, Par::Seq, Default::default());
        Self {
            values: vec![0.0; capacity * capacity],
            capacity,
            size: 0,
            column: vec![0.0; capacity],
            scratch: MemBuffer::new(scratch),
        }
    }

    /// Factorises the matrix whose lower triangle is `entry(row, column)`, asked for column by column from the diagonal on; whether it is positive definite.
    pub fn factorise(&mut self, size: usize, mut entry: impl FnMut(usize, usize) -> f64) -> bool {
        self.size = size;
        for column in 0..size {
            for row in column..size {
                self.values[column * self.capacity + row] = entry(row, column);
            }
        }
        let n = self.capacity;
        let matrix =
            MatMut::from_column_major_slice_mut(&mut self.values, n, n).submatrix_mut(0, 0, size, size);
        let stack = MemStack::new(&mut self.scratch);
        factor::cholesky_in_place(matrix, Default::default(), Par::Seq, stack, Default::default()).is_ok()
    }

    /// Adds a last row, `entry(column)`, the diagonal included; whether the matrix stays positive definite.
    pub fn append(&mut self, entry: impl Fn(usize) -> f64) -> bool {
        let (n, size) = (self.capacity, self.size);
        for (column, value) in self.column[..size].iter_mut().enumerate() {
            *value = entry(column);
        }
        let row = MatMut::from_column_major_slice_mut(&mut self.column[..size], size, 1);
        let all = MatRef::from_column_major_slice(&self.values, n, n);
        solve_lower_triangular_in_place(all.submatrix(0, 0, size, size), row, Par::Seq);
        let pivot = entry(size) - self.column[..size].iter().map(|l| l * l).sum::<f64>();
        // not positive, or not a number
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        for column in 0..size {
            self.values[column * n + size] = self.column[column];
        }
        self.values[size * n + size] = pivot.sqrt();
        self.size += 1;
        true
    }

    /// Takes row and column `k` out; whether that succeeds numerically.
    ///
    /// The block behind them then is the factor of itself plus the square of the column that has gone.
    pub fn remove(&mut self, k: usize) -> bool {
        let (n, size) = (self.capacity, self.size);
        let rest = size - k - 1;
        self.column[..rest].copy_from_slice(&self.values[k * n + k + 1..k * n + size]);
        for column in 0..k {
            self.values.copy_within(column * n + k + 1..column * n + size, column * n + k);
        }
        for column in k + 1..size {
            self.values.copy_within(column * n + column..column * n + size, (column - 1) * n + column - 1);
        }
        self.size -= 1;
        if rest == 0 {
            return true;
        }
        let all = MatMut::from_column_major_slice_mut(&mut self.values, n, n);
        let behind = all.submatrix_mut(k, k, rest, rest);
        let gone = MatMut::from_column_major_slice_mut(&mut self.column[..rest], rest, 1);
        let mut one = [1.0];
        update::rank_r_update_clobber(behind, gone, ColMut::from_slice_mut(&mut one).as_diagonal_mut())
            .is_ok()
    }

    /// Solves for `rhs` in place.
    pub fn solve(&mut self, rhs: &mut [f64]) {
        let (n, size) = (self.capacity, self.size);
        let factor = MatRef::from_column_major_slice(&self.values, n, n).submatrix(0, 0, size, size);
        let rhs = MatMut::from_column_major_slice_mut(rhs, size, 1);
        solve::solve_in_place(factor, rhs, Par::Seq, MemStack::new(&mut self.scratch));
    }
}

impl Clone for Cholesky {
    /// Room of the same size, without the factor.
    fn clone(&self) -> Self {
        Self::with_capacity(self.capacity)
    }
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cholesky").field("size", &self.size).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_added_and_taken_give_the_factor_made_anew() {
        let mut random = fastrand::Rng::with_seed(11);
        let n = 30;
        let a: Vec<f64> = (0..n * n).map(|_| random.f64() - 0.5).collect();
        let product = |i: usize, j: usize| (0..n).map(|k| a[i * n + k] * a[j * n + k]).sum::<f64>();
        let entry = |i: usize, j: usize| product(i, j) + if i == j { 0.1 } else { 0.0 };
        let mut set: Vec<usize> = vec![3, 7, 1];
        let mut updated = Cholesky::with_capacity(n);
        assert!(updated.factorise(3, |i, j| entry(set[i], set[j])));
        for _ in 0..200 {
            let out: Vec<usize> = (0..n).filter(|i| !set.contains(i)).collect();
            if set.len() < 2 || (random.bool() && !out.is_empty()) {
                set.push(out[random.usize(..out.len())]);
                let last = set.len() - 1;
                assert!(updated.append(|j| entry(set[last], set[j])));
            } else {
                let k = random.usize(..set.len());
                set.remove(k);
                assert!(updated.remove(k));
            }
            let mut anew = Cholesky::with_capacity(n);
            assert!(anew.factorise(set.len(), |i, j| entry(set[i], set[j])));
            let load: Vec<f64> = (0..set.len()).map(|_| random.f64()).collect();
            let (mut x, mut y) = (load.clone(), load);
            updated.solve(&mut x);
            anew.solve(&mut y);
            assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-9 * (1.0 + y.abs())), "{set:?}");
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_an_error() {
        let mut factor = Cholesky::with_capacity(3);
        assert!(!factor.factorise(2, |i, j| if i == j { 1.0 } else { 2.0 }));
        assert!(factor.factorise(1, |_, _| 1.0));
        assert!(!factor.append(|_| 1.0));
        assert!(factor.append(|j| if j == 0 { 0.5 } else { 1.0 }));
    }
}
