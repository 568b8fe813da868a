//! Nodes that rigid spheres may touch, and how they yield.

use nalgebra::Vector3;

/// A rigid sphere that candidates meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// Centre in m.
    pub centre: Vector3<f64>,
    /// Radius in m.
    pub radius: f64,
    /// Turn about y since the start in rad.
    pub turn: f64,
}

/// The nodes that may be touched: an elastic body as seen from them.
#[derive(Debug, Clone)]
pub struct Nodes {
    /// Places at rest in m. Shape (n).
    pub(super) place: Vec<Vector3<f64>>,
    /// Number of the ball each one meets. Shape (n).
    pub(super) ball: Vec<usize>,
    /// Mass-normalised shapes in kg^(-1/2). Shape (N, 3, n).
    pub(super) shapes: Vec<f64>,
    /// Residual flexibility in m/N, as columns. Shape (n of the force, 3, 3 of the displacement, n).
    columns: Vec<f32>,
}

impl Nodes {
    /// Candidates at `place`, each against the ball of the number in `ball`, with the `shapes` of the modes (x, y, z of each
    /// candidate; shape (N, 3 n)) in kg^(-1/2) and the symmetric `residual` flexibility (shape (3 n, 3 n), row by row) in m/N.
    pub fn new(place: Vec<Vector3<f64>>, ball: Vec<usize>, shapes: &[Vec<f64>], residual: &[f64]) -> Self {
        let n = place.len();
        // from x, y, z of each node to x of all nodes, then y, then z
        let apart = |row: &[f64]| (0..3 * n).map(|k| row[3 * (k % n) + k / n]).collect::<Vec<f64>>();
        Self {
            place,
            ball,
            shapes: shapes.iter().flat_map(|shape| apart(shape)).collect(),
            columns: residual.chunks(3 * n.max(1)).flat_map(apart).map(|r| r as f32).collect(),
        }
    }

    /// The same, yielding `growth` times as much.
    #[must_use]
    pub(super) fn softer(&self, growth: f64) -> Self {
        let columns = self.columns.iter().map(|r| (growth * f64::from(*r)) as f32).collect();
        Self { columns, ..self.clone() }
    }

    /// Number of candidates.
    pub fn len(&self) -> usize {
        self.place.len()
    }

    /// Whether there is no candidate.
    pub fn is_empty(&self) -> bool {
        self.place.is_empty()
    }

    /// Displacements in m/N of all candidates under unit forces on `j`. Shape (3 of the force, 3, n).
    pub(super) fn column(&self, j: usize) -> &[f32] {
        let size = 9 * self.len();
        &self.columns[j * size..][..size]
    }
}
