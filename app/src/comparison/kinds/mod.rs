//! What a comparison of some kinds of scene has besides discrepancies.

mod general_impact;
pub mod plate_impact;

pub use plate_impact as plate_budget;

use super::budget::QuantityBudget;
use crate::error::Result;
use crate::result::{Outcome, Summary};
use crate::scene::Scene;

/// The budget of the results `reduced` of `scene`; empty where none is made.
///
/// # Errors
/// [`crate::Error::Solver`] if a model can't be set up or integrated, or a run was cut during a contact.
pub fn budget_of_results(
    scene: &Scene,
    reference: &Summary,
    reduced: &[Outcome],
) -> Result<Vec<QuantityBudget>> {
    match scene.general_impact() {
        Ok(_) => general_impact::of_results(scene, reference, reduced),
        Err(_) => plate_impact::of_results(scene, reference, reduced),
    }
}
