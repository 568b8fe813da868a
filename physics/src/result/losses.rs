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
}
