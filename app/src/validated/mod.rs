//! Where models were compared with references, and how far off they were there: what trust in them elsewhere rests on.
//!
//! One entry per scene and model, made by comparisons and never by hand. The project brings along those of its own scenes,
//! whose references are too large to come with it; those of a user's scenes lie in the user's store, beside the references.

mod record;

pub use crate::kinds::Place;
pub use crate::prediction::MEASURES;
pub use record::{merge, of_store, record, shipped, update};

use crate::comparison::{Check, Discrepancy, ModelComparison, SceneComparison, value_in};
use crate::format::rounded;
use crate::reference::revision;
use crate::result::Summary;
use crate::scene::{Geometry, Model, Scene};
use serde::{Deserialize, Serialize};

/// Version of the program, whose models an entry of a user's store is of.
const PROGRAM: &str = env!("CARGO_PKG_VERSION");
/// Revision of the reference's method since which what is kept of it is the same: the fourth changed what is recorded of the
/// plate's motion, which is not kept.
pub const SAME_SINCE: u32 = 3;
/// Significant digits kept: more than any band leaves sure, and the same on every machine.
const DIGITS: usize = 7;

/// A model compared with a reference in one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Validation {
    /// Name of the scene.
    pub scene: String,
    /// Hash of its physical content.
    pub scene_hash: String,
    /// Name of the reduced model.
    pub model: String,
    /// Its number of modes.
    pub modes: Option<usize>,
    /// Kind of the finite elements, "axisymmetric" or "solid", or the name of another program.
    pub partner: String,
    /// Degrees of freedom of the reference.
    pub dofs: Option<u64>,
    /// Revision of the reference's method.
    pub revision: u32,
    /// Version of the program.
    pub program: String,
    /// Where the scene lies among others, if it is one of a plate.
    pub place: Option<Place>,
    /// Efficiency, force peaks, and what is furthest off in the summary if that is another.
    pub rows: Vec<Row>,
}

/// A quantity of a model beside the reference's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name of the quantity.
    pub quantity: String,
    /// Value of the model, SI.
    pub reduced: f64,
    /// Value of the reference, SI, not 0.
    pub reference: f64,
    /// Half width of the reference's 95 % band, SI, if it is known.
    pub band: Option<f64>,
}

impl Row {
    /// `None` if a side is not determined, or nothing can be relative to it.
    fn of(row: &Discrepancy) -> Option<Self> {
        let finite = |value: Option<f64>| value.filter(|v| v.is_finite()).map(with_digits);
        let reference = finite(row.reference).filter(|value| *value != 0.0)?;
        let (quantity, band) = (row.quantity.clone(), finite(row.uncertainty));
        Some(Row { quantity, reduced: finite(row.reduced)?, reference, band })
    }

    /// Signed discrepancy over the reference's magnitude.
    pub fn relative(&self) -> f64 {
        (self.reduced - self.reference) / self.reference.abs()
    }

    /// Half width of the reference's band over its magnitude.
    pub fn relative_band(&self) -> Option<f64> {
        self.band.map(|band| band / self.reference.abs())
    }
}

impl Validation {
    /// What `comparison` shows of the models of `scene`, with the modes they have by default. A result that contradicts
    /// itself shows nothing.
    pub fn of(scene: &Scene, comparison: &SceneComparison) -> Vec<Self> {
        if !are_sound(&comparison.integrity) {
            return Vec::new();
        }
        let is_default =
            |model: &&ModelComparison| model.model.parse::<Model>().is_ok() && model.summary.choice.is_none();
        let sound = comparison.models.iter().filter(|model| are_sound(&model.integrity));
        sound.filter(is_default).map(|model| Self::of_model(scene, comparison, model)).collect()
    }

    fn of_model(scene: &Scene, comparison: &SceneComparison, model: &ModelComparison) -> Self {
        let reference = &comparison.reference;
        let largest = model.largest().map(|row| &row.quantity);
        let is_recorded = |row: &&Discrepancy| decides(&row.quantity) || Some(&row.quantity) == largest;
        Validation {
            scene: scene.name.clone(),
            scene_hash: reference.scene_hash.clone(),
            model: model.model.clone(),
            modes: model.summary.modes,
            partner: match (&reference.model, scene.reference.geometry) {
                (Some(program), _) => program.clone(),
                (None, Geometry::Axisymmetric) => "axisymmetric".into(),
                (None, Geometry::Solid) => "solid".into(),
            },
            dofs: reference.mesh.as_ref().and_then(|mesh| mesh["dofs"].as_u64()),
            revision: revision(scene),
            program: PROGRAM.into(),
            // the map is of this program's references: another one's stand beside them
            place: reference.model.is_none().then(|| Place::of(scene, reference)).flatten(),
            rows: model.discrepancies.iter().filter(is_recorded).filter_map(Row::of).collect(),
        }
    }

    /// The same reference beside a model that now gives `summary`.
    pub fn renewed(&self, summary: &Summary) -> Self {
        let now = |row: &Row| value_in(summary, &row.quantity).map_or(row.reduced, with_digits);
        let rows = self.rows.iter().map(|row| Row { reduced: now(row), ..row.clone() }).collect();
        Validation { modes: summary.modes, program: PROGRAM.into(), rows, ..self.clone() }
    }

    /// What is furthest off among efficiency and force peaks.
    pub fn worst(&self) -> Option<&Row> {
        furthest(self.rows.iter().filter(|row| decides(&row.quantity)))
    }

    /// What is furthest off of all.
    pub fn largest(&self) -> Option<&Row> {
        furthest(self.rows.iter())
    }

    /// Whether it is of exactly this scene and of this model.
    pub fn is_of(&self, scene: &Scene, model: Model) -> bool {
        self.scene == scene.name && self.scene_hash == scene.hash() && self.model == model.to_string()
    }

    /// Whether both are of the same scene and model by name, compared with the same.
    fn is_of_same(&self, other: &Self) -> bool {
        (&self.scene, &self.model, &self.partner) == (&other.scene, &other.model, &other.partner)
    }
}

/// Whether a model is judged by it on the map.
fn decides(quantity: &str) -> bool {
    quantity == "efficiency" || quantity.ends_with("_force_peak")
}

fn furthest<'a>(rows: impl Iterator<Item = &'a Row>) -> Option<&'a Row> {
    rows.max_by(|a, b| a.relative().abs().total_cmp(&b.relative().abs()))
}

fn are_sound(checks: &[Check]) -> bool {
    !checks.iter().any(|check| check.verdict.failed())
}

/// `value` with the digits that are kept.
fn with_digits(value: f64) -> f64 {
    rounded(value, DIGITS)
}
