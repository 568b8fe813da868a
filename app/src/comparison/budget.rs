//! Error budget of a model: what each of its simplifications adds to its difference from the reference.

pub use super::kinds::budget_of_results as of_results;

use super::Verdict;
use serde::Serialize;

/// The budget of one quantity. Values are in `unit`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct QuantityBudget {
    /// Name of the quantity.
    pub quantity: String,
    /// The model whose difference from the reference is shared out.
    pub model: String,
    /// SI unit.
    pub unit: String,
    /// Value of the reference.
    pub reference: f64,
    /// The model less the reference: the sum of the parts and the remainder.
    pub difference: f64,
    /// One part per cause, the same ones for every quantity.
    pub parts: Vec<Part>,
    /// The best model less the reference.
    pub remainder: f64,
    /// Half width of the reference's 95 % band; `None` if unknown, and then taken as 0.
    pub reference_uncertainty: Option<f64>,
    /// Uncertainty of the best model: modes, mesh, contact patch, time step.
    pub model_uncertainty: f64,
    /// Root of the sum of squares of both uncertainties: the bound on the remainder.
    pub bound: f64,
    /// Whether |remainder| is within the bound.
    pub explained: Verdict,
}

/// What one simplification causes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Part {
    /// Its name.
    pub cause: String,
    /// What is switched, in words.
    pub switch: String,
    /// The value with the simplification less the value without.
    pub value: f64,
    /// Uncertainty of `value`.
    pub uncertainty: f64,
}

/// Root of the sum of squares: independent changes together.
pub(super) fn root_of_squares(changes: impl Iterator<Item = f64>) -> f64 {
    changes.map(|c| c * c).sum::<f64>().sqrt()
}
