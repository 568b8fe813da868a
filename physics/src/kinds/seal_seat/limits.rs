//! How near a launch comes to the bounds of the theories behind its model and its reference: under the actuator's tips and
//! in the membrane. The ring, where the sphere lies in the cone, is no Hertz contact.

use super::SealSeat;
use super::SeatCurves;
use crate::contact::Hertz;
use crate::result::limit::{self, QUASI_STATIC, SMALL_DEFLECTION};
use crate::result::{History, Summary};

/// Adds limits to the `summary` of model or reference; without `history` the deflection is not known.
pub(super) fn judge(scene: &SealSeat, summary: &mut Summary, history: Option<&History>) {
    let (seat, actuator) = (&scene.seat, &scene.actuator);
    let stiffness = 4.0 / 3.0 * seat.material.plane_strain_modulus() * actuator.tip_radius.sqrt();
    let law = Hertz { stiffness, tip_radius: actuator.tip_radius };
    let peak = summary.value("actuator_force_peak").map(|force| force / actuator.tip_positions.len() as f64);
    let mut limits: Vec<_> = peak
        .into_iter()
        .flat_map(|force| limit::of_contact("actuator", &law, force, &[&seat.material]))
        .collect();
    let deflection = history.and_then(SeatCurves::of).and_then(|curves| deflection(&curves));
    limits.extend(deflection.map(|w| SMALL_DEFLECTION.at("membrane", w / seat.membrane_thickness)));
    limits.push(QUASI_STATIC.at("actuator", actuator.speed / seat.material.bar_wave_speed()));
    summary.set_limits(limits);
}

/// How far in m the actuator pushes the seat: its largest displacement in contact, the tip's indentation included.
fn deflection(curves: &SeatCurves) -> Option<f64> {
    let pushed =
        curves.actuator_displacement.iter().zip(curves.actuator_force).filter(|(_, force)| **force > 0.0);
    pushed.map(|(displacement, _)| displacement.abs()).reduce(f64::max)
}
