//! What the results of a seal-seat scene are called, and the views of them that the kind itself works with. All are those
//! of the whole bodies, whatever part a solver models.

use crate::result::{Curve, History, quantities};

quantities! {
    /// Results of a sphere's launch out of a seal seat (scene kind `seal-seat`), all determined.
    SeatQuantities {
        /// Kinetic energy of the sphere after the last contact over that of the actuator before the first.
        efficiency: f64, "1";
        /// Velocity of the sphere along x after the last contact, m/s.
        sphere_velocity_x: f64, "m/s", of sphere_velocity_x;
        /// Velocity of the sphere along z after the last contact, m/s.
        sphere_velocity_z: f64, "m/s", of sphere_velocity_z;
        /// Magnitude of the sphere's velocity, m/s.
        sphere_speed: f64, "m/s";
        /// Direction of the sphere's velocity against z, positive towards +x: atan2(vx, vz), rad.
        sphere_angle: f64, "rad";
        /// Largest magnitude of the resultant force between seat and sphere, N.
        sphere_force_peak: f64, "N", of sphere_force;
        /// Largest force between actuator and seat, all tips together, N.
        actuator_force_peak: f64, "N", of actuator_force;
        /// Velocity of the actuator after its last contact, m/s.
        actuator_velocity_final: f64, "m/s", of actuator_velocity;
        /// Time of the last release of the sphere, s.
        sphere_contact_end: f64, "s";
        /// Time of the last release of the actuator, s.
        actuator_contact_end: f64, "s";
        /// Normal impulse on the sphere from the seat's flank at the side of -x of the seat's axis, N s.
        left_flank_impulse: f64, "N*s";
        /// Normal impulse on the sphere from the seat's flank at the side of +x of the seat's axis, N s.
        right_flank_impulse: f64, "N*s";
        /// First eigenfrequency of the seat, Hz.
        first_frequency: f64, "Hz";
    }
}

/// The curves of a seal seat. Displacements are in m since t = 0, forces in N; the sphere's force is the resultant of what
/// the seat does to it, the actuator's positive in compression, all tips together.
pub static CURVES: [Curve; 10] = [
    Curve::new("sphere_displacement_x", "m"),
    Curve::new("sphere_displacement_z", "m"),
    Curve::new("sphere_velocity_x", "m/s"),
    Curve::new("sphere_velocity_z", "m/s"),
    Curve::new("sphere_force", "N"),
    Curve::new("sphere_force_x", "N"),
    Curve::new("sphere_force_z", "N"),
    Curve::new("actuator_displacement", "m"),
    Curve::new("actuator_velocity", "m/s"),
    Curve::new("actuator_force", "N"),
];

/// The curves of a seal seat; the sphere's vectors hold [x, z]. Shapes (samples).
#[derive(Debug, Clone, Copy)]
pub struct SeatCurves<'a> {
    /// Time in s since the first touch.
    pub time: &'a [f64],
    /// Displacement of the sphere's centre.
    pub sphere_displacement: [&'a [f64]; 2],
    /// Velocity of the sphere.
    pub sphere_velocity: [&'a [f64]; 2],
    /// Magnitude of the force between seat and sphere.
    pub sphere_force: &'a [f64],
    /// The force on the sphere.
    pub sphere_force_components: [&'a [f64]; 2],
    /// Displacement of the actuator.
    pub actuator_displacement: &'a [f64],
    /// Velocity of the actuator.
    pub actuator_velocity: &'a [f64],
    /// Force between actuator and seat.
    pub actuator_force: &'a [f64],
}

impl<'a> SeatCurves<'a> {
    /// The typed view of `history`; `None` if a curve is not there.
    pub fn of(history: &'a History) -> Option<Self> {
        let curve = |name| history.curve(name);
        Some(SeatCurves {
            time: &history.time,
            sphere_displacement: [curve("sphere_displacement_x")?, curve("sphere_displacement_z")?],
            sphere_velocity: [curve("sphere_velocity_x")?, curve("sphere_velocity_z")?],
            sphere_force: curve("sphere_force")?,
            sphere_force_components: [curve("sphere_force_x")?, curve("sphere_force_z")?],
            actuator_displacement: curve("actuator_displacement")?,
            actuator_velocity: curve("actuator_velocity")?,
            actuator_force: curve("actuator_force")?,
        })
    }
}
