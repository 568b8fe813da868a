//! What the results of an impact on a wall, an elastic body or another body are called.

use crate::result::{Curve, quantities};

quantities! {
    /// Results of an impact on a wall, an elastic body or another body (scene kind `impact`). Those of an inner body, and of its contact with an
    /// elastic body, are not determined where there is none.
    ImpactQuantities {
        /// Eq. (1): kinetic energy of the inner body after the last contact over that of the outer before the first.
        efficiency: f64, "1";
        /// Velocity of the outer body after the last contact, m/s, signed along z.
        outer_velocity_final: f64, "m/s", of outer_velocity;
        /// Velocity of the inner body after the last contact, m/s, signed along z.
        inner_velocity_final: f64, "m/s", of inner_velocity;
        /// Largest contact force of the outer body, N.
        outer_force_peak: f64, "N", of outer_force;
        /// Largest force between an elastic body and the inner one, N.
        inner_force_peak: f64, "N", of inner_force;
        /// Time of the outer body's last release, s.
        outer_contact_end: f64, "s";
        /// Time of the inner body's last release, s.
        inner_contact_end: f64, "s";
        /// Number of separate contacts of the outer body.
        outer_contacts: u32, "1";
        /// Number of separate contacts of the inner body.
        inner_contacts: u32, "1";
        /// Relative normal velocity after the last contact over that before the first, an elastic body's by its centre of mass.
        outer_restitution: f64, "1";
        /// The same of the inner contact, where the inner body moves before it.
        inner_restitution: f64, "1";
        /// Impulse of the outer contact, N s.
        outer_impulse: f64, "N*s";
        /// Impulse of the inner contact, N s.
        inner_impulse: f64, "N*s";
        /// Lowest frequency of an elastic body that the contacts excite, Hz.
        first_frequency: f64, "Hz";
    }
}

/// Displacements in m since t = 0 and velocities, signed along z, and forces in N, positive in compression; those of an inner body are missing
/// where there is none. On an elastic body z is the outward normal at the outer contact for the outer body, the inward one at its contact for
/// the inner body.
pub static CURVES: [Curve; 6] = [
    Curve::new("outer_displacement", "m"),
    Curve::new("inner_displacement", "m"),
    Curve::new("outer_velocity", "m/s"),
    Curve::new("inner_velocity", "m/s"),
    Curve::new("outer_force", "N"),
    Curve::new("inner_force", "N"),
];
