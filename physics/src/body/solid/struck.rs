//! A body from a mesh as one or two other bodies strike it: load-dependent Ritz vectors, and static flexibility under circles that the mesh
//! resolves.
//!
//! Ritz vectors: E. L. Wilson, M.-W. Yuan, J. M. Dickens, Earthquake Eng. Struct. Dyn. 10 (1982) 813: the static solutions under the contact
//! forces, then again and again those under the inertia forces of the last. Few of them move the contacts as hundreds of modes do.

use super::materials::CellMaterials;
use super::mesh::TetMesh;
use super::pressure::{HertzLoad, SurfaceAround, SurfacePoint};
use super::statics::{DEPENDENT, Statics};
use crate::body::continuum::lanczos::lowest_modes;
use crate::error::{Error, Result};
use crate::numerics::vectors::dot;
use crate::scene::Material;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Circles on which each contact is solved, in element sizes: smaller ones feel the mesh, larger ones the body's own shape.
pub const CIRCLES: [f64; 3] = [1.41, 2.0, 2.83];
/// The one whose static solutions begin the Ritz vectors.
pub(super) const MIDDLE: usize = 1;
/// Least share of the pressure that lies on the surface, and largest one that lies on held nodes.
const COVERED: f64 = 0.99;
const HELD: f64 = 0.01;
/// Motion of a contact along its normal, over the root mean square of the mode's displacement, from which on the contact counts as exciting
/// it: an unsymmetrical mesh moves it a little in any mode. The references have the same number.
const EXCITED: f64 = 0.1;

/// Where a body is struck, and how large the mesh's elements are there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StruckPoint {
    /// Place and normal.
    pub at: SurfacePoint,
    /// Radii of the circles in m, ascending.
    pub circles: [f64; 3],
    /// Whether friction acts along the surface too: the modes then follow that force as well.
    pub rubs: bool,
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
    /// The same in the direction [`SurfacePoint::aside`].
    pub aside: Vec<[f64; 2]>,
    /// Displacements along the normals of rigid motions, of which the contacts see two at most. Shape (r, 2).
    pub rigid: Vec<[f64; 2]>,
    /// Displacements of all rigid motions: along the normals, along the surface, and aside. Shape (6, 3, 2), none of a held body.
    pub rigid_motions: Vec<[[f64; 2]; 3]>,
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
        let mut body = Self {
            omega: Vec::new(),
            participation: Vec::new(),
            along: Vec::new(),
            aside: Vec::new(),
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
        for (k, point) in points.iter().enumerate().filter(|(_, point)| point.rubs) {
            let mut u = statics.force(&loads[k][MIDDLE], point.at.along());
            statics.solve(&mut u);
            start.push(u);
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
        let towards = |direction: fn(&SurfacePoint) -> Vector3<f64>, shape: &Vec<f64>| {
            at_contacts(&|k| statics.seen(&loads[k][MIDDLE], direction(&points[k].at), shape))
        };
        body.along = shapes.iter().map(|shape| towards(SurfacePoint::along, shape)).collect();
        body.aside = shapes.iter().map(|shape| towards(SurfacePoint::aside, shape)).collect();
        let rigid = |motion: &Vec<f64>| {
            let normal = at_contacts(&|k| seen(k, MIDDLE, motion));
            [normal, towards(SurfacePoint::along, motion), towards(SurfacePoint::aside, motion)]
        };
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
        let pairs = body.rigid.iter_mut().chain(&mut body.along).chain(&mut body.aside).chain(motions);
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
