//! The candidates that are watched, side by side in memory.

use super::accumulate::{add_modes, deform_under};
use super::nodes::{Ball, Nodes};
use super::traces::Push;
use nalgebra::Vector3;
use std::ops::Range;

/// Slot of a candidate that is not watched, and number of a column that has not been gathered.
const NONE: usize = usize::MAX;

/// Some candidates, each in a slot, and where they are.
#[derive(Debug, Clone)]
pub(super) struct Watch {
    /// Candidates by slot. Shape (w).
    nodes: Vec<usize>,
    /// Slot of each candidate, or [`NONE`]. Shape (n).
    slot: Vec<usize>,
    /// Shape (w).
    ball: Vec<usize>,
    /// Places at rest in m. Shape (3, w).
    place: Vec<f64>,
    /// As in [`Nodes`]. Shape (N, 3, w).
    shapes: Vec<f64>,
    /// Columns of the residual as in [`Nodes::column`], of candidates that have been loaded. Shape (.., 3, 3, w).
    columns: Vec<f32>,
    /// Number of the column of each candidate, or [`NONE`]. Shape (n).
    gathered: Vec<usize>,
    /// From the balls' centres to the candidates without the residual's part in m. Shape (3, w).
    base: Vec<f64>,
    /// Displacements by the residual in m. Shape (3, w).
    deformation: Vec<f64>,
    /// What forces of the past still displace, and the sum of both before the present step, in m. Shape (3, w), of a body that relaxes.
    remembered: Vec<f64>,
    before: Vec<f64>,
    /// Displacements under a unit force, see [`Watch::under`]. Shape (3, w).
    unit: Vec<f64>,
}

impl Watch {
    /// None of `n` candidates.
    pub fn none(n: usize) -> Self {
        Self {
            nodes: Vec::with_capacity(n),
            slot: vec![NONE; n],
            ball: Vec::with_capacity(n),
            place: Vec::with_capacity(3 * n),
            shapes: Vec::new(),
            columns: Vec::new(),
            gathered: vec![NONE; n],
            base: Vec::with_capacity(3 * n),
            deformation: Vec::with_capacity(3 * n),
            remembered: Vec::new(),
            before: Vec::new(),
            unit: Vec::with_capacity(3 * n),
        }
    }

    /// Watches `chosen`, in this order.
    pub fn choose(&mut self, nodes: &Nodes, chosen: &[usize]) {
        let (n, w) = (nodes.len(), chosen.len());
        self.nodes.clear();
        self.nodes.extend_from_slice(chosen);
        self.slot.fill(NONE);
        for (slot, &i) in chosen.iter().enumerate() {
            self.slot[i] = slot;
        }
        self.ball.clear();
        self.ball.extend(chosen.iter().map(|&i| nodes.ball[i]));
        self.place.clear();
        for c in 0..3 {
            self.place.extend(chosen.iter().map(|&i| nodes.place[i][c]));
        }
        self.shapes.clear();
        for component in nodes.shapes.chunks(n.max(1)) {
            self.shapes.extend(chosen.iter().map(|&i| component[i]));
        }
        self.columns.clear();
        self.gathered.fill(NONE);
        self.base.resize(3 * w, 0.0);
        self.deformation.clear();
        self.deformation.resize(3 * w, 0.0);
        self.remembered.clear();
        self.before.clear();
        self.unit.resize(3 * w, 0.0);
    }

    /// Number of candidates watched.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Candidate in a slot.
    pub fn node(&self, slot: usize) -> usize {
        self.nodes[slot]
    }

    /// Whether `candidate` is watched.
    pub fn contains(&self, candidate: usize) -> bool {
        self.slot[candidate] != NONE
    }

    /// Number of the first slots that hold all of `some` candidates.
    pub fn up_to(&self, some: &[usize]) -> usize {
        some.iter().map(|&i| self.slot[i] + 1).max().unwrap_or(0)
    }

    /// Puts the candidates, without the residual's part, where the modal coordinates have them.
    pub fn place(&mut self, modal: &[f64], balls: &[Ball]) {
        let w = self.len();
        for c in 0..3 {
            for k in 0..w {
                self.base[c * w + k] = self.place[c * w + k] - balls[self.ball[k]].centre[c];
            }
        }
        add_modes(&mut self.base, &self.shapes, modal);
    }

    /// Makes sure that the column of the candidate `j` is at hand.
    fn gather(&mut self, nodes: &Nodes, j: usize) {
        let size = 9 * self.len();
        if self.gathered[j] == NONE {
            self.gathered[j] = self.columns.len() / size;
            for component in nodes.column(j).chunks(nodes.len()) {
                self.columns.extend(self.nodes.iter().map(|&i| component[i]));
            }
        }
    }

    /// Lets the residual yield in the slots `part` under forces in N on watched candidates.
    pub fn deform_under(&mut self, nodes: &Nodes, push: &[Push], part: Range<usize>) {
        push.iter().for_each(|(j, _)| self.gather(nodes, *j));
        let (size, columns) = (9 * self.len(), &self.columns);
        let column = |j: usize| &columns[self.gathered[j] * size..][..size];
        deform_under(&mut self.deformation, part, column, push);
    }

    /// Lets the residual yield under `forces` in N of the past.
    pub fn remember(&mut self, nodes: &Nodes, forces: &[Push]) {
        if self.len() == 0 {
            return;
        }
        forces.iter().for_each(|(j, _)| self.gather(nodes, *j));
        let (w, columns) = (self.len(), &self.columns);
        self.remembered.resize(3 * w, 0.0);
        let column = |j: usize| &columns[self.gathered[j] * 9 * w..][..9 * w];
        deform_under(&mut self.remembered, 0..w, column, forces);
    }

    /// Moves the candidates on by what is remembered.
    pub fn displace(&mut self) {
        self.base.iter_mut().zip(&self.remembered).for_each(|(at, moved)| *at += moved);
    }

    /// Keeps what the residual yields by now.
    pub fn keep_deformation(&mut self) {
        self.before.clear();
        self.before.extend(self.deformation.iter().zip(&self.remembered).map(|(now, past)| now + past));
    }

    /// Displacement in m of the watched candidate `i` by the residual since [`Watch::keep_deformation`], all of it if nothing was kept.
    pub fn further_deformation(&self, i: usize) -> Vector3<f64> {
        let (w, slot) = (self.len(), self.slot[i]);
        let at = |entry: usize| {
            self.deformation[entry] + self.remembered[entry] - self.before.get(entry).unwrap_or(&0.0)
        };
        Vector3::from_fn(|c, _| at(c * w + slot))
    }

    /// Keeps the displacements of the slots before `end` under a unit force on `j` along `normal`, for [`Watch::compliance`].
    pub fn under(&mut self, nodes: &Nodes, j: usize, normal: Vector3<f64>, end: usize) {
        self.gather(nodes, j);
        let (w, columns) = (self.len(), &self.columns);
        let column = |j: usize| &columns[self.gathered[j] * 9 * w..][..9 * w];
        deform_under(&mut self.unit, 0..end, column, &[(j, normal)]);
    }

    /// n_i^T R_ij n_j in m/N, the displacement of `i` along its `normal`, after [`Watch::under`] for j.
    pub fn compliance(&self, i: usize, normal: Vector3<f64>) -> f64 {
        let (w, slot) = (self.len(), self.slot[i]);
        normal.dot(&Vector3::from_fn(|c, _| self.unit[c * w + slot]))
    }

    /// Vector in m from the centre of its ball to the watched candidate `i`, and the number of the ball.
    pub fn off_centre(&self, i: usize) -> (Vector3<f64>, usize) {
        let (w, slot) = (self.len(), self.slot[i]);
        let at = |c, _| self.base[c * w + slot] + self.deformation[c * w + slot];
        (Vector3::from_fn(at), self.ball[slot])
    }

    /// Displacement in m of the watched candidate `i` by the residual.
    pub fn deformation(&self, i: usize) -> Vector3<f64> {
        let (w, slot) = (self.len(), self.slot[i]);
        Vector3::from_fn(|c, _| self.deformation[c * w + slot])
    }
}
