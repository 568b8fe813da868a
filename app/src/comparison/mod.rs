//! Comparison: reduced models against the reference, quantity by quantity and curve by curve,
//! and the verdict.
//!
//! The verdict of a model is the worst of its rows': fail if a discrepancy exceeds its tolerance beyond
//! the reference's band or a value is not a number, undecided if the band leaves that open or another program's reference has no
//! value, not gated only if nothing is.
//! It is fail, too, if one of the two results contradicts itself ([`Check`]): a history that does not
//! belong to its summary proves nothing, whatever the summary says.

pub mod budget;
mod changed_tolerance;
mod common_mesh;
mod discrepancy;
mod impacts;
mod imported;
mod input;
mod integrity;
mod kinds;
mod landing;
mod moved;
mod reference_check;
mod rows;
mod series;
mod undecided;
mod verdict;

pub use changed_tolerance::ChangedTolerance;
pub use common_mesh::difference_band;
pub use discrepancy::{BandVerdict, Discrepancy};
pub use impacts::value_in;
pub use imported::import;
pub use input::{ComparisonInput, compare_scene};
pub use integrity::{Check, contradictions};
pub use kinds::plate_budget;
pub use moved::{ComparisonDocument, Moved, MovedVerdict, Moves, moved};
pub use reference_check::{ReferenceCheck, ReferenceRow};
pub use series::{MeshValues, ORDER, STANDARD_ERRORS, mesh_values};
pub use verdict::{GateRules, Undecided, Verdict};

use crate::curves::{AlignedCurve, CommonAxis, CurveMetrics};
use crate::measured::Measured;
use crate::result::{SCHEMA_VERSION, Summary};
use crate::uncertainty::validation;
use budget::QuantityBudget;
use serde::Serialize;
use std::collections::BTreeMap;

/// The document of `compare` and `gate`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// The worst of the scenes'.
    pub verdict: Verdict,
    /// One entry per scene.
    pub scenes: Vec<SceneComparison>,
}

impl Comparison {
    /// The document of these scenes.
    pub fn new(scenes: Vec<SceneComparison>) -> Self {
        let verdict = Verdict::worst(scenes.iter().map(|s| s.verdict));
        Comparison { schema_version: SCHEMA_VERSION, verdict, scenes }
    }

    /// Whether a model of a scene has given no result at all.
    pub fn has_no_result(&self) -> bool {
        self.scenes.iter().flat_map(|scene| &scene.models).any(|model| model.summary.failure.is_some())
    }

    /// Whether another program's solution differs from the reference of a scene by more than both bands.
    pub fn references_disagree(&self) -> bool {
        let checks = self.scenes.iter().filter_map(|scene| scene.reference_check.as_ref());
        checks.into_iter().any(|check| check.verdict == BandVerdict::Beyond)
    }
}

/// One scene: its reference and the reduced models compared with it. Made once, by [`ComparisonInput::compare`].
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneComparison {
    /// Name of the scene.
    pub scene: String,
    /// The worst of the models'; fail if the reference contradicts itself.
    pub verdict: Verdict,
    /// Summary of the reference.
    pub reference: Summary,
    /// Whether the reference is consistent with itself and with the scene; always gated.
    pub integrity: Vec<Check>,
    /// Time axis of all curves, fixed by the reference; `None` if its history can't be used.
    pub window: Option<CommonAxis>,
    /// One entry per reduced model.
    pub models: Vec<ModelComparison>,
    /// What causes the difference between model B and the reference, one entry per quantity; empty without one.
    pub budget: Vec<QuantityBudget>,
    /// Tolerances that differ from those accepted last; reported, not gated.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub changed_tolerances: Vec<ChangedTolerance>,
    /// Measured records beside reference and models, if there are any; reported, not gated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
    /// Another program's solution beside the reference, if there is one; reported, not gated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference_check: Option<ReferenceCheck>,
}

impl SceneComparison {
    /// Whether the scene stops at the gate.
    pub fn is_refused(&self, rules: GateRules) -> bool {
        let mut rows = self.models.iter().flat_map(|model| &model.discrepancies);
        rules.refuse(self.verdict) || rows.any(|row| row.is_refused(rules))
    }

    /// Tolerances for which the reference has no value, as `MODEL.QUANTITY`.
    pub fn without_reference(&self) -> Vec<String> {
        let of = |model: &ModelComparison| {
            let rows = model.discrepancies.iter().filter(|row| row.has_no_reference());
            rows.map(|row| format!("{}.{}", model.model, row.quantity)).collect::<Vec<_>>()
        };
        self.models.iter().flat_map(of).collect()
    }

    /// The model called `name`.
    pub fn model(&self, name: &str) -> Option<&ModelComparison> {
        self.models.iter().find(|model| model.model == name)
    }

    /// The names of its models.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.models.iter().map(|model| &*model.model)
    }

    /// Verdicts of the rows of all models that have a tolerance.
    pub fn gated_verdicts(&self) -> impl Iterator<Item = Verdict> {
        self.models.iter().flat_map(ModelComparison::gated_verdicts)
    }

    /// What uncertain inputs leave open of model B's differences: 2 u_val by quantity; empty if they are certain.
    pub fn open(&self) -> BTreeMap<&str, f64> {
        let rows = self.model("B").into_iter().flat_map(|model| &model.discrepancies);
        rows.filter_map(|row| Some((&*row.quantity, validation::COVERAGE * row.validation.as_ref()?.u_val)))
            .collect()
    }
}

/// One reduced model against the reference.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelComparison {
    /// Name of the model.
    pub model: String,
    /// Summary of the reduced model.
    pub summary: Summary,
    /// The worst of the rows'; fail if any check fails, those of the reference included.
    pub verdict: Verdict,
    /// Quantities, curves and residuals.
    pub discrepancies: Vec<Discrepancy>,
    /// Curve metrics.
    pub curves: Vec<CurveMetrics>,
    /// Whether the reduced result is consistent with itself and with the scene; always gated.
    pub integrity: Vec<Check>,
    /// Both histories on the common axis; not part of the JSON document.
    #[serde(skip)]
    pub aligned: Vec<AlignedCurve>,
}

/// What [`ModelComparison::largest`] is the largest of, for people.
pub const AMONG: &str = "Largest difference: the largest relative one among the single numbers of the summary (efficiency, velocities, \
    directions, force peaks, impulses, ends of contact, first frequency). Not among them are the numbers of contacts, of which \
    one is 100 %, the distances of curves, and the conservation residuals.";

impl ModelComparison {
    /// The row called `quantity`.
    pub fn discrepancy(&self, quantity: &str) -> Option<&Discrepancy> {
        self.discrepancies.iter().find(|d| d.quantity == quantity)
    }

    /// The quantity of the summary that lies furthest from the reference, relatively; see [`AMONG`].
    pub fn largest(&self) -> Option<&Discrepancy> {
        self.discrepancies
            .iter()
            .filter(|d| self.summary.quantities.get(&d.quantity).is_some_and(|quantity| !quantity.is_count))
            .filter(|d| d.relative.is_some())
            .max_by(|a, b| {
                let size = |d: &Discrepancy| d.relative.map_or(0.0, f64::abs);
                size(a).total_cmp(&size(b))
            })
    }

    /// The gated row that is nearest to its bound, or farthest beyond it.
    pub fn tightest(&self) -> Option<&Discrepancy> {
        let used =
            |d: &Discrepancy| d.used().map_or(-1.0, |used| if used.is_nan() { f64::INFINITY } else { used });
        self.discrepancies.iter().filter(|d| d.tolerance.is_some()).max_by(|a, b| used(a).total_cmp(&used(b)))
    }

    /// Verdicts of the rows that have a tolerance.
    pub fn gated_verdicts(&self) -> impl Iterator<Item = Verdict> {
        self.discrepancies.iter().filter(|row| row.is_gated()).map(|row| row.verdict)
    }

    /// Number of rows that have a tolerance.
    pub fn gated(&self) -> usize {
        self.gated_verdicts().count()
    }

    /// Number of gated rows whose tolerance lies about a known discrepancy.
    fn biased(&self) -> usize {
        self.discrepancies.iter().filter(|d| d.bias.is_some_and(|bias| bias != 0.0)).count()
    }

    /// The verdict in words: a pass of a model that is known to be off is told as such.
    pub fn verdict_in_words(&self) -> &'static str {
        if self.verdict.passed() && self.biased() > 0 { "pass (known bias)" } else { self.verdict.words() }
    }
}
