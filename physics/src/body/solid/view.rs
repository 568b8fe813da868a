//! The surface of a meshed body to look at: triangles, sharp edges, stress and modes on it.

use super::curved;
use super::elasticity::FIXED;
use super::materials::CellMaterials;
use super::mesh::TetMesh;
use super::pressure::{SurfaceAround, SurfacePoint};
use super::statics::Statics;
use super::struck::{StruckPoint, hertz_of_unit};
use crate::error::Result;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Faces up to which each is drawn as four triangles, so that curved ones look curved.
const FINE: usize = 6000;
/// Cosine of the angle between faces from which on their common edge is drawn.
const SHARP: f64 = 0.766;
/// Modes that are shown.
const MODES: usize = 4;

/// A body's surface with what is shown on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodyView {
    /// Places in m. Shape (n).
    pub points: Vec<[f64; 3]>,
    /// Triangles by their points, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Sharp edges by their points.
    pub edges: Vec<[u32; 2]>,
    /// Whether each point is held. Shape (n).
    pub fixed: Vec<bool>,
    /// Von Mises stress in Pa under a static force of 1 N at the outer contact. Shape (n).
    pub stress: Vec<f64>,
    /// Modes that the contacts excite: frequency in Hz, and displacement of each point, the largest of length 1.
    pub modes: Vec<(f64, Vec<[f64; 3]>)>,
}

impl BodyView {
    /// Of `mesh` of `materials`, whose nodes `fixed` do not move, struck at `points`.
    ///
    /// # Errors
    /// As [`super::StruckSolid::new`].
    pub fn new(
        mesh: &TetMesh,
        materials: &CellMaterials,
        fixed: &[bool],
        points: &[StruckPoint],
    ) -> Result<Self> {
        let relative = materials.relative();
        let statics = Statics::new(mesh, &relative, fixed)?;
        let load = |point: &StruckPoint| {
            let SurfacePoint { normal, .. } = point.at;
            let pressed = SurfaceAround::around(mesh, point.at, point.circles[2]).pressed(point.circles[1]);
            let mut u = statics.force(&pressed, -normal);
            statics.solve(&mut u);
            u
        };
        let start: Vec<Vec<f64>> = points.iter().map(load).collect();
        let stress = start
            .first()
            .map_or_else(|| vec![0.0; mesh.points.len()], |u| nodal_stress(mesh, &relative, &statics.dof, u));
        let (omega, shapes) = statics.ritz(start)?;
        let faces = mesh.outer_faces();
        let mut number: BTreeMap<usize, u32> = BTreeMap::new();
        let corners_only = faces.len() > FINE;
        let mut drawn = Vec::new();
        for face in &faces {
            let [a, b, c] = [face[0], face[1], face[2]];
            match face.get(3..6) {
                Some(&[ab, bc, ca]) if !corners_only => {
                    drawn.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
                }
                _ => drawn.push([a, b, c]),
            }
        }
        for node in drawn.iter().flatten() {
            let next = number.len() as u32;
            number.entry(*node).or_insert(next);
        }
        let mut nodes = vec![0; number.len()];
        number.iter().for_each(|(node, own)| nodes[*own as usize] = *node);
        let triangles: Vec<[u32; 3]> = drawn.iter().map(|face| face.map(|node| number[&node])).collect();
        let points: Vec<[f64; 3]> = nodes.iter().map(|node| mesh.points[*node].into()).collect();
        let modes = omega.iter().zip(&shapes).take(MODES).map(|(omega, shape)| {
            let at = |node: &usize| statics.dof[*node].map(|dof| if dof == FIXED { 0.0 } else { shape[dof] });
            let moved: Vec<[f64; 3]> = nodes.iter().map(at).collect();
            let most = moved.iter().map(|u| Vector3::from(*u).norm()).fold(f64::MIN_POSITIVE, f64::max);
            let hertz = omega * hertz_of_unit(&materials.materials[0]);
            (hertz, moved.into_iter().map(|u| u.map(|value| value / most)).collect())
        });
        Ok(Self {
            edges: sharp_edges(&points, &triangles),
            fixed: nodes.iter().map(|node| fixed[*node]).collect(),
            stress: nodes.iter().map(|node| stress[*node]).collect(),
            modes: modes.collect(),
            points,
            triangles,
        })
    }
}

/// Von Mises stress at the nodes in Pa under the displacements `u` in m of a body of the relative `materials`, the mean of the elements there. The
/// first material's modulus itself cancels out: u is of that body, too.
fn nodal_stress(mesh: &TetMesh, materials: &CellMaterials, dof: &[[usize; 3]], u: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0_u32); mesh.points.len()];
    for (number, cell) in mesh.cells().enumerate() {
        let material = materials.of(number);
        let shear = material.youngs_modulus / (2.0 * (1.0 + material.poisson_ratio));
        let places = mesh.places(cell);
        let moved = std::array::from_fn(|a| {
            Vector3::from(dof[cell[a]].map(|dof| if dof == FIXED { 0.0 } else { u[dof] }))
        });
        for (node, gradient) in cell.iter().zip(curved::gradients_at_nodes(&places, &moved)) {
            let strain: Matrix3<f64> = gradient.symmetric_part();
            let deviator = strain - Matrix3::from_diagonal_element(strain.trace() / 3.0);
            // sqrt(3/2 s:s) with s = 2 G e
            let stress = 2.0 * shear * (1.5 * deviator.norm_squared()).sqrt();
            sums[*node].0 += stress;
            sums[*node].1 += 1;
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f64::from(count.max(1))).collect()
}

/// Edges between triangles that meet at an angle.
fn sharp_edges(points: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let at = |k: u32| Vector3::from(points[k as usize]);
    let mut sides: BTreeMap<[u32; 2], Vec<Vector3<f64>>> = BTreeMap::new();
    for [a, b, c] in triangles.iter().copied() {
        let normal = (at(b) - at(a)).cross(&(at(c) - at(a)));
        let normal = normal.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            sides.entry([from.min(to), from.max(to)]).or_default().push(normal);
        }
    }
    let is_sharp = |normals: &Vec<Vector3<f64>>| normals.len() != 2 || normals[0].dot(&normals[1]) < SHARP;
    sides.into_iter().filter(|(_, normals)| is_sharp(normals)).map(|(edge, _)| edge).collect()
}

#[cfg(test)]
mod tests {
    use super::super::mesh::boxes;
    use super::*;
    use crate::scene::Material;

    /// A block that is pressed on its whole face by a uniform strain has that stress everywhere; its edges are those of the box.
    #[test]
    fn a_box_has_twelve_edges_and_a_uniform_strain_one_stress() {
        let mesh = boxes([2.0, 1.0, 1.0], [2, 1, 1], 2, |p| p);
        let dof: Vec<[usize; 3]> = (0..mesh.points.len()).map(|n| [3 * n, 3 * n + 1, 3 * n + 2]).collect();
        let u: Vec<f64> = mesh.points.iter().flat_map(|p| [1e-3 * p.x, -3e-4 * p.y, -3e-4 * p.z]).collect();
        let steel = CellMaterials::one(Material::elastic("m", 1.0, 0.3, 1.0));
        // uniaxial: E = 1 Pa
        let stress = nodal_stress(&mesh, &steel, &dof, &u);
        assert!(stress.iter().all(|stress| (stress - 1e-3).abs() < 1e-15), "{stress:?}");
        let fixed: Vec<bool> = mesh.points.iter().map(|p| p.x == 0.0).collect();
        let at = SurfacePoint { point: Vector3::new(2.0, 0.5, 0.5), normal: Vector3::x() };
        let view = BodyView::new(
            &mesh,
            &steel,
            &fixed,
            &[StruckPoint { at, circles: [0.2, 0.3, 0.4], rubs: false }],
        )
        .unwrap();
        // the long edges consist of four pieces each, the short ones of two
        assert_eq!(view.edges.len(), 4 * 4 + 8 * 2);
        assert_eq!(view.triangles.len(), 4 * mesh.outer_faces().len());
        assert!(view.fixed.contains(&true) && view.modes[0].0 > 0.0);
    }
}
