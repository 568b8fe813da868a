//! Lowest modes of small dense structures.

use crate::error::{Error, Result};
use faer::diag::Diag;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::{Mat, Par, Side};

/// The `count` lowest modes of K x = omega^2 M x.
///
/// `shift` (in rad^2/s^2, of the size of the first elastic eigenvalue) is added for a K that is singular; otherwise
/// it is 0. Returns omega^2, ascending, and the mass-normalised shapes. Shapes (count), (size, count).
///
/// # Errors
/// [`Error::Internal`], naming `what`, if K + shift M is not positive definite or the iteration does not converge.
pub(crate) fn lowest(
    stiffness: &Mat<f64>,
    mass: &Mat<f64>,
    shift: f64,
    count: usize,
    what: &str,
) -> Result<(Vec<f64>, Mat<f64>)> {
    let failed = |step: &str| Error::Internal(format!("{what}: {step} failed"));
    let shifted = stiffness + faer::Scale(shift) * mass;
    let factor = shifted.llt(Side::Lower).map_err(|_| failed("Cholesky factorisation"))?;
    let lower = factor.L();
    // mu = 1/(omega^2 + shift) are the eigenvalues of L^-1 M L^-T: the lowest modes come out sharpest
    let mut half = mass.clone();
    solve_lower_triangular_in_place(lower, half.as_mut(), Par::Seq);
    let mut both = half.transpose().to_owned();
    solve_lower_triangular_in_place(lower, both.as_mut(), Par::Seq);
    let (values, vectors) = symmetric(&both).ok_or_else(|| failed("eigenvalue iteration"))?;
    let size = both.nrows();
    let mu = |mode: usize| values[size - 1 - mode];
    // x = L^-T y has x^T M x = mu
    let mut shapes = Mat::from_fn(size, count, |i, mode| vectors[(i, size - 1 - mode)] / mu(mode).sqrt());
    solve_upper_triangular_in_place(lower.transpose(), shapes.as_mut(), Par::Seq);
    Ok(((0..count).map(|mode| 1.0 / mu(mode) - shift).collect(), shapes))
}

/// Eigenvalues, ascending, and eigenvectors (columns) of a symmetric matrix; `None` if the iteration does not converge.
///
/// On one thread: those that faer would take for a matrix of some hundred rows wait for one another in a loop, which on a
/// machine with other work costs a hundred times what they save.
pub(crate) fn symmetric(matrix: &Mat<f64>) -> Option<(Vec<f64>, Mat<f64>)> {
    let size = matrix.nrows();
    let (mut values, mut vectors) = (Diag::<f64>::zeros(size), Mat::zeros(size, size));
    let scratch =
        self_adjoint_evd_scratch::<f64>(size, ComputeEigenvectors::Yes, Par::Seq, Default::default());
    self_adjoint_evd(
        matrix.as_ref(),
        values.as_mut(),
        Some(vectors.as_mut()),
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    )
    .ok()?;
    Some((values.column_vector().iter().copied().collect(), vectors))
}
