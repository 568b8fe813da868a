//! The surfaces of a seat's body, and a mesh of one seat moved onto another's.
//!
//! A seat that differs in dimensions alone has the same faces and edges: its mesh is that of the first with every corner on the
//! surfaces as they are now. So results are smooth in the dimensions, where a new mesh would scatter.

use super::candidates::in_plane;
use crate::body::solid::{Surface, TetMesh};
use crate::error::{Error, Result};
use crate::scene::SealSeat;
use nalgebra::Vector3;

/// How far the corners of a face may lie from its surface, over the membrane's radius.
const ON_SURFACE: f64 = 1e-6;

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

/// The sides of the half body y >= 0, always in the same order.
fn sides(setup: &SealSeat) -> Vec<Side> {
    let (seat, ring) = (&setup.seat, setup.ring());
    let up = |z: f64| Surface::Plane { point: Vector3::new(0.0, 0.0, z), normal: Vector3::z() };
    let across = |x: f64| Surface::Plane { point: Vector3::new(x, 0.0, 0.0), normal: Vector3::x() };
    let aside = |y: f64| Surface::Plane { point: Vector3::new(0.0, y, 0.0), normal: Vector3::y() };
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

/// The points of the mesh that stay what they are: planes that meet in each, and along the ring the plane across the axis.
fn marks(setup: &SealSeat) -> Vec<(Option<usize>, Vec<Surface>)> {
    let ring = setup.ring();
    let axis = in_plane(ring.axis);
    let tip = |x: &f64| {
        let point = Vector3::new(*x, 0.0, 0.0);
        (
            None,
            [Vector3::x(), Vector3::y(), Vector3::z()]
                .map(|normal| Surface::Plane { point, normal })
                .to_vec(),
        )
    };
    let cone = sides(setup).iter().position(|side| matches!(side.surface, Surface::Cone { .. }));
    let plane = Surface::Plane { point: in_plane(ring.centre()), normal: axis };
    std::iter::once((cone, vec![plane])).chain(setup.actuator.tip_positions.iter().map(tip)).collect()
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
    for ((side, at), (_, wanted)) in marks(from).iter().zip(marks(to)) {
        let is_there = |p: &Vector3<f64>| at.iter().all(|surface| surface.distance(*p).0.abs() < close);
        for (node, p) in mesh.points.iter().enumerate() {
            if is_there(p)
                && side.is_none_or(|side| of_node[node].contains(&side))
                && !of_node[node].is_empty()
            {
                // a mark fixes more than the sides it lies on
                surfaces[node].splice(0..0, wanted.iter().copied());
            }
        }
    }
    mesh.moved_onto(&surfaces)
}
