//! Structured quadrilateral meshes of the upper half (z >= 0) of a body of revolution.
//!
//! Every body here is its own mirror image in the plane z = 0; see [`super::mirror`] for how
//! the half stands for the whole.

use super::basis::Basis;
use super::grading::Grading;
use std::collections::HashMap;

/// Mesh of the half meridian section. Coordinates are (r, z) in m.
#[derive(Debug, Clone)]
pub(super) struct Mesh {
    /// Polynomial order p of the elements.
    pub order: usize,
    /// Node coordinates (r, z), exactly 0 on the axis and on the mirror plane. Shape (n, 2).
    pub nodes: Vec<[f64; 2]>,
    /// Nodes of each element, (p + 1)^2 each, ordered as in [`super::basis::QuadraturePoint`].
    pub elements: Vec<Vec<usize>>,
    /// Nodes of each element edge on the loaded surface, p + 1 each, r ascending, from the axis outwards.
    pub surface: Vec<Vec<usize>>,
    /// Largest radius r of any node, m.
    pub radius: f64,
}

/// Logically rectangular part of a mesh.
struct MeshBlock<'a> {
    /// Breakpoints of the elements in the first direction, in [0, 1].
    s: &'a [f64],
    /// Breakpoints of the elements in the second direction, in [0, 1].
    t: &'a [f64],
    /// Position (r, z) in m of the logical point (s, t).
    map: &'a dyn Fn(f64, f64) -> [f64; 2],
}

/// Node numbers of a block; entry (i, j) has the index `i * columns + j`.
struct NodeGrid {
    columns: usize,
    nodes: Vec<usize>,
}

impl NodeGrid {
    fn at(&self, i: usize, j: usize) -> usize {
        self.nodes[i * self.columns + j]
    }
}

impl Mesh {
    fn empty(order: usize, radius: f64) -> Self {
        Self { order, nodes: Vec::new(), elements: Vec::new(), surface: Vec::new(), radius }
    }

    /// Adds a block whose nodes are new, except those in `shared` (by position (i, j) in the block).
    fn add(&mut self, block: &MeshBlock, shared: &HashMap<(usize, usize), usize>) -> NodeGrid {
        let p = self.order;
        let basis = Basis::new(p);
        let fine = |breakpoints: &[f64]| -> Vec<f64> {
            let mut all = vec![breakpoints[0]];
            for pair in breakpoints.windows(2) {
                let inner =
                    basis.nodes[1..p].iter().map(|x| 0.5 * ((1.0 - x) * pair[0] + (1.0 + x) * pair[1]));
                all.extend(inner);
                all.push(pair[1]);
            }
            all
        };
        let (s, t) = (fine(block.s), fine(block.t));
        let mut grid = NodeGrid { columns: t.len(), nodes: Vec::with_capacity(s.len() * t.len()) };
        for (i, &s) in s.iter().enumerate() {
            for (j, &t) in t.iter().enumerate() {
                let node = *shared.get(&(i, j)).unwrap_or(&self.nodes.len());
                if node == self.nodes.len() {
                    // Symmetry planes must be met exactly: constraints are found by comparing with 0.
                    let snap = |x: f64| {
                        if x.abs() < 1e-12 * self.radius { 0.0 } else { x }
                    };
                    self.nodes.push((block.map)(s, t).map(snap));
                }
                grid.nodes.push(node);
            }
        }
        for i in (0..s.len() - 1).step_by(p) {
            for j in (0..t.len() - 1).step_by(p) {
                let node = |k: usize| grid.at(i + k / (p + 1), j + k % (p + 1));
                self.elements.push((0..(p + 1) * (p + 1)).map(node).collect());
            }
        }
        grid
    }
}

/// Upper half of a plate: 0 <= r <= `radius`, 0 <= z <= `half_thickness`.
///
/// `radial` are the breakpoints from the axis outwards, `depth` those from the face to the
/// mid-plane, both in m from 0 to the full length.
pub(super) fn plate(order: usize, radial: &[f64], depth: &[f64]) -> Mesh {
    let (radius, half_thickness) = (radial[radial.len() - 1], depth[depth.len() - 1]);
    let s: Vec<f64> = radial.iter().map(|r| r / radius).collect();
    let t: Vec<f64> = depth.iter().rev().map(|d| 1.0 - d / half_thickness).collect();
    let mut mesh = Mesh::empty(order, radius);
    let map = |s: f64, t: f64| [s * radius, t * half_thickness];
    let grid = mesh.add(&MeshBlock { s: &s, t: &t, map: &map }, &HashMap::new());
    let top = grid.columns - 1;
    for element in 0..radial.len() - 1 {
        let edge = (0..=order).map(|k| grid.at(element * order + k, top)).collect();
        mesh.surface.push(edge);
    }
    mesh
}

/// Upper half of a sphere about the origin, graded towards the pole (0, `radius`).
///
/// Three blocks meet at (r, z) = (radius/2, radius/2): one at the pole (first direction: depth),
/// one at the centre, one at the equator.
pub(super) fn half_sphere(
    order: usize,
    radius: f64,
    patch_radius: f64,
    patch_size: f64,
    growth: f64,
    largest: f64,
) -> Mesh {
    use std::f64::consts::FRAC_PI_4;
    let grading = |start: f64| Grading { start, end: f64::INFINITY, largest, growth };
    let normalised = |points: Vec<f64>| -> Vec<f64> {
        let length = points[points.len() - 1];
        points.iter().map(|x| x / length).collect()
    };
    let spoke = 0.5 * radius;
    let depth = grading(patch_size).breakpoints(spoke);
    let last = depth[depth.len() - 1] - depth[depth.len() - 2];
    let core = normalised(grading(last).breakpoints(spoke));
    let depth = normalised(depth);
    let lateral = normalised(patch_then_graded(
        radius * (patch_radius / radius).asin(),
        radius * FRAC_PI_4,
        patch_size,
        grading,
    ));

    let arc = |angle: f64| [radius * angle.sin(), radius * angle.cos()];
    let line = |a: [f64; 2], b: [f64; 2], x: f64| [(1.0 - x) * a[0] + x * b[0], (1.0 - x) * a[1] + x * b[1]];
    let centre_edge = [0.0, spoke]; // on the axis
    let middle = [spoke, spoke];
    let equator_edge = [spoke, 0.0];
    // Ruled between an arc (s = 0) and a straight edge (s = 1): straight lines of constant t.
    let pole_map = |s: f64, t: f64| line(arc(t * FRAC_PI_4), line(centre_edge, middle, t), s);
    let core_map = |s: f64, t: f64| [t * spoke, (1.0 - s) * spoke];
    let equator_map = |s: f64, t: f64| line(arc((1.0 + t) * FRAC_PI_4), line(middle, equator_edge, t), s);

    let mut mesh = Mesh::empty(order, radius);
    let (rows, columns) = ((depth.len() - 1) * order, (lateral.len() - 1) * order);
    let core_rows = (core.len() - 1) * order;
    let pole = mesh.add(&MeshBlock { s: &depth, t: &lateral, map: &pole_map }, &HashMap::new());
    let shared = (0..=columns).map(|j| ((0, j), pole.at(rows, j))).collect();
    let centre = mesh.add(&MeshBlock { s: &core, t: &lateral, map: &core_map }, &shared);
    let mut shared: HashMap<_, _> = (0..=rows).map(|i| ((i, 0), pole.at(i, columns))).collect();
    shared.extend((0..=core_rows).map(|k| ((rows, k), centre.at(k, columns))));
    mesh.add(&MeshBlock { s: &depth, t: &core, map: &equator_map }, &shared);
    for element in 0..lateral.len() - 1 {
        mesh.surface.push((0..=order).map(|k| pole.at(0, element * order + k)).collect());
    }
    mesh
}

/// Breakpoints from 0 to `length`: elements of `size` up to exactly `patch`, graded from there on.
pub(super) fn patch_then_graded(
    patch: f64,
    length: f64,
    size: f64,
    grading: impl Fn(f64) -> Grading,
) -> Vec<f64> {
    let inner = ((patch / size).round() as usize).max(1);
    let mut points: Vec<f64> = (0..inner).map(|i| patch * i as f64 / inner as f64).collect();
    points.extend(grading(patch / inner as f64).breakpoints(length - patch).iter().map(|x| patch + x));
    let last = points.len() - 1;
    points[last] = length;
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sphere_nodes_are_distinct_inside_and_the_surface_is_on_the_sphere() {
        for order in [2, 3, 4] {
            let mesh = half_sphere(order, 2.0, 0.1, 0.03, 1.3, 0.5);
            let mut sorted = mesh.nodes.clone();
            sorted.sort_by(|a, b| a.partial_cmp(b).unwrap());
            for pair in sorted.windows(2) {
                let distance = (pair[0][0] - pair[1][0]).hypot(pair[0][1] - pair[1][1]);
                assert!(distance > 1e-6, "{pair:?}");
            }
            assert!(mesh.nodes.iter().all(|n| n[0].hypot(n[1]) < 2.0 + 1e-12));
            for edge in &mesh.surface {
                for &node in edge {
                    let [r, z] = mesh.nodes[node];
                    assert!((r.hypot(z) - 2.0).abs() < 1e-12);
                }
            }
        }
    }
}
