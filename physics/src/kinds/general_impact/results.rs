//! What the results of an impact on a wall or another body are called.

use crate::result::{Curve, quantities};

quantities! {
    /// Results of an impact on a wall or another body (scene kind `impact`); before a wall those of the inner body are not determined.
    ImpactQuantities {
        /// Eq. (1): kinetic energy of the inner body after the last contact over that of the outer before the first.
        efficiency: f64, "1";
        /// Velocity of the outer body after the last contact, m/s, signed along z.
        outer_velocity_final: f64, "m/s", of outer_velocity;
        /// Velocity of the inner body after the last contact, m/s, signed along z.
        inner_velocity_final: f64, "m/s", of inner_velocity;
        /// Largest contact force, N.
        outer_force_peak: f64, "N", of outer_force;
        /// Time of the last release, s.
        outer_contact_end: f64, "s";
        /// Number of separate contacts.
        outer_contacts: u32, "1";
        /// Relative normal velocity after the last contact over that before the first.
        outer_restitution: f64, "1";
        /// Impulse of the contact force, N s.
        outer_impulse: f64, "N*s";
    }
}

/// Displacements in m since t = 0 and velocities, signed along z, and the force in N, positive in compression; those of the inner body are
/// missing before a wall.
pub static CURVES: [Curve; 5] = [
    Curve::new("outer_displacement", "m"),
    Curve::new("inner_displacement", "m"),
    Curve::new("outer_velocity", "m/s"),
    Curve::new("inner_velocity", "m/s"),
    Curve::new("outer_force", "N"),
];
