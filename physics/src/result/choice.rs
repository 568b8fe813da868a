//! Why a reduced model was chosen, as told with its result.

use serde::{Deserialize, Serialize};

/// A model that was considered.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CandidateModel {
    /// A, B or C.
    pub model: String,
    /// Elastic modes.
    pub modes: usize,
    /// Largest predicted relative error of the quantities covered; `None` if there is no prediction.
    pub estimated_error: Option<f64>,
    /// The quantity with that error.
    pub quantity: Option<String>,
    /// Whether it was chosen.
    pub chosen: bool,
}

/// What was chosen for a scene, from what, and why.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Choice {
    /// Relative error asked for.
    pub tolerance: f64,
    /// The quantities it covers; the efficiency relative to at least 0.05, the velocity to the impact speed.
    pub covers: Vec<String>,
    /// The prediction for the model chosen; `None` if there is none.
    pub estimated_error: Option<f64>,
    /// Probability that the true error of each quantity is within the estimate.
    pub coverage: f64,
    /// Whether the prediction is within the tolerance.
    pub met: bool,
    /// The models considered, the simplest first.
    pub tried: Vec<CandidateModel>,
    /// Why, in a sentence.
    pub reason: String,
}
