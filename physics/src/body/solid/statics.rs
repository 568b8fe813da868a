//! The discrete body, factorised: static solutions, rigid motions of a free one, and Ritz modes that begin with static solutions.

use super::elasticity::{FIXED, SolidMatrices};
use super::factor::Factor;
use super::materials::CellMaterials;
use super::mesh::TetMesh;
use super::pressure::HertzLoad;
use crate::body::continuum::lanczos::ShiftInvert;
use crate::error::{Error, Result};
use crate::numerics::eigenmodes::symmetric;
use crate::numerics::vectors::{axpy, dot};
use faer::Mat;
use faer::sparse::SparseColMat;
use nalgebra::Vector3;

/// Blocks of Ritz vectors, and how many of the highest are left to the static flexibility.
const BLOCKS: usize = 14;
const DROPPED: usize = 2;
/// Share of a vector's norm below which it is a combination of those before.
pub(super) const DEPENDENT: f64 = 1e-9;
/// Least eigenvalue over the largest of the products of independent rigid motions on what is held.
const INDEPENDENT: f64 = 1e-8;

/// The discrete body, its first material of Young's modulus 1 Pa and density 1 kg/m^3, factorised.
pub(super) struct Statics {
    matrices: SolidMatrices,
    stiffness: SparseColMat<usize, f64>,
    mass: Vec<f64>,
    /// Numbers of the displacements of each node, or [`FIXED`]. Shape (nodes, 3).
    pub(super) dof: Vec<[usize; 3]>,
    pub(super) size: usize,
    factor: Factor,
    /// Rigid motions of a free body, mass-normalised and mass-orthogonal; none of one that is held. Shape (6, size).
    pub(super) rigid: Vec<Vec<f64>>,
    /// Displacements that stand still in the static solutions of a free body.
    propped: Vec<usize>,
}

impl Statics {
    /// Of `mesh` of `materials`, relative ones.
    pub(super) fn new(mesh: &TetMesh, materials: &CellMaterials, fixed: &[bool]) -> Result<Self> {
        let matrices = SolidMatrices::new(mesh, materials);
        let mass = matrices.consistent_mass(mesh, materials);
        let mut size = 0;
        let number = |fixed: &bool| {
            [0; 3].map(|_| {
                size += usize::from(!fixed);
                if *fixed { FIXED } else { size - 1 }
            })
        };
        let dof: Vec<[usize; 3]> = fixed.iter().map(number).collect();
        let stiffness = matrices.free_stiffness(&dof, size);
        let is_free = !fixed.contains(&true);
        let motions = if is_free { rigid_motions(mesh) } else { Vec::new() };
        if !is_free && !holds(mesh, fixed) {
            return Err(Error::Solver(
                "the supports of the body lie on one point or one line, about which it can turn: hold a face, or nothing".into(),
            ));
        }
        let propped = props(&motions);
        let factor = match propped.is_empty() {
            true => Factor::new(&stiffness, &[])?,
            false => Factor::new(&propped_up(&stiffness, &propped), &[])?,
        };
        let mut statics = Self { matrices, stiffness, mass, dof, size, factor, rigid: Vec::new(), propped };
        for motion in motions {
            if let Some(motion) = statics.orthonormal(motion, &statics.rigid) {
                statics.rigid.push(motion);
            }
        }
        Ok(statics)
    }

    fn mass_times(&self, x: &[f64]) -> Vec<f64> {
        self.matrices.mass_times(&self.mass, &self.dof, x)
    }

    /// The force against which a contact presses: along -`normal` over what is `pressed`.
    pub(super) fn force(&self, pressed: &HertzLoad, normal: Vector3<f64>) -> Vec<f64> {
        let mut force = vec![0.0; self.size];
        for (node, share) in &pressed.nodes {
            for (c, &dof) in self.dof[*node].iter().enumerate().filter(|(_, dof)| **dof != FIXED) {
                force[dof] += share * normal[c];
            }
        }
        force
    }

    /// Displacement of what is `pressed` in a `direction`.
    pub(super) fn seen(&self, pressed: &HertzLoad, direction: Vector3<f64>, u: &[f64]) -> f64 {
        let at = |node: usize| -> f64 {
            let free = self.dof[node].iter().enumerate().filter(|(_, dof)| **dof != FIXED);
            free.map(|(c, &dof)| direction[c] * u[dof]).sum()
        };
        pressed.nodes.iter().map(|(node, share)| share * at(*node)).sum()
    }

    /// Static displacement under the forces `f`, in place; a free body is accelerated by them and deforms alone.
    pub(super) fn solve(&self, f: &mut [f64]) {
        if self.rigid.is_empty() {
            self.factor.solve(f);
            return;
        }
        for motion in &self.rigid {
            axpy(-dot(motion, f), &self.mass_times(motion), f);
        }
        self.propped.iter().for_each(|&dof| f[dof] = 0.0);
        self.factor.solve(f);
        self.remove_rigid(f);
    }

    fn remove_rigid(&self, u: &mut [f64]) {
        let mass = self.mass_times(u);
        for motion in &self.rigid {
            axpy(-dot(motion, &mass), motion, u);
        }
    }

    /// `x` made mass-orthogonal to the `basis`, mass-normalised; `None` if it is a combination of it.
    fn orthonormal(&self, mut x: Vec<f64>, basis: &[Vec<f64>]) -> Option<Vec<f64>> {
        let norm = |x: &[f64]| dot(x, &self.mass_times(x)).max(0.0).sqrt();
        let before = norm(&x);
        // twice is enough (Parlett, The Symmetric Eigenvalue Problem, 6.9)
        for _ in 0..2 {
            let mass = self.mass_times(&x);
            for own in basis {
                axpy(-dot(own, &mass), own, &mut x);
            }
        }
        let after = norm(&x);
        (after > DEPENDENT * before).then(|| {
            x.iter_mut().for_each(|value| *value /= after);
            x
        })
    }

    /// Frequencies in rad/s and mass-normalised shapes of the lowest Ritz modes that begin with the static solutions `start`.
    pub(super) fn ritz(&self, start: Vec<Vec<f64>>) -> Result<(Vec<f64>, Vec<Vec<f64>>)> {
        let width = start.len();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let mut block = start;
        for _ in 0..BLOCKS {
            let mut next = Vec::new();
            for vector in block {
                let Some(vector) = self.orthonormal(vector, &basis) else { continue };
                let mut u = self.mass_times(&vector);
                basis.push(vector);
                self.solve(&mut u);
                next.push(u);
            }
            block = next;
        }
        let forces: Vec<Vec<f64>> =
            basis.iter().map(|vector| symmetric_times(&self.stiffness, vector)).collect();
        let count = basis.len();
        let stiffness = Mat::from_fn(count, count, |i, j| {
            0.5 * (dot(&basis[i], &forces[j]) + dot(&basis[j], &forces[i]))
        });
        let (squares, vectors) = symmetric(&stiffness)
            .ok_or_else(|| Error::Solver("the Ritz modes of the body did not converge".into()))?;
        let kept = count.saturating_sub(DROPPED * width).max(1);
        let shape = |k: usize| {
            let mut sum = vec![0.0; self.size];
            basis.iter().enumerate().for_each(|(i, vector)| axpy(vectors[(i, k)], vector, &mut sum));
            sum
        };
        let omega = squares.iter().take(kept).map(|square| square.max(0.0).sqrt()).collect();
        Ok((omega, (0..kept).map(shape).collect()))
    }
}

impl ShiftInvert for Statics {
    fn size(&self) -> usize {
        self.size
    }

    fn elastic_size(&self) -> usize {
        self.size - self.rigid.len()
    }

    fn mass_times(&self, x: &[f64]) -> Vec<f64> {
        Statics::mass_times(self, x)
    }

    fn solve(&self, f: &mut [f64]) {
        Statics::solve(self, f);
    }

    fn remove_rigid(&self, x: &mut [f64]) {
        Statics::remove_rigid(self, x);
    }
}

/// The six rigid motions of a mesh without supports. Shape (6, 3 nodes).
fn rigid_motions(mesh: &TetMesh) -> Vec<Vec<f64>> {
    let count = mesh.points.len() as f64;
    let middle = mesh.points.iter().sum::<Vector3<f64>>() / count;
    let of = |motion: &dyn Fn(Vector3<f64>) -> Vector3<f64>| -> Vec<f64> {
        mesh.points.iter().flat_map(|p| <[f64; 3]>::from(motion(p - middle))).collect()
    };
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let shifts = axes.iter().map(|axis| of(&|_| *axis));
    shifts.chain(axes.iter().map(|axis| of(&|p| axis.cross(&p)))).collect()
}

/// Whether a body cannot move whose nodes `fixed` do not: its rigid motions, rotations in terms of its size, are independent on them.
fn holds(mesh: &TetMesh, fixed: &[bool]) -> bool {
    let motions = rigid_motions(mesh);
    let size =
        motions[3..].iter().flatten().fold(f64::MIN_POSITIVE, |most: f64, value| most.max(value.abs()));
    let on_fixed = |i: usize, j: usize| -> f64 {
        let scale = |k: usize| if k < 3 { 1.0 } else { 1.0 / size };
        let of_node = |n: usize| (0..3).map(|c| motions[i][3 * n + c] * motions[j][3 * n + c]).sum::<f64>();
        scale(i) * scale(j) * (0..fixed.len()).filter(|n| fixed[*n]).map(of_node).sum::<f64>()
    };
    let squares = symmetric(&Mat::from_fn(6, 6, on_fixed)).map(|(squares, _)| squares);
    squares.is_some_and(|squares| squares[0] > INDEPENDENT * squares[5])
}

/// Six displacements that hold a body of these rigid `motions` without straining it: those that the motions move most, one after the other.
fn props(motions: &[Vec<f64>]) -> Vec<usize> {
    let mut left = motions.to_vec();
    for motion in &mut left {
        let size = dot(motion, motion).sqrt();
        motion.iter_mut().for_each(|value| *value /= size);
    }
    let mut found = Vec::new();
    let size = left.first().map_or(0, Vec::len);
    for _ in 0..motions.len() {
        let moved = |dof: usize| left.iter().map(|motion| motion[dof] * motion[dof]).sum::<f64>();
        let Some(most) = (0..size).max_by(|a, b| moved(*a).total_cmp(&moved(*b))) else { break };
        found.push(most);
        // what is left does not move it
        let row: Vec<f64> = left.iter().map(|motion| motion[most]).collect();
        let square = dot(&row, &row);
        let mut along = vec![0.0; size];
        left.iter().zip(&row).for_each(|(motion, share)| axpy(*share, motion, &mut along));
        left.iter_mut().zip(&row).for_each(|(motion, share)| axpy(-share / square, &along, motion));
    }
    found
}

/// The lower triangle `stiffness` with the rows and columns of `propped` displacements those of the unit matrix times their diagonal.
fn propped_up(stiffness: &SparseColMat<usize, f64>, propped: &[usize]) -> SparseColMat<usize, f64> {
    let mut held = stiffness.clone();
    let (symbolic, values) = held.parts_mut();
    for column in 0..symbolic.ncols() {
        for entry in symbolic.col_range(column) {
            let row = symbolic.row_idx()[entry];
            if row != column && (propped.contains(&row) || propped.contains(&column)) {
                values[entry] = 0.0;
            }
        }
    }
    held
}

/// The symmetric matrix with this lower triangle times `x`.
fn symmetric_times(lower: &SparseColMat<usize, f64>, x: &[f64]) -> Vec<f64> {
    let mut product = vec![0.0; x.len()];
    for column in 0..lower.ncols() {
        for (row, value) in lower.row_idx_of_col(column).zip(lower.val_of_col(column)) {
            product[row] += value * x[column];
            if row != column {
                product[column] += value * x[row];
            }
        }
    }
    product
}
