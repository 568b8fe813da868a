//! A solid body meshed with tetrahedra, reduced to its lowest modes and the static flexibility of an interface.
//!
//! The discrete system is that of the finite-element reference on the same mesh: straight linear or quadratic
//! tetrahedra, lumped mass. The interface is the set of nodes at which other bodies may touch; under forces on it the body
//! answers with its modes, and with the static residual of all the modes that are omitted.

mod continuation;
mod curved;
mod elasticity;
mod factor;
mod materials;
mod mesh;
mod meshed;
mod morph;
mod pressure;
mod statics;
mod struck;
mod surface;
mod view;

pub use materials::CellMaterials;
pub use mesh::TetMesh;
#[cfg(test)]
pub(crate) use mesh::boxes;
pub use meshed::{BodyMesh, ContactInfo};
pub use pressure::SurfacePoint;
pub use struck::{CIRCLES, StruckPoint, StruckSolid, frequencies};
pub use surface::Surface;
pub use view::BodyView;

use super::continuum::lanczos::{ShiftInvert, lowest_modes};
use crate::error::{Error, Result};
use crate::scene::Material;
use elasticity::{FIXED, SolidMatrices};
use factor::Factor;
use serde::{Deserialize, Serialize};

/// Factorised elastic body on supports.
pub struct Solid {
    /// Numbers of (u_x, u_y, u_z) of each node, or [`FIXED`]. Shape (nodes, 3).
    dof: Vec<[usize; 3]>,
    /// Lumped mass of each degree of freedom in kg. Shape (n).
    mass: Vec<f64>,
    factor: Factor,
    /// Nodes of the interface.
    interface: Vec<usize>,
}

/// A solid as other bodies meet it at the m nodes of its interface.
///
/// Under nodal forces f on the interface the mass-normalised coordinates obey
/// `q_k'' + omega_k^2 q_k = participation_k . f`, and the interface moves by
/// `sum_k q_k participation_k + residual f` with the residual of [`InterfaceBody::residual`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct InterfaceBody {
    /// Eigenfrequencies omega_k in rad/s, ascending. Shape (n).
    pub omega: Vec<f64>,
    /// Mass-normalised mode shapes (x, y, z of each node) in kg^(-1/2). Shape (n, 3 m).
    pub participation: Vec<Vec<f64>>,
    /// Static flexibility between the displacements of the interface in m/N, lower triangle row by row.
    /// Shape (3 m (3 m + 1) / 2).
    pub flexibility: Vec<f64>,
    /// Mass of the body in kg.
    pub mass: f64,
}

impl Solid {
    /// Assembles and factorises. `held[node]` says which of (u_x, u_y, u_z) the supports hold.
    ///
    /// # Errors
    /// [`Error::Solver`] if the supports leave a rigid motion or the material is too nearly incompressible.
    pub fn new(
        mesh: &TetMesh,
        material: &Material,
        fixed: &[[bool; 3]],
        interface: &[usize],
    ) -> Result<Self> {
        let matrices = SolidMatrices::new(mesh, &CellMaterials::one(material.clone()));
        let mut size = 0;
        let dof: Vec<[usize; 3]> = fixed
            .iter()
            .map(|fixed| {
                fixed.map(|fixed| {
                    size += usize::from(!fixed);
                    if fixed { FIXED } else { size - 1 }
                })
            })
            .collect();
        let last: Vec<usize> = interface.iter().flat_map(|&node| dof[node]).filter(|d| *d != FIXED).collect();
        let factor = Factor::new(&matrices.free_stiffness(&dof, size), &last)?;
        let mut mass = vec![0.0; size];
        for (dof, m) in dof.iter().zip(&matrices.mass) {
            dof.iter().filter(|d| **d != FIXED).for_each(|&d| mass[d] = *m);
        }
        Ok(Self { dof, mass, factor, interface: interface.to_vec() })
    }

    /// Number of degrees of freedom.
    pub fn size(&self) -> usize {
        self.mass.len()
    }

    /// The `modes` lowest modes and the static flexibility of the interface.
    ///
    /// # Errors
    /// [`Error::Solver`] if the mesh has not enough modes or the iteration does not converge.
    pub fn at_interface(&self, modes: usize) -> Result<InterfaceBody> {
        let found = lowest_modes(self, modes, f64::INFINITY)?;
        let value = |x: &[f64], dof: usize| if dof == FIXED { 0.0 } else { x[dof] };
        let seen = |shape: &Vec<f64>| self.interface_dof().map(|dof| value(shape, dof)).collect();
        let inverse = self.factor.interface_flexibility();
        // Position of each component among the factor's last unknowns, which leave out those that are held.
        let mut free = 0;
        let position: Vec<Option<usize>> = self
            .interface_dof()
            .map(|dof| {
                free += usize::from(dof != FIXED);
                (dof != FIXED).then(|| free - 1)
            })
            .collect();
        let mut flexibility = Vec::with_capacity(position.len() * (position.len() + 1) / 2);
        for (i, row) in position.iter().enumerate() {
            for column in &position[..=i] {
                flexibility.push(row.zip(*column).map_or(0.0, |(r, c)| inverse[(r, c)]));
            }
        }
        Ok(InterfaceBody {
            omega: found.omega,
            participation: found.shape.iter().map(seen).collect(),
            flexibility,
            mass: self.mass.iter().sum::<f64>(),
        })
    }

    fn interface_dof(&self) -> impl Iterator<Item = usize> + '_ {
        self.interface.iter().flat_map(|&node| self.dof[node])
    }
}

impl ShiftInvert for Solid {
    fn size(&self) -> usize {
        self.mass.len()
    }

    fn mass_times(&self, x: &[f64]) -> Vec<f64> {
        x.iter().zip(&self.mass).map(|(x, m)| x * m).collect()
    }

    fn solve(&self, f: &mut [f64]) {
        self.factor.solve(f);
    }
}

impl InterfaceBody {
    /// Displacements of the interface, 3 m.
    pub fn size(&self) -> usize {
        self.participation.first().map_or(0, Vec::len)
    }

    /// Residual flexibility in m/N beyond the `modes` lowest: C - sum_k phi_k phi_k^T / omega_k^2.
    /// Shape (3 m, 3 m), row by row.
    ///
    /// # Errors
    /// [`Error::Usage`] if the body has fewer modes.
    pub fn residual(&self, modes: usize) -> Result<Vec<f64>> {
        if modes > self.omega.len() {
            return Err(Error::Usage(format!(
                "{modes} modes of a solid that has {} are requested",
                self.omega.len()
            )));
        }
        let n = self.size();
        let mut full = vec![0.0; n * n];
        let mut packed = self.flexibility.iter();
        for i in 0..n {
            for j in 0..=i {
                let memo: f64 = (0..modes)
                    .map(|k| self.participation[k][i] * self.participation[k][j] / self.omega[k].powi(2))
                    .sum();
                let rest = packed.next().copied().unwrap_or(0.0) - memo;
                full[i * n + j] = rest;
                full[j * n + i] = rest;
            }
        }
        Ok(full)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Relative error of the first eigenfrequency of a bar, free at one end and held along y and z everywhere, of
    /// 4 `fine` bricks over its length and `fine` over its width.
    fn bar_error(fine: usize, order: usize) -> f64 {
        let material = Material::elastic("m", 8.0, 0.0, 2.0);
        let mesh = mesh::boxes([1.0, 0.25, 0.25], [4 * fine, fine, fine], order, |p| p);
        let fixed: Vec<[bool; 3]> = mesh.points.iter().map(|p| [p[0] == 0.0, true, true]).collect();
        let end: Vec<usize> = (0..mesh.points.len()).filter(|&n| mesh.points[n][0] == 1.0).collect();
        let solid = Solid::new(&mesh, &material, &fixed, &end).expect("solid");
        let body = solid.at_interface(2).expect("modes");
        // omega = pi/2 sqrt(E/rho)/L
        body.omega[0] / (0.5 * PI * 2.0) - 1.0
    }

    #[test]
    fn frequency_of_a_bar_converges_with_second_order() {
        for order in [1, 2] {
            let errors = [1, 2, 4].map(|fine| bar_error(fine, order).abs());
            assert!(errors[2] < 1e-3, "order {order}: {errors:?}");
            for pair in errors.windows(2) {
                let observed = (pair[0] / pair[1]).log2();
                assert!((1.8..2.3).contains(&observed), "order {order}: {errors:?}");
            }
        }
    }

    #[test]
    fn all_modes_together_leave_no_residual() {
        let material = Material::elastic("m", 1.0, 0.3, 1.0);
        let mesh = mesh::boxes([1.0, 0.7, 0.4], [4, 3, 2], 1, |p| p);
        let fixed: Vec<[bool; 3]> = mesh.points.iter().map(|p| [p[0] == 0.0; 3]).collect();
        let interface = [59, 58, 30, 2];
        let solid = Solid::new(&mesh, &material, &fixed, &interface).expect("solid");
        let body = solid.at_interface(solid.size() / 2).expect("modes");
        let trace = |modes| (0..12).map(|i| body.residual(modes).expect("residual")[13 * i]).sum::<f64>();
        // each mode takes some of it away, and what is left stays positive: no mode is counted twice
        let traces: Vec<f64> = [0, 1, 5, 20, body.omega.len()].map(trace).to_vec();
        assert!(traces.windows(2).all(|w| w[1] < w[0]) && traces[4] > 0.0, "{traces:?}");
        assert!(traces[4] < 0.2 * traces[0], "{traces:?}");
        let fixed_node = body.residual(0).expect("residual");
        let last = 12 * 9 + 9;
        assert_eq!(fixed_node[last], 0.0, "node 2 is held: it does not yield");
        assert!(body.residual(body.omega.len() + 1).is_err());
    }
}
