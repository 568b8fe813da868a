//! How a bender was bent before its release.

use serde::{Deserialize, Serialize};

/// What bent a bender before its release.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Drive {
    /// Bending moment, uniform along the beam, N m.
    pub torque: f64,
    /// Deflection of the tip, m.
    pub tip_deflection: f64,
    /// Strain energy, J.
    pub strain_energy: f64,
    /// Kinetic energy of beam and tip at the strike, J.
    pub kinetic_energy: f64,
    /// Time from the release to the strike, s.
    pub strike_delay: f64,
}
