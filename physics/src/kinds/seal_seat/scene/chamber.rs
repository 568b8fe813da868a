//! The chamber that the sphere flies through, as the seat's shape makes it.

use super::SealSeat;
use crate::flight::{Chamber, TooNarrow, Vector};

impl SealSeat {
    /// The chamber above the seat: its two cones with bores, the island and the membrane around it, side walls at the membrane's rim
    /// and a ceiling at `height` m.
    ///
    /// # Errors
    /// As [`Chamber::new`].
    pub fn chamber(&self, height: f64) -> Result<Chamber, TooNarrow> {
        let left = left_half(self);
        let mirrored = |p: &Vector| Vector::new(-p.x, p.y);
        // an edge on the axis is one corner
        let right = left.iter().rev().filter(|p| p.x != 0.0).map(mirrored);
        let floor: Vec<Vector> = left.iter().copied().chain(right).collect();
        let [x, z] = self.ring().sphere_centre;
        Chamber::new(&floor, height, self.sphere.radius, [Vector::new(x, z), Vector::new(-x, z)])
    }
}

/// The corners of a seal seat's surface at x <= 0, from the rim inwards.
fn left_half(setup: &SealSeat) -> Vec<Vector> {
    let (seat, ring) = (&setup.seat, setup.ring());
    let centre = Vector::new(ring.sphere_centre[0], ring.sphere_centre[1]);
    let up = Vector::new(ring.axis[0], ring.axis[1]);
    let inwards = Vector::new(up.y, -up.x);
    let half = 0.5 * seat.aperture_angle;
    // the cone's tip, and its mouth into the bore
    let tip = centre - setup.sphere.radius / half.sin() * up;
    let mouth = tip + seat.bore_radius / half.tan() * up;
    let flanks = [-1.0, 1.0].map(|side| half.cos() * up + side * half.sin() * inwards);
    let side = -0.5 * seat.island_length;
    let mut corners = vec![
        Vector::new(-seat.membrane_radius, seat.membrane_thickness),
        Vector::new(side, seat.membrane_thickness),
        Vector::new(side, seat.island_height),
    ];
    let outer = mouth - seat.bore_radius * inwards;
    corners.push(outer + (seat.island_height - outer.y) / flanks[0].y * flanks[0]);
    let floor = centre - seat.bore_depth * up;
    let [left, right] = [-seat.bore_radius, seat.bore_radius].map(|side| side * inwards);
    corners.extend([outer, floor + left, floor + right, mouth + right]);
    // up the inner flank to the top, the notch or the other cone
    let inner = mouth + right;
    let notch = seat.notch.filter(|notch| {
        let reach = (-0.5 * notch.width - inner.x) / flanks[1].x;
        reach > 0.0 && inner.y + reach * flanks[1].y > notch.floor
    });
    let end = notch.map_or(0.0, |notch| -0.5 * notch.width);
    let reach = (end - inner.x) / flanks[1].x;
    let top = (seat.island_height - inner.y) / flanks[1].y;
    if flanks[1].y > 0.0 && top < reach {
        corners.push(inner + top * flanks[1]);
        corners.push(Vector::new(end, seat.island_height));
    } else {
        corners.push(Vector::new(end, inner.y + reach * flanks[1].y));
    }
    corners.extend(notch.map(|notch| Vector::new(end, notch.floor)));
    corners
}
