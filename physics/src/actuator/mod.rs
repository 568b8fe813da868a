//! Actuators: what drives an outer body that is more than a mass with a speed.

pub mod beam;
pub mod cantilever;
pub mod circuit;
pub mod inductance;
pub mod magnet;
pub mod stack;

pub use stack::{Stack, Supply};

use serde::Serialize;

/// Piezo bender (section 4.3): a beam clamped at one end, with a point mass and a spherical tip at the other.
///
/// It is bent away from the plate by a bending moment that is uniform along the beam, as a piezo layer gives it,
/// and released from rest: the moment is gone at once or, as a piezo is discharged through a resistor (section 2.2.2),
/// decays. It strikes where its tip passes the straight position, or beside it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bender {
    /// Length L of the beam in m.
    pub length: f64,
    /// Bending stiffness E I in N m^2.
    pub bending_stiffness: f64,
    /// Mass per length rho A in kg/m.
    pub line_mass: f64,
    /// Point mass at the tip in kg.
    pub tip_mass: f64,
    /// Radius of curvature at the contact in m.
    pub tip_radius: f64,
    /// Time constant in s with which the moment decays after the release; 0 = it is gone at once.
    pub discharge_time: f64,
    /// Deflection of the tip at which it strikes, over that before the release: 0 where it passes its straight position, positive where
    /// the plate stands nearer, negative where it stands beyond.
    #[serde(skip_serializing_if = "is_zero")]
    pub strike_at: f64,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it with a reference")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Bender {
    /// Mass of beam and tip in kg.
    pub fn mass(&self) -> f64 {
        self.line_mass * self.length + self.tip_mass
    }
}
