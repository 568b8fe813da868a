//! Lowest elastic modes by shift-invert Lanczos with full reorthogonalisation.
//!
//! Works on x -> K^-1 M x in the inner product of M, with the stiffness factorised once; a free body's
//! rigid motion is projected out of every vector (see [`ShiftInvert::solve`]). faer's own
//! `partial_self_adjoint_eigen` is bound to the Euclidean product, which would need half solves with
//! the sparse factor, and to a number of modes that is known beforehand.

use crate::error::{Error, Result};
use crate::numerics::eigenmodes::symmetric;
use crate::numerics::vectors::{axpy, dot};
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, MatMut, MatRef, Par};

/// An elastic body with factorised stiffness K and mass M over n degrees of freedom.
pub(in crate::body) trait ShiftInvert {
    /// Number of degrees of freedom n.
    fn size(&self) -> usize;
    /// Number of elastic modes.
    fn elastic_size(&self) -> usize {
        self.size()
    }
    /// M x.
    fn mass_times(&self, x: &[f64]) -> Vec<f64>;
    /// Static displacement under the load `f`, in place; of a free body by inertia relief.
    fn solve(&self, f: &mut [f64]);
    /// Makes `x` M-orthogonal to the rigid motions, in place.
    fn remove_rigid(&self, _x: &mut [f64]) {}
}

/// Modes of an elastic body, ascending.
#[derive(Debug, Clone, Default)]
pub(in crate::body) struct Modes {
    /// Eigenfrequencies in rad/s, ascending. Shape (k).
    pub omega: Vec<f64>,
    /// Shapes with v^T M v = 1. Shape (k, n).
    pub shape: Vec<Vec<f64>>,
}

/// Bound on the residual of K^-1 M v = theta v relative to theta; the error of the frequency is its square.
const RESIDUAL: f64 = 1e-6;

/// The lowest elastic modes: as many as `requested`, or fewer if one beyond `omega_limit` is found.
///
/// The last mode returned is then the first beyond the limit.
///
/// # Errors
/// [`Error::Solver`] if the mesh has not enough modes or the iteration does not converge.
pub(in crate::body) fn lowest_modes(
    body: &impl ShiftInvert,
    requested: usize,
    omega_limit: f64,
) -> Result<Modes> {
    if requested == 0 {
        return Ok(Modes::default());
    }
    if 2 * requested > body.elastic_size() {
        return Err(Error::Solver(format!(
            "{requested} modes are requested of a continuum mesh with {} degrees of freedom; it has at most half as many",
            body.elastic_size()
        )));
    }
    let mut random = SplitMix(0x9e37_79b9_7f4a_7c15);
    let mut basis = ColumnVectors::new(body.size()); // M-orthonormal
    let (mut alpha, mut beta): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut next = random.vector(body.size());
    body.remove_rigid(&mut next);
    let mut next_mass = body.mass_times(&next);
    let mut previous = Vec::new();
    // with a limit a few modes may be enough
    let mut next_check = if omega_limit.is_finite() { requested.min(8) } else { requested };
    let longest = body.elastic_size().min(4 * requested + 200);
    loop {
        let norm = dot(&next, &next_mass).sqrt();
        scale(1.0 / norm, &mut next);
        scale(1.0 / norm, &mut next_mass);
        basis.push(&next);
        let mut w = next_mass.clone();
        body.solve(&mut w);
        // First the three-term recurrence, which takes nearly all; then the whole basis.
        alpha.push(dot(&next_mass, &w));
        axpy(-alpha[alpha.len() - 1], &next, &mut w);
        if let Some(beta) = beta.last() {
            axpy(-beta, &previous, &mut w);
        }
        previous = next;
        let mut w_mass = body.mass_times(&w);
        orthogonalise(body, &mut w, &mut w_mass, &basis);
        let steps = basis.len();
        let residual = dot(&w, &w_mass).max(0.0).sqrt();
        if steps >= next_check || steps == longest {
            let (theta, vectors) = tridiagonal_eigen(&alpha, &beta)?;
            let converged = theta
                .iter()
                .enumerate()
                .take_while(|(k, t)| residual * vectors[(steps - 1, steps - 1 - k)].abs() <= RESIDUAL * **t)
                .count();
            let beyond = theta[..converged].iter().position(|t| 1.0 / t.sqrt() > omega_limit);
            if converged >= requested || beyond.is_some() {
                let count = beyond.map_or(requested, |k| (k + 1).min(requested));
                return Ok(ritz(&basis, &theta[..count], &vectors));
            }
            next_check = steps + (steps / 8).max(4);
        }
        if steps == longest {
            return Err(Error::Solver(format!(
                "the {requested} lowest modes of the continuum mesh did not converge in {steps} Lanczos steps"
            )));
        }
        if residual > f64::EPSILON * alpha[0].abs() {
            (next, next_mass) = (w, w_mass);
            beta.push(residual);
        } else {
            // An invariant subspace: go on in its complement.
            next = random.vector(body.size());
            body.remove_rigid(&mut next);
            next_mass = body.mass_times(&next);
            orthogonalise(body, &mut next, &mut next_mass, &basis);
            beta.push(0.0);
        }
    }
}

/// Vectors of equal length, side by side in memory.
struct ColumnVectors {
    length: usize,
    values: Vec<f64>,
}

impl ColumnVectors {
    fn new(length: usize) -> Self {
        Self { length, values: Vec::new() }
    }

    fn push(&mut self, column: &[f64]) {
        self.values.extend(column);
    }

    fn len(&self) -> usize {
        self.values.len() / self.length
    }

    fn matrix(&self) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice(&self.values, self.length, self.len())
    }
}

/// Makes `w` M-orthogonal to the basis, and `w_mass` = M w with it.
///
/// Once more if much of `w` was lost: twice is enough (Parlett, The Symmetric Eigenvalue Problem, 6.9).
fn orthogonalise(body: &impl ShiftInvert, w: &mut [f64], w_mass: &mut Vec<f64>, basis: &ColumnVectors) {
    let n = w.len();
    for _ in 0..2 {
        let before = dot(w, w_mass);
        let mut part = Mat::zeros(basis.len(), 1);
        let mass = MatRef::from_column_major_slice(w_mass, n, 1);
        matmul(part.as_mut(), Accum::Replace, basis.matrix().transpose(), mass, 1.0, Par::Seq);
        let vector = MatMut::from_column_major_slice_mut(w, n, 1);
        matmul(vector, Accum::Add, basis.matrix(), &part, -1.0, Par::Seq);
        *w_mass = body.mass_times(w);
        if dot(w, w_mass) > 0.5 * before {
            break;
        }
    }
}

/// Eigenvalues (descending) and eigenvectors (columns, ascending) of the symmetric tridiagonal matrix.
fn tridiagonal_eigen(alpha: &[f64], beta: &[f64]) -> Result<(Vec<f64>, Mat<f64>)> {
    let n = alpha.len();
    let matrix = Mat::from_fn(n, n, |i, j| match i.abs_diff(j) {
        0 => alpha[i],
        1 => beta[i.min(j)],
        _ => 0.0,
    });
    let (mut theta, vectors) = symmetric(&matrix)
        .ok_or_else(|| Error::Solver("the modes of the continuum mesh did not converge".into()))?;
    theta.reverse();
    Ok((theta, vectors))
}

fn ritz(basis: &ColumnVectors, theta: &[f64], vectors: &Mat<f64>) -> Modes {
    let steps = basis.len();
    let chosen = Mat::from_fn(steps, theta.len(), |i, k| vectors[(i, steps - 1 - k)]);
    let shapes = basis.matrix() * chosen;
    Modes {
        omega: theta.iter().map(|t| 1.0 / t.sqrt()).collect(),
        shape: shapes.col_iter().map(|shape| shape.iter().copied().collect()).collect(),
    }
}

fn scale(factor: f64, x: &mut [f64]) {
    x.iter_mut().for_each(|x| *x *= factor);
}

/// Steele, Lea, Flood 2014: a start vector must be generic, not random; the same on every run.
struct SplitMix(u64);

impl SplitMix {
    fn vector(&mut self, n: usize) -> Vec<f64> {
        (0..n)
            .map(|_| {
                self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
                let mut z = self.0;
                z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
                z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
                (z ^ (z >> 31)) as f64 / u64::MAX as f64 - 0.5
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::assembly::Matrices;
    use super::super::mesh;
    use super::super::mirror::{HalfBody, Parity};
    use super::*;
    use crate::scene::Material;
    use approx::assert_relative_eq;
    use faer::Side;
    use std::rc::Rc;

    /// All elastic eigenfrequencies of a small body from dense matrices: M = C C^T, C^T K^-1 C.
    fn dense(body: &HalfBody) -> Vec<f64> {
        let n = body.size();
        let unit = |j: usize| (0..n).map(|i| f64::from(u8::from(i == j))).collect::<Vec<f64>>();
        let (mut mass, mut flexibility) = (Mat::zeros(n, n), Mat::zeros(n, n));
        for j in 0..n {
            let mut u = unit(j);
            for (i, m) in body.mass_times(&u).into_iter().enumerate() {
                mass[(i, j)] = m;
            }
            body.solve(&mut u);
            u.into_iter().enumerate().for_each(|(i, u)| flexibility[(i, j)] = u);
        }
        let c = mass.llt(Side::Lower).unwrap().L().to_owned();
        let theta = (c.transpose() * flexibility * &c).self_adjoint_eigenvalues(Side::Lower).unwrap();
        theta.iter().rev().map(|t| 1.0 / t.sqrt()).collect()
    }

    #[test]
    fn no_mode_is_missed_or_found_twice_against_a_dense_solution() {
        let material = Material::elastic("m", 1.0, 0.3, 1.0);
        let plate = mesh::plate(2, &[0.0, 0.2, 0.5, 1.0], &[0.0, 0.1, 0.25]);
        let matrices = Rc::new(Matrices::new(&plate, &material).unwrap());
        for (parity, free) in
            [(Parity::Bending, true), (Parity::Bending, false), (Parity::Longitudinal, false)]
        {
            let fixed = |[r, _]: [f64; 2]| [!free && r == 1.0; 2];
            let body = HalfBody::new(&plate, &matrices, parity, fixed, free).unwrap();
            let modes = lowest_modes(&body, 15, f64::INFINITY).unwrap();
            for (found, expected) in modes.omega.iter().zip(dense(&body)) {
                assert_relative_eq!(*found, expected, max_relative = 1e-9);
            }
            for (i, v) in modes.shape.iter().enumerate() {
                let momentum = body.mass_times(v);
                for (j, w) in modes.shape.iter().enumerate() {
                    let expected = f64::from(u8::from(i == j));
                    assert!((dot(w, &momentum) - expected).abs() < 1e-9);
                }
            }
            let limit = 0.5 * (modes.omega[4] + modes.omega[5]);
            assert_eq!(lowest_modes(&body, 15, limit).unwrap().omega.len(), 6);
            assert!(lowest_modes(&body, body.size(), f64::INFINITY).is_err());
        }
    }
}
