//! Where the energy of an impact went.

use serde::{Deserialize, Serialize};

/// Energy lost during an impact.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Losses {
    /// To the damping of the plate's modes, J.
    pub plate_damping: f64,
    /// In the squeeze film, J.
    pub squeeze_film: f64,
    /// By the drag on the inner body, J.
    pub drag: f64,
    /// In the contacts of the outer and the inner body, of a seal seat those of actuator and sphere, to relaxing or yielding
    /// materials or friction, J; `None` where nothing of it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contacts: Option<[f64; 2]>,
    /// In outer body, plate and inner body to relaxation, contacts included, J: of what knows no contact apart, references and seal
    /// seats (actuator, seat and sphere).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bodies: Option<[f64; 3]>,
}
