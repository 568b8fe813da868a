//! From the checked values of a seal-seat scene to its types.

use super::keys::DEFAULT_RING_ELEMENTS;
use super::{Actuator, Notch, SealSeat, Seat, SeatedSphere, SphereBody};
use crate::Result;
use crate::scene::material::material;
use crate::scene::values::{Checked, Values};
use crate::scene::values::{Node, element_order};
use crate::scene::{Geometry, ReferenceSettings, Shape};

/// Seat, sphere, actuator and the intended direction.
pub(super) fn seal_seat(root: &Node, materials: &Node) -> Result<SealSeat> {
    let (seat, sphere, actuator) = (root.table("seat")?, root.table("sphere")?, root.table("actuator")?);
    let notch = seat.0.contains_key("notch_width").then(|| -> Result<Notch> {
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
            mass: sphere.number_or("mass", full)?,
            material: steel,
            body: match sphere.0.get("body") {
                Some(Checked::Text(word)) if word == "elastic" => SphereBody::Elastic,
                _ => SphereBody::Rigid,
            },
        },
        actuator: Actuator {
            mass: actuator.number("mass")?,
            speed: actuator.number("speed")?,
            tip_radius: actuator.number("tip_radius")?,
            tip_positions: actuator.numbers("tip_positions")?,
        },
        friction: root.number_or("friction", 0.0)?,
        intended_angle: root.table("intended")?.number("angle")?,
    })
}

/// Settings of the reference of a seal seat.
pub(super) fn reference(settings: Option<Node>) -> Result<ReferenceSettings> {
    let empty = Values::new();
    let settings = settings.unwrap_or(Node(&empty));
    Ok(ReferenceSettings {
        elements_per_ring_radius: Some(
            settings.number_or("elements_per_ring_radius", DEFAULT_RING_ELEMENTS)?,
        ),
        element_order: element_order(&settings),
        ..ReferenceSettings::of(Geometry::Solid)
    })
}
