//! A mesh moved onto the surfaces of another shape, as an elastic body would follow them.
//!
//! The corners of the outer faces are pulled onto their surfaces, along which they slide freely; all others follow elastically.
//! No element comes or goes: what is computed on the mesh changes smoothly with the shape.

use super::elasticity::SolidMatrices;
use super::factor::Factor;
use super::materials::CellMaterials;
use super::mesh::{EDGES, TetMesh, volume};
use super::surface::Surface;
use crate::error::{Error, Result};
use crate::scene::Material;
use nalgebra::{Matrix3, Vector3};

/// Poisson's ratio of the body that follows: elements change their volume rather than their angles.
const POISSON_RATIO: f64 = 0.0;
/// Stiffness with which a corner is pulled onto its surface, over the stiffest of the body's.
const PULL: f64 = 1e3;
/// Rounds, in each of which the directions of the pull are those of the place reached.
const ROUNDS: usize = 3;
/// Steps of Newton's method that bring a corner from where it is pulled to exactly onto its surfaces.
const STEPS: usize = 8;
/// Least quality of an element, and the least over that of the worst element before.
const LEAST_QUALITY: [f64; 2] = [0.02, 0.25];

impl TetMesh {
    /// This mesh with every corner on its `surfaces`, none for those inside; quadratic elements stay straight. Shape (nodes).
    ///
    /// # Errors
    /// [`Error::Solver`] if an element would become flat or much worse than the worst is.
    pub fn moved_onto(&self, surfaces: &[Vec<Surface>]) -> Result<Self> {
        let (corners, body) = self.corners_alone();
        let surfaces: Vec<&[Surface]> = corners.iter().map(|node| &surfaces[*node][..]).collect();
        let mut displaced = body.points.clone();
        let matrices = SolidMatrices::new(
            &body,
            &CellMaterials::one(Material::elastic("mesh", 1.0, POISSON_RATIO, 1.0)),
        );
        let pull = PULL * matrices.stiffest();
        for _ in 0..ROUNDS {
            let (mut pulled, mut load) = (matrices.clone(), vec![0.0; 3 * displaced.len()]);
            for (node, surfaces) in surfaces.iter().enumerate() {
                for surface in *surfaces {
                    let (distance, normal) = surface.distance(displaced[node]);
                    let missing = normal.dot(&(displaced[node] - body.points[node])) - distance;
                    pulled.stiffen(node, pull * normal * normal.transpose());
                    (0..3).for_each(|c| load[3 * node + c] += pull * missing * normal[c]);
                }
            }
            let numbers: Vec<[usize; 3]> =
                (0..displaced.len()).map(|n| [0, 1, 2].map(|c| 3 * n + c)).collect();
            Factor::new(&pulled.free_stiffness(&numbers, load.len()), &[])?.solve(&mut load);
            for (node, place) in displaced.iter_mut().enumerate() {
                *place = body.points[node] + Vector3::from_column_slice(&load[3 * node..][..3]);
            }
        }
        for (place, surfaces) in displaced.iter_mut().zip(&surfaces) {
            *place = onto(surfaces, *place);
        }
        let least = LEAST_QUALITY[0].max(LEAST_QUALITY[1] * body.worst_quality());
        let moved = TetMesh { points: displaced, ..body };
        let quality = moved.worst_quality();
        if quality < least {
            return Err(Error::Solver(format!(
                "the mesh can't follow the shape so far: the quality (mean ratio) of its worst element would be {quality:.3}, the least is {least:.3}"
            )));
        }
        Ok(self.with_corners(&corners, &moved.points))
    }

    /// Its corners and the linear mesh of them alone.
    fn corners_alone(&self) -> (Vec<usize>, Self) {
        let mut corners: Vec<usize> = self.cells().flat_map(|cell| cell[..4].iter().copied()).collect();
        corners.sort_unstable();
        corners.dedup();
        let mut number = vec![usize::MAX; self.points.len()];
        corners.iter().enumerate().for_each(|(k, node)| number[*node] = k);
        let cells = self.cells().flat_map(|cell| [0, 1, 2, 3].map(|a| number[cell[a]])).collect();
        let points = corners.iter().map(|node| self.points[*node]).collect();
        (corners, Self { points, cells, order: 1 })
    }

    /// This mesh with its `corners` at `places` and the midside nodes between them.
    fn with_corners(&self, corners: &[usize], places: &[Vector3<f64>]) -> Self {
        let mut moved = self.clone();
        corners.iter().zip(places).for_each(|(node, place)| moved.points[*node] = *place);
        for cell in self.cells() {
            for ([a, b], midside) in EDGES.iter().zip(&cell[4..]) {
                moved.points[*midside] = 0.5 * (moved.points[cell[*a]] + moved.points[cell[*b]]);
            }
        }
        moved
    }

    /// Least mean ratio of an element (1 = regular), 0 if one is flat or turned inside out.
    ///
    /// 12 (3 V)^(2/3) over the sum of the squares of the edges (Liu and Joe, BIT 34, 1994, 268).
    pub fn worst_quality(&self) -> f64 {
        let quality = |cell: &[usize]| {
            let corners = self.corners(cell);
            let squares = EDGES.map(|[a, b]| (corners[a] - corners[b]).norm_squared());
            12.0 * (3.0 * volume(&corners).max(0.0)).powf(2.0 / 3.0) / squares.iter().sum::<f64>()
        };
        self.cells().map(quality).fold(1.0, f64::min)
    }
}

/// The point on all `surfaces` that is next to `p`, by Newton's method with least steps.
fn onto(surfaces: &[Surface], mut p: Vector3<f64>) -> Vector3<f64> {
    for _ in 0..STEPS {
        let (mut gram, mut normals) = (Matrix3::identity(), [Vector3::zeros(); 3]);
        let mut distances = Vector3::zeros();
        for (i, surface) in independent(surfaces, p).into_iter().enumerate() {
            (distances[i], normals[i]) = surface.distance(p);
        }
        for (i, j) in [0, 1, 2].into_iter().flat_map(|i| [0, 1, 2].map(|j| (i, j))) {
            let product = normals[i].dot(&normals[j]);
            // where there is no surface its row stays that of the identity
            gram[(i, j)] = if i == j && product == 0.0 { 1.0 } else { product };
        }
        let Some(factors) = gram.try_inverse().map(|inverse| inverse * distances) else { break };
        p -= (0..3).map(|i| factors[i] * normals[i]).sum::<Vector3<f64>>();
    }
    p
}

/// At most three of the surfaces, none along the others at `p`.
fn independent(surfaces: &[Surface], p: Vector3<f64>) -> Vec<&Surface> {
    const ALONG: f64 = 1e-3;
    let (mut found, mut basis): (Vec<&Surface>, Vec<Vector3<f64>>) = (Vec::new(), Vec::new());
    for surface in surfaces {
        let mut rest = surface.distance(p).1;
        for known in &basis {
            rest -= rest.dot(known) * known;
        }
        if basis.len() < 3 && rest.norm() > ALONG {
            basis.push(rest.normalize());
            found.push(surface);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::super::mesh::boxes;
    use super::*;

    /// The planes of the box from 0 to `lengths`, its top leaning by `slope`, for each node of `mesh` those of its place in the unit cube.
    fn planes(mesh: &TetMesh, lengths: [f64; 3], slope: f64) -> Vec<Vec<Surface>> {
        let axis = |c: usize| Vector3::from_fn(|k, _| f64::from(u8::from(k == c)));
        let of = |p: &Vector3<f64>| {
            let mut planes = Vec::new();
            for c in 0..3 {
                if p[c] == 0.0 {
                    planes.push(Surface::Plane { point: Vector3::zeros(), normal: axis(c) });
                }
                if p[c] == 1.0 {
                    let normal = if c == 2 { Vector3::new(-slope, 0.0, 1.0).normalize() } else { axis(c) };
                    planes.push(Surface::Plane { point: lengths[c] * axis(c), normal });
                }
            }
            planes
        };
        mesh.points.iter().map(of).collect()
    }

    #[test]
    fn a_box_that_is_stretched_keeps_its_elements_even() {
        for order in [1, 2] {
            let mesh = boxes([1.0; 3], [4, 4, 4], order, |p| p);
            let moved = mesh.moved_onto(&planes(&mesh, [1.3, 0.9, 1.1], 0.0)).unwrap();
            for (before, after) in mesh.points.iter().zip(&moved.points) {
                let expected = Vector3::new(1.3 * before.x, 0.9 * before.y, 1.1 * before.z);
                assert!((after - expected).amax() < 1e-3, "{before:?} {after:?}");
            }
            let same = mesh.moved_onto(&planes(&mesh, [1.0; 3], 0.0)).unwrap();
            assert!(mesh.points.iter().zip(&same.points).all(|(a, b)| (a - b).amax() < 1e-12));
        }
    }

    #[test]
    fn corners_come_to_lie_on_a_leaning_top_and_edges_stay_straight() {
        let mesh = boxes([1.0; 3], [4, 4, 4], 2, |p| p);
        let planes = planes(&mesh, [1.0; 3], 0.4);
        let moved = mesh.moved_onto(&planes).unwrap();
        for (place, planes) in moved.points.iter().zip(&planes) {
            assert!(planes.iter().all(|plane| plane.distance(*place).0.abs() < 1e-14));
        }
        let volume_of = |mesh: &TetMesh| mesh.cells().map(|cell| volume(&mesh.corners(cell))).sum::<f64>();
        // the top leans about its edge at x = 0
        assert!((volume_of(&moved) - 1.2).abs() < 1e-12);
        TetMesh::new(moved.points, moved.cells, 2).expect("a sound mesh");
    }

    #[test]
    fn a_shape_too_far_away_is_refused() {
        let mesh = boxes([1.0; 3], [3, 3, 3], 1, |p| p);
        let message = mesh.moved_onto(&planes(&mesh, [1.0, 1.0, 0.01], 0.0)).unwrap_err().to_string();
        assert!(message.contains("can't follow"), "{message}");
    }
}
