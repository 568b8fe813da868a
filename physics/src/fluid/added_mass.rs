//! Fluid moved along by the plate: added mass and damping of its modes (section 3.5.3 of the paper).
//!
//! As in the paper the mass matrix of the plate is multiplied by one factor, found so that the first wet frequency
//! has the given ratio r to the dry one. With M' = c M every frequency falls by sqrt(c) and so does every
//! mass-normalised shape: c = 1/r^2 exactly, and static flexibilities, phi^2/omega^2, stay as they are.

use crate::body::ModalBody;
use crate::scene::Fluid;

/// Factor on the plate's mass at which its first frequency is `frequency_ratio` times the dry one.
pub fn mass_factor(frequency_ratio: f64) -> f64 {
    frequency_ratio.powi(-2)
}

/// The plate with fluid on one side: added mass, and the damping ratio of the wet plate for its elastic modes.
pub fn immersed(plate: ModalBody, fluid: &Fluid) -> ModalBody {
    let slower = mass_factor(fluid.added_mass_frequency_ratio).sqrt().recip();
    ModalBody {
        omega: plate.omega.iter().map(|omega| omega * slower).collect(),
        damping_ratio: plate.omega.iter().map(|_| fluid.plate_damping_ratio).collect(),
        participation: plate.participation.iter().map(|phi| phi.map(|p| p * slower)).collect(),
        ..plate
    }
}
