//! The upper half of a mirror-symmetric body of revolution, for one parity of the motion.
//!
//! A body that is its own mirror image in z = 0 moves in two independent ways: *bending*
//! (u_z even, u_r odd in z: u_r = 0 on the mid-plane) and *longitudinal* (u_z odd, u_r even:
//! u_z = 0 on the mid-plane). Each needs only the half z >= 0. With the half's stiffness K_h, mass
//! M_h and load vectors p_i (unit force on the upper face along +z):
//!
//! - a load on the whole body is half bending, half longitudinal; the flexibility between
//!   points i and j is p_i^T K_h^-1 p_j / 2 for each parity, times -1 for longitudinal motion
//!   if exactly one of the points is on the lower face;
//! - a mode with v^T M_h v = 1 has the norm 2 on the whole body: participation p_i^T v / sqrt(2).

use super::assembly::{FIXED, Matrices};
use super::lanczos::ShiftInvert;
use super::mesh::Mesh;
use crate::error::{Error, Result};
use crate::numerics::vectors::{axpy, dot};
use faer::Side;
use faer::linalg::solvers::Solve;
use faer::mat::MatMut;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use std::rc::Rc;

/// How the motion behaves under reflection in the mid-plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Parity {
    /// u_z even in z.
    Bending,
    /// u_z odd in z.
    Longitudinal,
}

/// Rigid axial motion of a free body.
#[derive(Debug, Clone)]
struct RigidMotion {
    /// Unit axial displacement: 1 at every axial degree of freedom. Shape (n).
    shape: Vec<f64>,
    /// Mass matrix times `shape`. Shape (n).
    momentum: Vec<f64>,
    /// Mass of the half body in kg.
    mass: f64,
    /// Degree of freedom held when the stiffness is factorised.
    pinned: usize,
}

/// Factorised stiffness and mass of the half body for one parity; n degrees of freedom.
pub(super) struct HalfBody {
    /// Degrees of freedom (u_r, u_z) of each node, or [`FIXED`]. Shape (nodes, 2).
    dof: Vec<[usize; 2]>,
    size: usize,
    stiffness: Llt<usize, f64>,
    matrices: Rc<Matrices>,
    rigid: Option<RigidMotion>,
}

impl HalfBody {
    /// Assembles and factorises. `supported(node)` says which of (u_r, u_z) the support holds;
    /// `free` says that nothing holds the axial rigid motion (only bending has one).
    ///
    /// # Errors
    /// [`Error::Solver`] if the stiffness is not positive definite.
    pub fn new(
        mesh: &Mesh,
        matrices: &Rc<Matrices>,
        parity: Parity,
        supported: impl Fn([f64; 2]) -> [bool; 2],
        free: bool,
    ) -> Result<Self> {
        let mut size = 0;
        let number = |fixed: bool, size: &mut usize| {
            if fixed {
                return FIXED;
            }
            *size += 1;
            *size - 1
        };
        let mut dof = Vec::with_capacity(mesh.nodes.len());
        for &[r, z] in &mesh.nodes {
            let [support_r, support_z] = supported([r, z]);
            let mid_plane = z == 0.0;
            let fixed_r = support_r || r == 0.0 || (mid_plane && parity == Parity::Bending);
            let fixed_z = support_z || (mid_plane && parity == Parity::Longitudinal);
            dof.push([number(fixed_r, &mut size), number(fixed_z, &mut size)]);
        }
        let pinned = (free && parity == Parity::Bending)
            .then(|| dof.iter().rev().map(|d| d[1]).find(|&d| d != FIXED).unwrap_or(0));
        let stiffness = matrices.free_stiffness(&dof, size, pinned)?;
        let stiffness = SymbolicLlt::try_new(stiffness.symbolic(), Side::Lower)
            .map_err(|e| Error::Internal(format!("ordering the continuum stiffness: {e:?}")))
            .and_then(|symbolic| {
                Llt::try_new_with_symbolic(symbolic, stiffness.as_ref(), Side::Lower).map_err(|e| {
                    Error::Solver(format!(
                        "the stiffness of the continuum mesh ({size} degrees of freedom) is not positive definite ({e:?}): the body is too thin or too nearly incompressible for double precision"
                    ))
                })
            })?;
        let mut body = Self { dof, size, stiffness, matrices: matrices.clone(), rigid: None };
        if let Some(pinned) = pinned {
            let mut shape = vec![0.0; size];
            body.dof.iter().filter(|d| d[1] != FIXED).for_each(|d| shape[d[1]] = 1.0);
            let momentum = body.mass_times(&shape);
            let mass = dot(&shape, &momentum);
            body.rigid = Some(RigidMotion { shape, momentum, mass, pinned });
        }
        Ok(body)
    }

    /// Relative error that rounding in the assembled stiffness can leave in the square of the frequency `omega` (rad/s) of the
    /// mode `shape` (as in [`super::lanczos::Modes`]): machine precision times the strain energy that each displacement would have
    /// alone. A small element, which moves with its neighbours, matters as little as it is small.
    ///
    /// It grows as (R/t)^4 for thin plates and without bound towards nu = 1/2.
    pub fn rounding_error(&self, omega: f64, shape: &[f64]) -> f64 {
        let diagonal = self.matrices.stiffness_diagonal();
        let alone = self.dof.iter().zip(diagonal).flat_map(|(dof, stiffness)| {
            [0, 1].map(|i| if dof[i] == FIXED { 0.0 } else { stiffness[i] * shape[dof[i]].powi(2) })
        });
        f64::EPSILON * alone.sum::<f64>() / omega.powi(2)
    }

    /// [`ShiftInvert::solve`] of several loads, one after the other in `f`.
    pub fn solve_each(&self, f: &mut [f64]) {
        if let Some(rigid) = &self.rigid {
            for f in f.chunks_exact_mut(self.size) {
                let acceleration = dot(&rigid.shape, f) / rigid.mass;
                axpy(-acceleration, &rigid.momentum, f);
                f[rigid.pinned] = 0.0;
            }
        }
        let count = f.len() / self.size;
        self.stiffness.solve_in_place(MatMut::from_column_major_slice_mut(f, self.size, count));
        f.chunks_exact_mut(self.size).for_each(|f| self.remove_rigid(f));
    }

    /// Load vector with the nodal axial forces `forces`, given as (node, N).
    pub fn axial_load(&self, forces: &[(usize, f64)]) -> Vec<f64> {
        let mut load = vec![0.0; self.size];
        for &(node, force) in forces {
            let dof = self.dof[node][1];
            if dof != FIXED {
                load[dof] += force;
            }
        }
        load
    }
}

impl ShiftInvert for HalfBody {
    fn size(&self) -> usize {
        self.size
    }

    fn elastic_size(&self) -> usize {
        self.size - usize::from(self.rigid.is_some())
    }

    fn mass_times(&self, x: &[f64]) -> Vec<f64> {
        let value = |dof: usize| if dof == FIXED { 0.0 } else { x[dof] };
        let nodal: Vec<[f64; 2]> = self.dof.iter().map(|d| d.map(value)).collect();
        let momentum = self.matrices.mass_times(&nodal);
        let mut y = vec![0.0; self.size];
        for (dof, momentum) in self.dof.iter().zip(momentum) {
            for (&d, m) in dof.iter().zip(momentum) {
                if d != FIXED {
                    y[d] = m;
                }
            }
        }
        y
    }

    /// Static displacement under the load `f`, in place.
    ///
    /// A free body is accelerated by the resultant; its displacement is that under the load and the
    /// inertia forces, with the rigid part (M-orthogonally) taken out: inertia relief.
    fn solve(&self, f: &mut [f64]) {
        self.solve_each(f);
    }

    /// Makes `x` M-orthogonal to the rigid motion, in place.
    fn remove_rigid(&self, x: &mut [f64]) {
        if let Some(rigid) = &self.rigid {
            let rigid_part = dot(&rigid.momentum, x) / rigid.mass;
            axpy(-rigid_part, &rigid.shape, x);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::mesh;
    use super::*;
    use crate::scene::Material;
    use approx::assert_relative_eq;

    fn material() -> Material {
        Material::elastic("m", 2e11, 0.3, 7780.0)
    }

    fn free_half(mesh: &Mesh, parity: Parity) -> HalfBody {
        let matrices = Rc::new(Matrices::new(mesh, &material()).unwrap());
        HalfBody::new(mesh, &matrices, parity, |_| [false, false], true).unwrap()
    }

    #[test]
    fn mass_of_the_half_body_is_exact() {
        let plate = mesh::plate(3, &[0.0, 0.01, 0.033], &[0.0, 0.0004, 0.001]);
        let rigid = free_half(&plate, Parity::Bending).rigid.unwrap();
        let exact = 7780.0 * std::f64::consts::PI * 0.033f64.powi(2) * 0.001;
        assert_relative_eq!(rigid.mass, exact, max_relative = 1e-13);
        let sphere = mesh::half_sphere(4, 0.01, 0.0005, 0.0002, 1.4, 0.002);
        let rigid = free_half(&sphere, Parity::Bending).rigid.unwrap();
        let exact = 7780.0 * 2.0 / 3.0 * std::f64::consts::PI * 1e-6;
        assert_relative_eq!(rigid.mass, exact, max_relative = 1e-8);
    }

    #[test]
    fn rigid_motion_has_no_stiffness_and_uniform_strain_the_right_energy() {
        let sphere = mesh::half_sphere(3, 1.0, 0.05, 0.02, 1.4, 0.3);
        let matrices = Matrices::new(&sphere, &material()).unwrap();
        let dof: Vec<[usize; 2]> = (0..sphere.nodes.len()).map(|n| [2 * n, 2 * n + 1]).collect();
        let k = matrices.free_stiffness(&dof, 2 * dof.len(), None).unwrap();
        let energy = |u: &dyn Fn(usize) -> [f64; 2]| -> f64 {
            let u: Vec<f64> = (0..sphere.nodes.len()).flat_map(u).collect();
            let lower = k.triplet_iter().map(|t| (t.row, t.col, *t.val));
            lower.map(|(i, j, k)| if i == j { 0.5 } else { 1.0 } * u[i] * k * u[j]).sum()
        };
        let (r, z) = (|n: usize| sphere.nodes[n][0], |n: usize| sphere.nodes[n][1]);
        // Uniaxial tension e: energy E e^2 / 2 per volume.
        let tension = energy(&|n| [-0.3 * r(n), z(n)]);
        let exact = 0.5 * 2e11 * 2.0 / 3.0 * std::f64::consts::PI;
        assert_relative_eq!(tension, exact, max_relative = 1e-5);
        assert!(energy(&|_| [0.0, 1.0]).abs() < 1e-12 * tension);
    }

    #[test]
    fn inertia_relief_leaves_no_rigid_motion_and_balances_the_load() {
        let plate = mesh::plate(2, &[0.0, 0.3, 1.0], &[0.0, 0.1, 0.2]);
        let half = free_half(&plate, Parity::Bending);
        let load = half.axial_load(&[(plate.surface[0][0], 1.0)]);
        let mut u = load.clone();
        half.solve(&mut u);
        let rigid = half.rigid.as_ref().unwrap();
        let scale = dot(&u, &half.mass_times(&u)).sqrt();
        assert!(dot(&rigid.momentum, &u).abs() < 1e-10 * scale * rigid.mass.sqrt());
        // A load without resultant gives the same displacement as with its inertia forces added.
        let mut shifted = load;
        axpy(-1.0 / rigid.mass, &rigid.momentum, &mut shifted);
        half.solve(&mut shifted);
        for (a, b) in u.iter().zip(&shifted) {
            assert!((a - b).abs() < 1e-9 * u[rigid.pinned].abs(), "{a} {b}");
        }
    }
}
