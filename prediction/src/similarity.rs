//! What makes a scene similar to others of the validation base.

use crate::kinds;
use impactcheck_physics::result::Summary;
use impactcheck_physics::scene::Scene;
use serde::Serialize;
use std::collections::BTreeMap;

/// What the numbers are, in their order, that decide how well a reduced model of an impact through a plate does.
pub const MEASURES: [&str; 3] = ["patch/thickness", "contact/period", "mass ratio"];

/// The number of a result that states by how much the film of the models may change the efficiency.
pub(crate) const FILM_ERROR: &str = "possible error of the efficiency by the film";

/// Group and dimensionless numbers of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Similarity {
    /// Group of the validation base.
    pub group: &'static str,
    /// Numbers of the scene, by name.
    pub numbers: BTreeMap<&'static str, f64>,
    /// Numbers of the result of model C, by name, positive.
    pub results: BTreeMap<&'static str, f64>,
}

impl Similarity {
    /// Of `scene`, where model C has the summary `continuum`.
    ///
    /// # Errors
    /// A sentence of scenes that the base has none like, and where the result does not tell.
    pub fn of(scene: &Scene, continuum: &Summary) -> Result<Self, String> {
        let kind = kinds::of(scene)?;
        let results =
            kind.result_numbers(scene, continuum).ok_or("model C does not determine the contact")?;
        let numbers = kind.numbers(scene).into_iter().collect();
        Ok(Self { group: kind.stratum(scene)?, numbers, results: results.into_iter().collect() })
    }
}
