//! Nodes that rigid spheres may touch, and how they yield.

/// A rigid sphere that candidates meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Centre in m.
    pub centre: [f64; 3],
    /// Radius in m.
    pub radius: f64,
}

/// The nodes that may be touched.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// Places at rest in m. Shape (n).
    pub(super) place: Vec<[f64; 3]>,
    /// Number of the ball each one meets. Shape (n).
    pub(super) ball: Vec<usize>,
    /// Residual flexibility R_ij in m/N, 3 x 3 blocks row by row. Shape (n, n).
    residual: Vec<[f64; 9]>,
}

impl Nodes {
    /// Candidates at `place`, each against the ball of the number in `ball`, with the `residual` flexibility
    /// (x, y, z of each candidate; shape (3 n, 3 n), row by row) in m/N.
    pub fn new(place: Vec<[f64; 3]>, ball: Vec<usize>, residual: &[f64]) -> Self {
        let n = place.len();
        let entry = |i: usize, j: usize, k: usize| residual[(3 * i + k / 3) * 3 * n + 3 * j + k % 3];
        let residual = (0..n * n).map(|ij| std::array::from_fn(|k| entry(ij / n, ij % n, k))).collect();
        Self { place, ball, residual }
    }

    /// Number of candidates.
    pub fn len(&self) -> usize {
        self.place.len()
    }

    /// Whether there is no candidate.
    pub fn is_empty(&self) -> bool {
        self.place.is_empty()
    }

    /// Flexibility of candidate `i` under forces on all.
    pub(super) fn row(&self, i: usize) -> &[[f64; 9]] {
        &self.residual[i * self.len()..(i + 1) * self.len()]
    }

    /// Displacement in m of candidate `i` under the forces `push` on candidates.
    pub(super) fn displaced(&self, i: usize, push: &[(usize, [f64; 3])]) -> [f64; 3] {
        displaced(self.row(i), push)
    }

    /// Displacement in m of candidate `i` along its normal under a unit force on `j` along its own: n_i^T R_ij n_j.
    pub(super) fn compliance(&self, i: usize, j: usize, normal: &[[f64; 3]]) -> f64 {
        let (r, p, q) = (&self.residual[i * self.len() + j], normal[i], normal[j]);
        p[0] * (r[0] * q[0] + r[1] * q[1] + r[2] * q[2])
            + p[1] * (r[3] * q[0] + r[4] * q[1] + r[5] * q[2])
            + p[2] * (r[6] * q[0] + r[7] * q[1] + r[8] * q[2])
    }
}

/// sum_j R_j f_j in m over the pairs (j, f_j) of `push`.
pub(super) fn displaced(row: &[[f64; 9]], push: &[(usize, [f64; 3])]) -> [f64; 3] {
    let mut u = [0.0; 3];
    for (j, [x, y, z]) in push {
        let r = &row[*j];
        u[0] += r[0] * x + r[1] * y + r[2] * z;
        u[1] += r[3] * x + r[4] * y + r[5] * z;
        u[2] += r[6] * x + r[7] * y + r[8] * z;
    }
    u
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
