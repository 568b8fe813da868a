//! Stiffness and mass of one axisymmetric, isoparametric, linear elastic element.

use super::basis::QuadraturePoint;
use crate::error::{Error, Result};
use crate::scene::Material;
use std::f64::consts::TAU;

/// Stiffness and mass of one element by pairs of nodes; each field has the shape (n, n), row-major.
///
/// With displacements (u_r, u_z) the stiffness couples u_r of node a with u_z of node b by `k_rz[a][b]`;
/// `mass` is the same for both components.
#[derive(Debug, Clone)]
pub(super) struct ElementMatrices {
    pub k_rr: Vec<f64>,
    pub k_rz: Vec<f64>,
    pub k_zz: Vec<f64>,
    pub mass: Vec<f64>,
}

impl ElementMatrices {
    pub fn new(nodes: usize) -> Self {
        let zero = vec![0.0; nodes * nodes];
        Self { k_rr: zero.clone(), k_rz: zero.clone(), k_zz: zero.clone(), mass: zero }
    }

    /// Computes the matrices of the element with the node coordinates `nodes` (r, z) in m.
    ///
    /// Strains e_rr = u_r,r, e_tt = u_r / r, e_zz = u_z,z, g_rz = u_r,z + u_z,r; isotropic Hooke's law
    /// with Lame's constants; weight 2 pi r.
    ///
    /// # Errors
    /// [`Error::Solver`] if the element is degenerate or turned inside out.
    pub fn compute(
        &mut self,
        nodes: &[[f64; 2]],
        quadrature: &[QuadraturePoint],
        material: &Material,
    ) -> Result<()> {
        let (e, nu) = (material.youngs_modulus, material.poisson_ratio);
        let shear = e / (2.0 * (1.0 + nu));
        let lambda = e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let axial = lambda + 2.0 * shear;
        let n = nodes.len();
        for field in [&mut self.k_rr, &mut self.k_rz, &mut self.k_zz, &mut self.mass] {
            field.fill(0.0);
        }
        let (mut dr, mut dz, mut hoop) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        for point in quadrature {
            let mut jacobian = [[0.0; 2]; 2];
            let mut r = 0.0;
            for (a, node) in nodes.iter().enumerate() {
                r += point.value[a] * node[0];
                for c in 0..2 {
                    jacobian[c][0] += node[c] * point.d_xi[a];
                    jacobian[c][1] += node[c] * point.d_eta[a];
                }
            }
            let [[r_xi, r_eta], [z_xi, z_eta]] = jacobian;
            let determinant = r_xi * z_eta - r_eta * z_xi;
            if !(determinant > 0.0 && r > 0.0) {
                return Err(Error::Solver(format!(
                    "an element of the continuum mesh at r = {r:e} m is degenerate: its Jacobian {determinant:e} m^2 is not positive"
                )));
            }
            for a in 0..n {
                dr[a] = (point.d_xi[a] * z_eta - point.d_eta[a] * z_xi) / determinant;
                dz[a] = (point.d_eta[a] * r_xi - point.d_xi[a] * r_eta) / determinant;
                hoop[a] = point.value[a] / r;
            }
            let weight = point.weight * determinant * TAU * r;
            for a in 0..n {
                let from_rr = weight * (axial * dr[a] + lambda * hoop[a]);
                let from_tt = weight * (axial * hoop[a] + lambda * dr[a]);
                let volumetric = weight * lambda * (dr[a] + hoop[a]);
                let (shear_r, shear_z) = (weight * shear * dr[a], weight * shear * dz[a]);
                let axial_z = weight * axial * dz[a];
                let inertia = weight * material.density * point.value[a];
                let row = a * n..(a + 1) * n;
                let (k_rr, k_rz) = (&mut self.k_rr[row.clone()], &mut self.k_rz[row.clone()]);
                let (k_zz, mass) = (&mut self.k_zz[row.clone()], &mut self.mass[row]);
                for b in 0..n {
                    k_rr[b] += from_rr * dr[b] + from_tt * hoop[b] + shear_z * dz[b];
                    k_rz[b] += volumetric * dz[b] + shear_z * dr[b];
                    k_zz[b] += axial_z * dz[b] + shear_r * dr[b];
                    mass[b] += inertia * point.value[b];
                }
            }
        }
        Ok(())
    }
}
