//! The surfaces of a seat's body, and a mesh of one seat moved onto another's.
//!
//! A seat that differs in dimensions alone has the same faces and edges: its mesh is that of the first with every corner on the
//! surfaces as they are now. So results are smooth in the dimensions, where a new mesh would scatter.

use super::SealSeat;
use super::candidates::in_plane;
use crate::body::solid::{Surface, TetMesh};
use crate::error::{Error, Result};
use nalgebra::Vector3;

/// How far the corners of a face may lie from its surface, over the membrane's radius.
const ON_SURFACE: f64 = 1e-6;
/// Radius of what goes along with a tip, over the membrane's radius: some contact radii.
const AROUND_TIP: f64 = 0.1;

/// A surface, and where on it faces may lie; the others of the same plane belong to another one.
struct Side {
    surface: Surface,
    /// Half lengths in m along x and y of the rectangle about z's axis outside which none lies, if there is one.
    within: Option<[f64; 2]>,
}

impl Side {
    fn everywhere(surface: Surface) -> Self {
        Self { surface, within: None }
    }

    fn has(&self, corners: [Vector3<f64>; 3], close: f64) -> bool {
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let inside = |[x, y]: [f64; 2]| middle.x.abs() < x && middle.y.abs() < y;
        corners.iter().all(|p| self.surface.distance(*p).0.abs() < close) && self.within.is_none_or(inside)
    }
}

/// The plane across y.
fn aside(y: f64) -> Surface {
    Surface::Plane { point: Vector3::new(0.0, y, 0.0), normal: Vector3::y() }
}

/// The sides of the half body y >= 0, always in the same order.
fn sides(setup: &SealSeat) -> Vec<Side> {
    let (seat, ring) = (&setup.seat, setup.ring());
    let up = |z: f64| Surface::Plane { point: Vector3::new(0.0, 0.0, z), normal: Vector3::z() };
    let across = |x: f64| Surface::Plane { point: Vector3::new(x, 0.0, 0.0), normal: Vector3::x() };
    let rim = Surface::Cylinder { point: Vector3::zeros(), axis: Vector3::z(), radius: seat.membrane_radius };
    let (length, width) = (0.5 * seat.island_length, 0.5 * seat.island_width);
    let mut all = Vec::new();
    // the notch's floor first: it may be level with the membrane
    if let Some(notch) = &seat.notch {
        all.push(Side { surface: up(notch.floor), within: Some([0.5 * notch.width, width]) });
        all.extend([-0.5, 0.5].map(|side| Side::everywhere(across(side * notch.width))));
    }
    all.extend([up(0.0), up(seat.membrane_thickness), up(seat.island_height), rim].map(Side::everywhere));
    all.extend([across(-length), across(length), aside(width), aside(0.0)].map(Side::everywhere));
    for side in [1.0, -1.0] {
        let mirrored = |[x, z]: [f64; 2]| in_plane([side * x, z]);
        let (point, axis) = (mirrored(ring.sphere_centre), mirrored(ring.axis));
        let (radius, half_angle) = (setup.sphere.radius, 0.5 * seat.aperture_angle);
        all.extend([
            Side::everywhere(Surface::Cone { point, axis, radius, half_angle }),
            Side::everywhere(Surface::Cylinder { point, axis, radius: seat.bore_radius }),
            Side::everywhere(Surface::Plane { point: point - seat.bore_depth * axis, normal: axis }),
        ]);
    }
    all
}

/// Number of the side that is the underside.
fn underside(sides: &[Side]) -> Option<usize> {
    let level = Surface::Plane { point: Vector3::zeros(), normal: Vector3::z() };
    sides.iter().position(|side| side.surface == level)
}

/// The cone of the seat with the sphere, and the plane in which its ring lies.
fn ring(setup: &SealSeat, sides: &[Side]) -> Option<(usize, Surface)> {
    let ring = setup.ring();
    let cone = sides.iter().position(|side| matches!(side.surface, Surface::Cone { .. }))?;
    Some((cone, Surface::Plane { point: in_plane(ring.centre()), normal: in_plane(ring.axis) }))
}

/// Where the underside around a tip goes with it: the place of a point `p` that lies there, else `None`. A point alone would leave its
/// elements behind, and the tip would meet another pattern of nodes at every place.
fn with_tip(from: &SealSeat, to: &SealSeat, p: Vector3<f64>) -> Option<Vector3<f64>> {
    let tips = from.actuator.tip_positions.iter().zip(&to.actuator.tip_positions);
    let at = |x: f64| Vector3::new(x, 0.0, 0.0);
    let growth = to.seat.membrane_radius / from.seat.membrane_radius;
    let mut places = tips.map(|(x, there)| (p - at(*x), at(*there)));
    let (off, there) = places.find(|(off, _)| off.norm() < AROUND_TIP * from.seat.membrane_radius)?;
    Some(there + growth * off)
}

/// `mesh` of the seat of `from` as one of the seat of `to`.
///
/// # Errors
/// [`Error::Solver`] if one has a notch or tips that the other has not, `mesh` is none of `from`, or can't follow so far.
pub(super) fn moved(mesh: &TetMesh, from: &SealSeat, to: &SealSeat) -> Result<TetMesh> {
    let alike = from.seat.notch.is_some() == to.seat.notch.is_some()
        && from.actuator.tip_positions.len() == to.actuator.tip_positions.len();
    if !alike {
        return Err(Error::Solver("a mesh can't follow where a notch or a tip comes or goes".into()));
    }
    let close = ON_SURFACE * from.seat.membrane_radius;
    let (sides_from, sides_to) = (sides(from), sides(to));
    let mut of_node: Vec<Vec<usize>> = vec![Vec::new(); mesh.points.len()];
    for face in mesh.outer_faces() {
        let corners = [0, 1, 2].map(|k| mesh.points[face[k]]);
        let side = sides_from.iter().position(|side| side.has(corners, close)).ok_or_else(|| {
            let [x, y, z] = ((corners[0] + corners[1] + corners[2]) / 3.0).into();
            Error::Solver(format!(
                "the mesh has a face at ({x:e}, {y:e}, {z:e}) m that is on no side of the seat"
            ))
        })?;
        face[..3]
            .iter()
            .filter(|node| !of_node[**node].contains(&side))
            .copied()
            .collect::<Vec<_>>()
            .into_iter()
            .for_each(|node| of_node[node].push(side));
    }
    let mut surfaces: Vec<Vec<Surface>> =
        of_node.iter().map(|of| of.iter().map(|side| sides_to[*side].surface).collect()).collect();
    if let Some(((cone, was), (_, is))) = ring(from, &sides_from).zip(ring(to, &sides_to)) {
        for (node, p) in mesh.points.iter().enumerate() {
            if of_node[node].contains(&cone) && was.distance(*p).0.abs() < close {
                // the ring is more than the side it lies on
                surfaces[node].insert(0, is);
            }
        }
    }
    let below = underside(&sides_from);
    let symmetry = |side: usize| sides_from[side].surface == aside(0.0);
    for (node, p) in mesh.points.iter().enumerate() {
        let free = of_node[node].iter().all(|side| Some(*side) == below || symmetry(*side));
        let on_underside = below.is_some_and(|below| of_node[node].contains(&below));
        if let Some(point) = with_tip(from, to, *p).filter(|_| free && on_underside) {
            let across = |normal| Surface::Plane { point, normal };
            surfaces[node] = [Vector3::x(), Vector3::y(), Vector3::z()].map(across).to_vec();
        }
    }
    mesh.moved_onto(&surfaces)
}
