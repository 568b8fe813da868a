//! The result of a seal-seat scene: its quantities and its course over time, the same types for reduced model and
//! reference. All are those of the whole bodies, whatever part a solver models.

use super::history::Curves;
use super::summary::{Quantities, Summary};
use serde::{Deserialize, Serialize};

/// Results of a sphere's launch out of a seal seat (scene kind `seal-seat`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeatQuantities {
    /// Kinetic energy of the sphere after the last contact over that of the actuator before the first.
    pub efficiency: f64,
    /// Velocity of the sphere along x after the last contact, m/s.
    pub sphere_velocity_x: f64,
    /// Velocity of the sphere along z after the last contact, m/s.
    pub sphere_velocity_z: f64,
    /// Magnitude of the sphere's velocity, m/s.
    pub sphere_speed: f64,
    /// Direction of the sphere's velocity against z, positive towards +x: atan2(vx, vz), rad.
    pub sphere_angle: f64,
    /// Largest magnitude of the resultant force between seat and sphere, N.
    pub sphere_force_peak: f64,
    /// Largest force between actuator and seat, all tips together, N.
    pub actuator_force_peak: f64,
    /// Velocity of the actuator after its last contact, m/s.
    pub actuator_velocity_final: f64,
    /// Time of the last release of the sphere, s.
    pub sphere_contact_end: f64,
    /// Time of the last release of the actuator, s.
    pub actuator_contact_end: f64,
    /// Normal impulse on the sphere from the seat's flank at the side of -x of the seat's axis, N s.
    pub left_flank_impulse: f64,
    /// Normal impulse on the sphere from the seat's flank at the side of +x of the seat's axis, N s.
    pub right_flank_impulse: f64,
    /// First eigenfrequency of the seat, Hz.
    pub first_frequency: f64,
}

/// The quantities of [`SeatQuantities`] that are compared, with their units.
pub const SEAT_QUANTITIES: [(&str, &str); 13] = [
    ("efficiency", "1"),
    ("sphere_velocity_x", "m/s"),
    ("sphere_velocity_z", "m/s"),
    ("sphere_speed", "m/s"),
    ("sphere_angle", "rad"),
    ("sphere_force_peak", "N"),
    ("actuator_force_peak", "N"),
    ("actuator_velocity_final", "m/s"),
    ("sphere_contact_end", "s"),
    ("actuator_contact_end", "s"),
    ("left_flank_impulse", "N*s"),
    ("right_flank_impulse", "N*s"),
    ("first_frequency", "Hz"),
];

impl Quantities for SeatQuantities {
    type History = SeatHistory;
    const NAMES: &'static [(&'static str, &'static str)] = &SEAT_QUANTITIES;

    fn last_contact(&self) -> f64 {
        self.sphere_contact_end.max(self.actuator_contact_end)
    }

    fn value(&self, name: &str) -> Option<f64> {
        Some(match name {
            "efficiency" => self.efficiency,
            "sphere_velocity_x" => self.sphere_velocity_x,
            "sphere_velocity_z" => self.sphere_velocity_z,
            "sphere_speed" => self.sphere_speed,
            "sphere_angle" => self.sphere_angle,
            "sphere_force_peak" => self.sphere_force_peak,
            "actuator_force_peak" => self.actuator_force_peak,
            "actuator_velocity_final" => self.actuator_velocity_final,
            "sphere_contact_end" => self.sphere_contact_end,
            "actuator_contact_end" => self.actuator_contact_end,
            "left_flank_impulse" => self.left_flank_impulse,
            "right_flank_impulse" => self.right_flank_impulse,
            "first_frequency" => self.first_frequency,
            _ => return None,
        })
    }
}

/// Summary of a run of a seal-seat scene.
pub type SeatSummary = Summary<SeatQuantities>;

/// The course of a seal-seat scene over one time axis. All vectors have `time.len()` entries; the sphere's vectors
/// hold [x, z].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SeatHistory {
    /// Time in s since the first touch, strictly increasing.
    pub time: Vec<f64>,
    /// Displacement of the sphere's centre along x and z in m since t = 0.
    pub sphere_displacement: [Vec<f64>; 2],
    /// Velocity of the sphere along x and z in m/s.
    pub sphere_velocity: [Vec<f64>; 2],
    /// Magnitude of the resultant force between seat and sphere in N.
    pub sphere_force: Vec<f64>,
    /// The resultant force on the sphere along x and z in N.
    pub sphere_force_components: [Vec<f64>; 2],
    /// Displacement of the actuator in m, signed along z.
    pub actuator_displacement: Vec<f64>,
    /// Velocity of the actuator in m/s, signed along z.
    pub actuator_velocity: Vec<f64>,
    /// Force between actuator and seat in N, positive in compression, all tips together.
    pub actuator_force: Vec<f64>,
}

/// Name and unit of every curve of the [`SeatHistory`].
pub const SEAT_CURVES: [(&str, &str); 10] = [
    ("sphere_displacement_x", "m"),
    ("sphere_displacement_z", "m"),
    ("sphere_velocity_x", "m/s"),
    ("sphere_velocity_z", "m/s"),
    ("sphere_force", "N"),
    ("sphere_force_x", "N"),
    ("sphere_force_z", "N"),
    ("actuator_displacement", "m"),
    ("actuator_velocity", "m/s"),
    ("actuator_force", "N"),
];

impl Curves for SeatHistory {
    const NAMES: &'static [(&'static str, &'static str)] = &SEAT_CURVES;
    const COLUMNS: &'static [&'static str] = &[
        "time",
        "sphere_displacement_x",
        "sphere_displacement_z",
        "sphere_velocity_x",
        "sphere_velocity_z",
        "sphere_force",
        "sphere_force_x",
        "sphere_force_z",
        "actuator_displacement",
        "actuator_velocity",
        "actuator_force",
    ];

    fn time(&self) -> &[f64] {
        &self.time
    }

    fn values(&self, name: &str) -> Option<&[f64]> {
        Some(match name {
            "sphere_displacement_x" => &self.sphere_displacement[0],
            "sphere_displacement_z" => &self.sphere_displacement[1],
            "sphere_velocity_x" => &self.sphere_velocity[0],
            "sphere_velocity_z" => &self.sphere_velocity[1],
            "sphere_force" => &self.sphere_force,
            "sphere_force_x" => &self.sphere_force_components[0],
            "sphere_force_z" => &self.sphere_force_components[1],
            "actuator_displacement" => &self.actuator_displacement,
            "actuator_velocity" => &self.actuator_velocity,
            "actuator_force" => &self.actuator_force,
            _ => return None,
        })
    }

    fn rate_after_end(&self, name: &str) -> Option<f64> {
        let last = self.time.len().checked_sub(1)?;
        let flies = self.sphere_force[last] == 0.0 && self.actuator_force[last] == 0.0;
        flies.then(|| match name {
            "sphere_displacement_x" => self.sphere_velocity[0][last],
            "sphere_displacement_z" => self.sphere_velocity[1][last],
            "actuator_displacement" => self.actuator_velocity[last],
            _ => 0.0,
        })
    }

    fn column(&mut self, name: &str) -> Option<&mut Vec<f64>> {
        Some(match name {
            "time" => &mut self.time,
            "sphere_displacement_x" => &mut self.sphere_displacement[0],
            "sphere_displacement_z" => &mut self.sphere_displacement[1],
            "sphere_velocity_x" => &mut self.sphere_velocity[0],
            "sphere_velocity_z" => &mut self.sphere_velocity[1],
            "sphere_force" => &mut self.sphere_force,
            "sphere_force_x" => &mut self.sphere_force_components[0],
            "sphere_force_z" => &mut self.sphere_force_components[1],
            "actuator_displacement" => &mut self.actuator_displacement,
            "actuator_velocity" => &mut self.actuator_velocity,
            "actuator_force" => &mut self.actuator_force,
            _ => return None,
        })
    }
}
