//! Vectors as slices.

use faer::MatRef;

/// Scalar product.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len();
    let (a, b) = (MatRef::from_column_major_slice(a, n, 1), MatRef::from_column_major_slice(b, n, 1));
    a.col(0).transpose() * b.col(0)
}

/// y += factor x.
pub(crate) fn axpy(factor: f64, x: &[f64], y: &mut [f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}
