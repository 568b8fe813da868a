//! A body from a mesh as one or two other bodies strike it: load-dependent Ritz vectors, and static flexibility under circles that the mesh
//! resolves.
//!
//! Ritz vectors: E. L. Wilson, M.-W. Yuan, J. M. Dickens, Earthquake Eng. Struct. Dyn. 10 (1982) 813: the static solutions under the contact
//! forces, then again and again those under the inertia forces of the last. Few of them move the contacts as hundreds of modes do.

use super::elasticity::{FIXED, SolidMatrices};
use super::factor::Factor;
use super::materials::CellMaterials;
use super::mesh::TetMesh;
use super::pressure::{HertzLoad, SurfaceAround, SurfacePoint};
use crate::body::continuum::lanczos::{ShiftInvert, lowest_modes};
use crate::error::{Error, Result};
use crate::numerics::eigenmodes::symmetric;
use crate::numerics::vectors::{axpy, dot};
use crate::scene::Material;
use faer::Mat;
use faer::sparse::SparseColMat;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Circles on which each contact is solved, in element sizes: smaller ones feel the mesh, larger ones the body's own shape.
pub const CIRCLES: [f64; 3] = [1.41, 2.0, 2.83];
/// The one whose static solutions begin the Ritz vectors.
const MIDDLE: usize = 1;
/// Blocks of Ritz vectors, and how many of the highest are left to the static flexibility.
const BLOCKS: usize = 14;
const DROPPED: usize = 2;
/// Share of a vector's norm below which it is a combination of those before.
const DEPENDENT: f64 = 1e-9;
/// Least share of the pressure that lies on the surface, and largest one that lies on held nodes.
const COVERED: f64 = 0.99;
const HELD: f64 = 0.01;
/// Motion of a contact along its normal, over the root mean square of the mode's displacement, from which on the contact counts as exciting
/// it: an unsymmetrical mesh moves it a little in any mode. The references have the same number.
const EXCITED: f64 = 0.1;
/// Least eigenvalue over the largest of the products of independent rigid motions on what is held.
const INDEPENDENT: f64 = 1e-8;

/// Where a body is struck, and how large the mesh's elements are there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StruckPoint {
    /// Place and normal.
    pub at: SurfacePoint,
    /// Radii of the circles in m, ascending.
    pub circles: [f64; 3],
}

/// A body reduced to what its contacts see, its first material of Young's modulus 1 Pa and density 1 kg/m^3; [`StruckSolid::of_material`]
/// scales.
///
/// Under the forces f_i against the normals it moves along them by sum_k q_k participation and the static flexibility beyond.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StruckSolid {
    /// Angular frequencies of the Ritz modes in rad/s, ascending. Shape (n).
    pub omega: Vec<f64>,
    /// Displacements along the normals in kg^(-1/2), by contact and circle; zero for a contact that is not there. Shape (n, 2, 3).
    pub participation: Vec<[[f64; 3]; 2]>,
    /// Displacements along the surface in the direction [`SurfacePoint::along`], kg^(-1/2). Shape (n, 2).
    pub along: Vec<[f64; 2]>,
    /// Displacements along the normals of rigid motions, of which the contacts see two at most. Shape (r, 2).
    pub rigid: Vec<[f64; 2]>,
    /// Displacements of all rigid motions: along the normals, and along the surface. Shape (6, 2, 2), none of a held body.
    pub rigid_motions: Vec<[[f64; 2]; 2]>,
    /// Displacement of each contact by its own unit force in m/N, by circle; of a free body what it deforms. Shape (2, 3).
    pub own: [[f64; 3]; 2],
    /// Displacement of contact 0 by a unit force at contact 1 in m/N. Shape (circles of 0, circles of 1).
    pub mutual: [[f64; 3]; 3],
    /// Radii of the circles in m. Shape (2, 3).
    pub circles: [[f64; 3]; 2],
    /// Mass in kg.
    pub mass: f64,
    /// Degrees of freedom of the mesh without those that supports hold.
    pub dofs: usize,
}

/// The discrete body, its first material of Young's modulus 1 Pa and density 1 kg/m^3, factorised.
pub(super) struct Statics {
    matrices: SolidMatrices,
    stiffness: SparseColMat<usize, f64>,
    mass: Vec<f64>,
    /// Numbers of the displacements of each node, or [`FIXED`]. Shape (nodes, 3).
    pub(super) dof: Vec<[usize; 3]>,
    size: usize,
    factor: Factor,
    /// Rigid motions of a free body, mass-normalised and mass-orthogonal; none of one that is held. Shape (6, size).
    rigid: Vec<Vec<f64>>,
    /// Displacements that stand still in the static solutions of a free body.
    propped: Vec<usize>,
}

impl StruckSolid {
    /// Of `mesh` of `materials`, whose nodes `fixed` do not move, struck at `points`, one or two.
    ///
    /// # Errors
    /// [`Error::Solver`] if the body is held so that it can still move, or a circle leaves the face.
    pub fn new(
        mesh: &TetMesh,
        materials: &CellMaterials,
        fixed: &[bool],
        points: &[StruckPoint],
    ) -> Result<Self> {
        let materials = materials.relative();
        let statics = Statics::new(mesh, &materials, fixed)?;
        let mut loads: Vec<[HertzLoad; 3]> = Vec::new();
        for (k, struck) in points.iter().enumerate() {
            let face = SurfaceAround::around(mesh, struck.at, struck.circles[2]);
            let pressed = struck.circles.map(|radius| face.pressed(radius));
            if let Some(bad) = (0..3).find(|m| pressed[*m].coverage < COVERED) {
                return Err(Error::Solver(format!(
                    "{} contact: a circle of {:.3} mm, which the mesh needs to resolve the contact, leaves the face ({:.0} % of the pressure lies on it); \
                     refine the mesh there, or strike farther from the edge",
                    ["outer", "inner"][k],
                    1e3 * struck.circles[bad],
                    100.0 * pressed[bad].coverage
                )));
            }
            let on_held = |load: &HertzLoad| -> f64 {
                load.nodes.iter().filter(|(node, _)| fixed[*node]).map(|(_, share)| share.abs()).sum()
            };
            if pressed.iter().map(on_held).fold(0.0, f64::max) > HELD {
                return Err(Error::Solver(format!(
                    "{} contact: it lies on a part of the body that is held, or within three elements of one; \
                     strike another place, or take that face out of `body.fixed`",
                    ["outer", "inner"][k]
                )));
            }
            loads.push(pressed);
        }
        let force = |k: usize, m: usize| statics.force(&loads[k][m], points[k].at.normal);
        let seen = |k: usize, m: usize, u: &[f64]| statics.seen(&loads[k][m], points[k].at.normal, u);
        let seen_along = |k: usize, u: &[f64]| statics.seen(&loads[k][MIDDLE], points[k].at.along(), u);
        let mut body = Self {
            omega: Vec::new(),
            participation: Vec::new(),
            along: Vec::new(),
            rigid: seen_rigid(&statics.rigid, points.len(), |k, motion| seen(k, MIDDLE, motion)),
            rigid_motions: Vec::new(),
            own: [[0.0; 3]; 2],
            mutual: [[0.0; 3]; 3],
            circles: [0, 1].map(|k| points.get(k).map_or([0.0; 3], |struck| struck.circles)),
            mass: materials.mass(mesh),
            dofs: statics.size,
        };
        let mut start = Vec::new();
        for k in 0..points.len() {
            for m in 0..3 {
                let mut u = force(k, m);
                statics.solve(&mut u);
                body.own[k][m] = seen(k, m, &u);
                if k == 1 {
                    (0..3).for_each(|other| body.mutual[other][m] = seen(0, other, &u));
                }
                if m == MIDDLE {
                    start.push(u);
                }
            }
        }
        let (omega, shapes) = statics.ritz(start)?;
        body.omega = omega;
        body.participation = shapes
            .iter()
            .map(|shape| {
                let of = |k: usize| {
                    std::array::from_fn(|m| if k < points.len() { seen(k, m, shape) } else { 0.0 })
                };
                [of(0), of(1)]
            })
            .collect();
        let at_contacts =
            |of: &dyn Fn(usize) -> f64| [0, 1].map(|k| if k < points.len() { of(k) } else { 0.0 });
        let along = |shape: &Vec<f64>| at_contacts(&|k| seen_along(k, shape));
        body.along = shapes.iter().map(along).collect();
        let rigid = |motion: &Vec<f64>| [at_contacts(&|k| seen(k, MIDDLE, motion)), along(motion)];
        body.rigid_motions = statics.rigid.iter().map(rigid).collect();
        Ok(body)
    }

    /// The lowest frequency in Hz that the contacts excite, the first material being `material`; infinite if there is none.
    pub fn first_frequency(&self, material: &Material) -> f64 {
        let moved =
            |k: usize| self.participation[k].iter().map(|circles| circles[MIDDLE].abs()).fold(0.0, f64::max);
        let excited = (0..self.omega.len()).find(|k| moved(*k) * self.mass.sqrt() > EXCITED);
        let omega = excited.map_or(f64::INFINITY, |k| self.omega[k]);
        omega * (material.youngs_modulus / material.density).sqrt() / (2.0 * std::f64::consts::PI)
    }

    /// The same of a body whose first material is `material`.
    #[must_use]
    pub fn of_material(&self, material: &Material) -> Self {
        let (stiffer, heavier) = (material.youngs_modulus, material.density);
        let mut body = self.clone();
        body.omega.iter_mut().for_each(|omega| *omega *= (stiffer / heavier).sqrt());
        let participations = body.participation.iter_mut().flatten().flatten();
        let motions = body.rigid_motions.iter_mut().flatten();
        let pairs = body.rigid.iter_mut().chain(&mut body.along).chain(motions);
        let participations = participations.chain(pairs.flatten());
        participations.for_each(|value| *value /= heavier.sqrt());
        let flexibilities = body.own.iter_mut().flatten().chain(body.mutual.iter_mut().flatten());
        flexibilities.for_each(|value| *value /= stiffer);
        body.mass *= heavier;
        body
    }
}

/// Combinations of the `rigid` motions that the contacts see, as few as there are.
fn seen_rigid(rigid: &[Vec<f64>], contacts: usize, seen: impl Fn(usize, &[f64]) -> f64) -> Vec<[f64; 2]> {
    let each = |k: usize| -> Vec<f64> {
        rigid.iter().map(|motion| if k < contacts { seen(k, motion) } else { 0.0 }).collect()
    };
    let (first, second) = (each(0), each(1));
    let along = dot(&first, &first).sqrt();
    if along == 0.0 {
        return Vec::new();
    }
    // in the basis that begins with the first contact's own motion
    let shared = dot(&first, &second) / along;
    let rest = (dot(&second, &second) - shared * shared).max(0.0).sqrt();
    let mut combined = vec![[along, shared]];
    if rest > DEPENDENT.sqrt() * along {
        combined.push([0.0, rest]);
    }
    combined
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
    fn seen(&self, pressed: &HertzLoad, direction: Vector3<f64>, u: &[f64]) -> f64 {
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

/// The `count` lowest elastic eigenfrequencies in Hz of `mesh` of `materials`, whose nodes `fixed` do not move.
///
/// # Errors
/// [`Error::Solver`] if the body is held so that it can still move, or the mesh has not enough modes.
pub fn frequencies(
    mesh: &TetMesh,
    materials: &CellMaterials,
    fixed: &[bool],
    count: usize,
) -> Result<Vec<f64>> {
    let statics = Statics::new(mesh, &materials.relative(), fixed)?;
    let unit = hertz_of_unit(&materials.materials[0]);
    Ok(lowest_modes(&statics, count, f64::INFINITY)?.omega.into_iter().map(|omega| unit * omega).collect())
}

/// Frequency in Hz of 1 rad/s of a body of Young's modulus 1 Pa and density 1 kg/m^3, if it is of `material` instead.
pub(super) fn hertz_of_unit(material: &Material) -> f64 {
    (material.youngs_modulus / material.density).sqrt() / std::f64::consts::TAU
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
