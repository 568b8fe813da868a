//! The group of the validation base that a seal seat belongs to, and its numbers.

use impactcheck_physics::kinds::seal_seat::{SealSeat, SphereBody};

/// The group of `setup`, as `validation/draw.py` names it.
///
/// # Errors
/// A sentence of a seat that the base has none like.
pub(super) fn stratum(setup: &SealSeat) -> Result<&'static str, String> {
    let relaxes = !setup.seat.material.relaxation.is_empty();
    if setup.friction > 0.0 || relaxes || setup.sphere.body == SphereBody::Elastic {
        return Err("the validation base has elastic seats without friction under rigid spheres only".into());
    }
    Ok("seat")
}

/// Numbers of `setup` that were drawn for the base.
pub(super) fn numbers(setup: &SealSeat) -> Vec<(&'static str, f64)> {
    let (seat, sphere, actuator) = (&setup.seat, &setup.sphere, &setup.actuator);
    let wave = (seat.material.youngs_modulus / seat.material.density).sqrt();
    let outermost = actuator.tip_positions.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let notch = seat.notch.as_ref().map_or(0.0, |notch| notch.width);
    vec![
        ("thickness over radius of the membrane", seat.membrane_thickness / seat.membrane_radius),
        ("radius of the sphere over the membrane's thickness", sphere.radius / seat.membrane_thickness),
        ("distance of the seats over the sphere's diameter", 0.5 * seat.seat_distance / sphere.radius),
        ("tilt of the seats", seat.tilt),
        ("aperture angle of the cones", seat.aperture_angle),
        ("width of the notch over the distance of the seats", notch / seat.seat_distance),
        ("mass of the actuator over the sphere's", actuator.mass / sphere.mass),
        ("speed of the actuator over that of waves in the seat", actuator.speed / wave),
        ("radius of the tips over the sphere's", actuator.tip_radius / sphere.radius),
        ("outermost tip over half of the island's length", 2.0 * outermost / seat.island_length),
    ]
}
