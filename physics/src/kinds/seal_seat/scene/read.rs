//! From the checked values of a seal-seat scene to its types.

use super::{Actuator, Notch, SealSeat, Seat, SeatedSphere};
use crate::Result;
use crate::scene::material::material;
use crate::scene::values::Node;
use crate::scene::{Geometry, ReferenceSettings, Shape};

/// Seat, sphere, actuator and the intended direction.
pub(super) fn seal_seat(root: &Node, materials: &Node) -> Result<SealSeat> {
    let (seat, sphere, actuator) = (root.table("seat")?, root.table("sphere")?, root.table("actuator")?);
    let notch = seat.has("notch_width").then(|| -> Result<Notch> {
        Ok(Notch { width: seat.number("notch_width")?, floor: seat.number("notch_floor")? })
    });
    let (radius, steel) = (sphere.number("radius")?, material(materials, sphere.text("material")?)?);
    let full = Shape::Sphere { radius }.mass(&steel);
    Ok(SealSeat {
        seat: Seat {
            material: material(materials, seat.text("material")?)?,
            membrane_radius: seat.number("membrane_radius")?,
            membrane_thickness: seat.number("membrane_thickness")?,
            island_length: seat.number("island_length")?,
            island_width: seat.number("island_width")?,
            island_height: seat.number("island_height")?,
            seat_distance: seat.number("seat_distance")?,
            seated_height: seat.number("seated_height")?,
            tilt: seat.number("tilt")?,
            aperture_angle: seat.number("aperture_angle")?,
            bore_radius: seat.number("bore_radius")?,
            bore_depth: seat.number("bore_depth")?,
            notch: notch.transpose()?,
        },
        sphere: SeatedSphere {
            radius,
            mass: sphere.optional_number("mass")?.unwrap_or(full),
            material: steel,
            body: sphere.word("body")?,
        },
        actuator: Actuator {
            mass: actuator.number("mass")?,
            speed: actuator.number("speed")?,
            tip_radius: actuator.number("tip_radius")?,
            tip_positions: actuator.numbers("tip_positions")?,
        },
        friction: root.number("friction")?,
        intended_angle: root.table("intended")?.number("angle")?,
    })
}

/// Settings of the reference of a seal seat.
pub(super) fn reference(settings: &Node) -> Result<ReferenceSettings> {
    Ok(ReferenceSettings {
        elements_per_ring_radius: Some(settings.number("elements_per_ring_radius")?),
        element_order: settings.optional_count("element_order")?,
        ..ReferenceSettings::of(Geometry::Solid)
    })
}
