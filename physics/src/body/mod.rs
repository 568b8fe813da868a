//! An elastic body as the impact sees it: modes, their participation at the contact points,
//! residual flexibility.

pub mod bending;
pub mod cache;
pub mod continuum;
pub mod free_sphere;
pub mod kirchhoff;
pub mod layer;
pub(crate) mod memo;
pub mod off_centre;
pub mod solid;

use crate::contact::PatchFlexibility;
use serde::{Deserialize, Serialize};

/// Linear elastic body reduced to its modes, seen from its contact points.
///
/// With mass-normalised coordinates q the body obeys
/// `q_k'' + 2 zeta_k omega_k q_k' + omega_k^2 q_k = sum_i participation[k][i] f_i`
/// under forces `f_i` along +z at the contact points, and the displacement along +z of contact
/// point i is `sum_k participation[k][i] q_k + sum_j R_ij f_j` with the residual flexibility R.
/// Contact point 0 faces the outer body, contact point 1 the inner body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ModalBody {
    /// Eigenfrequencies omega_k in rad/s, ascending; 0 = rigid motion. Shape (n).
    pub omega: Vec<f64>,
    /// Damping ratios zeta_k. Shape (n).
    pub damping_ratio: Vec<f64>,
    /// Mass-normalised mode shapes at the contact points, kg^(-1/2). Shape (n, 2).
    pub participation: Vec<[f64; 2]>,
    /// Residual flexibility beyond the modes and beyond Hertz's half-spaces; `None` for models A and B.
    pub residual: Option<PatchFlexibility>,
}
