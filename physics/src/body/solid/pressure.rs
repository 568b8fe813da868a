//! Hertz's pressure over circles on the surface of a mesh: what other bodies press on, and where they see it move.

use super::mesh::TetMesh;
use nalgebra::Vector3;
use std::collections::HashSet;

/// Parts of a circle's radius that the pieces of a face are smaller than, over which the pressure is summed.
const PIECES: f64 = 24.0;
/// Least cosine between the normals of the circle and of a face that it lies on.
const FACING: f64 = 0.3;

/// Sine of the angle between normal and x axis below which the normal counts as x.
const ACROSS: f64 = 1e-3;

/// Place and outward normal of length 1 at which another body presses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePoint {
    /// In m.
    pub point: Vector3<f64>,
    /// Of length 1.
    pub normal: Vector3<f64>,
}

impl SurfacePoint {
    /// The direction along the surface nearest to +x; to +y where the normal is x. Of length 1.
    pub fn along(&self) -> Vector3<f64> {
        let within = |axis: Vector3<f64>| axis - self.normal * self.normal.dot(&axis);
        let along = within(Vector3::x());
        if along.norm() > ACROSS { along.normalize() } else { within(Vector3::y()).normalize() }
    }

    /// The direction along the surface at a right angle to [`Self::along`]. Of length 1.
    pub fn aside(&self) -> Vector3<f64> {
        self.normal.cross(&self.along())
    }
}

/// A unit force along the normal, spread as 3/(2 pi b^2) sqrt(1 - (r/b)^2) over a circle of the radius b (Johnson, Contact Mechanics, 1985,
/// section 3.4), in terms of the nodes: forces, and the weights of their displacements along the normal.
#[derive(Debug, Clone)]
pub(super) struct HertzLoad {
    /// Node and share.
    pub nodes: Vec<(usize, f64)>,
    /// Share of the pressure that lies on the surface, 1 where the circle does not leave it.
    pub coverage: f64,
}

/// The surface of a mesh around a at.
#[derive(Debug)]
pub(super) struct SurfaceAround {
    at: SurfacePoint,
    /// Nodes of the triangles, corners first, and their places.
    triangles: Vec<([usize; 6], [Vector3<f64>; 6])>,
}

impl SurfaceAround {
    /// The part of the surface of `mesh`, whose elements are quadratic, that faces as `at` does and is joined to it within `reach` m.
    pub fn around(mesh: &TetMesh, at: SurfacePoint, reach: f64) -> Self {
        let all = mesh.outer_faces().into_iter().filter_map(|face| <[usize; 6]>::try_from(face).ok());
        let near = all.map(|nodes| (nodes, nodes.map(|node| mesh.points[node]))).filter(|(_, places)| {
            let [a, b, c] = [0, 1, 2].map(|k| places[k]);
            let normal = (b - a).cross(&(c - a));
            let size = (b - a).norm().max((c - a).norm());
            let far = places.iter().map(|p| (p - at.point).norm()).fold(f64::INFINITY, f64::min);
            normal.dot(&at.normal) > FACING * normal.norm() && far < reach + size
        });
        let mut triangles: Vec<([usize; 6], [Vector3<f64>; 6])> = near.collect();
        let nearest = |places: &[Vector3<f64>; 6]| {
            places.iter().map(|p| (p - at.point).norm_squared()).fold(f64::INFINITY, f64::min)
        };
        // from the nearest on, what shares nodes: a step of the surface facing likewise is not joined
        triangles.sort_by(|(_, a), (_, b)| nearest(a).total_cmp(&nearest(b)));
        let mut joined: HashSet<usize> =
            triangles.first().into_iter().flat_map(|(nodes, _)| *nodes).collect();
        loop {
            let before = joined.len();
            for (nodes, _) in &triangles {
                if nodes[..3].iter().any(|node| joined.contains(node)) {
                    joined.extend(nodes);
                }
            }
            if joined.len() == before {
                break;
            }
        }
        triangles.retain(|(nodes, _)| joined.contains(&nodes[0]));
        Self { at, triangles }
    }

    /// A unit force over the circle of the `radius` in m.
    pub fn pressed(&self, radius: f64) -> HertzLoad {
        let mut nodes: Vec<(usize, f64)> = Vec::new();
        for (numbers, places) in &self.triangles {
            let edge = [(0, 1), (1, 2), (2, 0)]
                .map(|(a, b)| (places[a] - places[b]).norm())
                .into_iter()
                .fold(0.0, f64::max);
            let nearest = places.iter().map(|place| self.across(*place)).fold(f64::INFINITY, f64::min);
            if nearest > radius + edge {
                continue;
            }
            let pieces = (PIECES * edge / radius).ceil().clamp(2.0, 200.0) as usize;
            let shares = self.shares(places, radius, pieces);
            nodes.extend(numbers.iter().copied().zip(shares));
        }
        nodes.sort_unstable_by_key(|(node, _)| *node);
        nodes.dedup_by(|(node, share), (first, sum)| {
            let same = node == first;
            if same {
                *sum += *share;
            }
            same
        });
        let coverage: f64 = nodes.iter().map(|(_, share)| share).sum();
        nodes.iter_mut().for_each(|(_, share)| *share /= coverage);
        HertzLoad { nodes, coverage }
    }

    /// Distance in m of `place` from the at across the normal.
    fn across(&self, place: Vector3<f64>) -> f64 {
        let from = place - self.at.point;
        (from - from.dot(&self.at.normal) * self.at.normal).norm()
    }

    /// The shares of a triangle's nodes in the force, over `pieces` * `pieces` equal parts of it.
    fn shares(&self, places: &[Vector3<f64>; 6], radius: f64, pieces: usize) -> [f64; 6] {
        let mut shares = [0.0; 6];
        let step = 1.0 / pieces as f64;
        let mut add = |x: f64, y: f64| {
            let (values, along) = triangle(x, y);
            let sum = |weights: [f64; 6]| -> Vector3<f64> {
                places.iter().zip(weights).map(|(place, weight)| weight * place).sum()
            };
            let share = self.across(sum(values)) / radius;
            if share >= 1.0 {
                return;
            }
            let area = sum(along[0]).cross(&sum(along[1])).dot(&self.at.normal) * 0.5 * step * step;
            let pressure = 1.5 / (std::f64::consts::PI * radius * radius) * (1.0 - share * share).sqrt();
            for (own, value) in shares.iter_mut().zip(values) {
                *own += pressure * area * value;
            }
        };
        let third = 1.0 / 3.0;
        for i in 0..pieces {
            for j in 0..pieces - i {
                let [x, y] = [i as f64, j as f64];
                add((x + third) * step, (y + third) * step);
                if i + j + 1 < pieces {
                    add((x + 2.0 * third) * step, (y + 2.0 * third) * step);
                }
            }
        }
        shares
    }
}

/// Shape functions of a quadratic triangle at x, y of its second and third corner, and their derivatives by both.
fn triangle(x: f64, y: f64) -> ([f64; 6], [[f64; 6]; 2]) {
    let l = [1.0 - x - y, x, y];
    let values = [
        l[0] * (2.0 * l[0] - 1.0),
        l[1] * (2.0 * l[1] - 1.0),
        l[2] * (2.0 * l[2] - 1.0),
        4.0 * l[0] * l[1],
        4.0 * l[1] * l[2],
        4.0 * l[2] * l[0],
    ];
    let own = |k: usize| 4.0 * l[k] - 1.0;
    let by_x = [-own(0), own(1), 0.0, 4.0 * (l[0] - l[1]), 4.0 * l[2], -4.0 * l[2]];
    let by_y = [-own(0), 0.0, own(2), -4.0 * l[1], 4.0 * l[1], 4.0 * (l[0] - l[2])];
    (values, [by_x, by_y])
}

#[cfg(test)]
mod tests {
    use super::super::mesh::boxes;
    use super::*;
    use approx::assert_relative_eq;

    /// Force and moments of the pressure: mean of r^2 is 2/5 b^2 (Johnson), whatever the mesh.
    #[test]
    fn a_unit_force_has_hertzs_moments() {
        let mesh = boxes([1.0, 1.0, 0.3], [7, 6, 2], 2, |p| p);
        let at = SurfacePoint { point: Vector3::new(0.47, 0.52, 0.3), normal: Vector3::z() };
        let face = SurfaceAround::around(&mesh, at, 0.4);
        for radius in [0.13, 0.25, 0.4] {
            let pressed = face.pressed(radius);
            assert_relative_eq!(pressed.coverage, 1.0, max_relative = 2e-3);
            let mean = |of: &dyn Fn(Vector3<f64>) -> f64| -> f64 {
                pressed.nodes.iter().map(|(node, share)| share * of(mesh.points[*node])).sum()
            };
            assert_relative_eq!(mean(&|p| p.z), 0.3, max_relative = 1e-12);
            assert_relative_eq!(mean(&|p| p.x), 0.47, max_relative = 1e-3);
            // quadratic shape functions carry squares exactly
            let square = mean(&|p| (p.x - 0.47).powi(2) + (p.y - 0.52).powi(2));
            assert_relative_eq!(square, 0.4 * radius * radius, max_relative = 3e-3);
        }
        let edge = SurfacePoint { point: Vector3::new(0.0, 0.5, 0.3), normal: Vector3::z() };
        assert_relative_eq!(
            SurfaceAround::around(&mesh, edge, 0.2).pressed(0.2).coverage,
            0.5,
            max_relative = 5e-3
        );
    }
}
