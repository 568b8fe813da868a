//! What the results of a spring-mass scene are called.

use crate::result::{Curve, quantities};

quantities! {
    /// Results of an impact on a mass on a spring (scene kind `spring-mass`).
    SpringQuantities {
        /// Energy of mass and spring after the last contact over that of the sphere before the first.
        efficiency: f64, "1";
        /// Velocity of the sphere after the last contact, m/s.
        sphere_velocity_final: f64, "m/s", of sphere_velocity;
        /// Largest contact force, N.
        sphere_force_peak: f64, "N", of sphere_force;
        /// Time of the last release, s.
        sphere_contact_end: f64, "s";
    }
}

/// Displacements in m since t = 0, velocities, and the force in N, positive in compression.
pub static CURVES: [Curve; 5] = [
    Curve::new("sphere_displacement", "m"),
    Curve::new("sphere_velocity", "m/s"),
    Curve::elastic("mass_displacement", "m"),
    Curve::elastic("mass_velocity", "m/s"),
    Curve::new("sphere_force", "N"),
];
