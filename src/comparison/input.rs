//! What a comparison is made of, and the function that makes it.

use super::budget::QuantityBudget;
use super::{
    ChangedTolerance, Check, Discrepancy, ModelComparison, ReferenceCheck, SceneComparison, Verdict,
    integrity, landing, rows::rows, undecided,
};
use crate::curves::{CommonAxis, CurveMetrics, align};
use crate::measured::Measured;
use crate::result::{FlightSummary, Outcome, Summary};
use crate::scene::{Scene, Tolerances};
use crate::uncertainty::validation::{self, Assessment, numerical, scatter_of};
use crate::uncertainty::Scatter;
use std::collections::BTreeMap;

/// Everything that the comparison of one scene is made of: scene, reference and reduced models, and what else is known.
#[derive(Debug, Clone)]
pub struct ComparisonInput<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The reference. Its summary has the 95 % bands and says which solver made it.
    pub reference: &'a Outcome,
    /// Results of reduced models and external programs, in the order of the comparison.
    pub reduced: &'a [Outcome],
    /// Reference and results of the same models on a mesh whose elements are [`COARSER`](crate::reference::COARSER) times as
    /// large, where on either mesh models and reference are solutions on the very same one.
    pub coarser: Option<(&'a Outcome, &'a [Outcome])>,
    /// An independent solver's result; compared with the reference, not gated.
    pub other: Option<&'a Outcome>,
    /// Measured records, aligned with this reference; reported, not gated.
    pub measured: Option<Measured>,
    /// Propagated uncertainty of the scene's inputs, by the name of the model; not gated.
    pub scatters: BTreeMap<String, Scatter>,
    /// Checks of the reference against the one accepted last; gated.
    pub accepted: Vec<Check>,
    /// Tolerances that differ from those accepted last; reported, not gated.
    pub changed_tolerances: Vec<ChangedTolerance>,
    /// What causes the difference between model B and the reference; reported, not gated.
    pub budget: Vec<QuantityBudget>,
}

/// Compares the results of reduced models with the reference of the same scene; nothing else is known.
pub fn compare_scene(scene: &Scene, reference: &Outcome, reduced: &[Outcome]) -> SceneComparison {
    ComparisonInput::new(scene, reference, reduced).compare()
}

impl<'a> ComparisonInput<'a> {
    /// Of a reference and reduced models alone.
    pub fn new(scene: &'a Scene, reference: &'a Outcome, reduced: &'a [Outcome]) -> Self {
        ComparisonInput {
            scene,
            reference,
            reduced,
            coarser: None,
            other: None,
            measured: None,
            scatters: BTreeMap::new(),
            accepted: Vec::new(),
            changed_tolerances: Vec::new(),
            budget: Vec::new(),
        }
    }

    /// The comparison.
    ///
    /// All curves are resampled on the window that the reference fixes (see [`CommonAxis::of_reference`] and [`align`]), so
    /// that differently sampled histories don't differ for that reason.
    pub fn compare(self) -> SceneComparison {
        let ComparisonInput { scene, reference, reduced, .. } = self;
        let mut integrity = integrity::check(scene, reference);
        integrity.extend(self.accepted);
        let comparator = Comparator {
            scene,
            reference,
            flight: landing::of_reference(scene, &reference.summary, reduced),
            window: CommonAxis::of_reference(reference),
            sound: soundness(&integrity),
            coarser: self.coarser.map(|(reference, reduced)| compare_scene(scene, reference, reduced)),
            scatters: self.scatters,
        };
        let models: Vec<_> = reduced.iter().map(|outcome| comparator.model(outcome)).collect();
        SceneComparison {
            scene: scene.name.clone(),
            verdict: Verdict::worst(models.iter().map(|model| model.verdict).chain([comparator.sound])),
            integrity,
            window: comparator.window,
            models,
            budget: self.budget,
            changed_tolerances: self.changed_tolerances,
            measured: self.measured,
            reference_check: self.other.map(|other| ReferenceCheck::of(&reference.summary, &other.summary)),
            reference: Summary { flight: comparator.flight, ..reference.summary.clone() },
        }
    }
}

/// What every model of a scene is compared with.
struct Comparator<'a> {
    scene: &'a Scene,
    reference: &'a Outcome,
    /// Where the reference's launch lands.
    flight: Option<FlightSummary>,
    window: Option<CommonAxis>,
    /// Fail if the reference contradicts itself.
    sound: Verdict,
    coarser: Option<SceneComparison>,
    scatters: BTreeMap<String, Scatter>,
}

impl Comparator<'_> {
    fn model(&self, reduced: &Outcome) -> ModelComparison {
        let (scene, reference) = (self.scene, &self.reference.summary);
        let summary = reduced.summary.clone();
        let model = summary.model.clone().unwrap_or_default();
        let mut integrity = integrity::check(scene, reduced);
        // of a program that has failed nothing can be compared
        if summary.failure.is_some() {
            return ModelComparison {
                model,
                summary,
                verdict: Verdict::Fail,
                discrepancies: Vec::new(),
                curves: Vec::new(),
                integrity,
                aligned: Vec::new(),
            };
        }
        let none = Tolerances::new();
        let tolerances = scene.tolerances.get(&model).unwrap_or(&none);
        let aligned =
            self.window.map_or_else(Vec::new, |w| align(w, &self.reference.history, &reduced.history));
        let sides = (self.reference, self.flight.as_ref());
        let rows = rows(scene, sides, reduced, &aligned, tolerances).into_iter();
        let discrepancies: Vec<_> = rows.map(|row| self.judged(row, &summary)).collect();
        integrity.push(integrity::same_impact(reference, &summary));
        integrity.push(integrity::tolerances_are_used(tolerances, &discrepancies));
        let verdicts = discrepancies.iter().map(|row| row.verdict);
        ModelComparison {
            model,
            verdict: Verdict::worst(verdicts.chain([soundness(&integrity), self.sound])),
            discrepancies,
            curves: aligned.iter().map(CurveMetrics::of).collect(),
            integrity,
            aligned,
            summary,
        }
    }

    /// The row with its final band and verdict, and what uncertain inputs leave open of it.
    fn judged(&self, row: Discrepancy, reduced: &Summary) -> Discrepancy {
        let model = reduced.model.as_deref().unwrap_or_default();
        let before = self.coarser.as_ref().and_then(|coarser| coarser.model(model)?.discrepancy(&row.quantity));
        let row = row.on_common_mesh(before);
        let validation = scatter_of(&self.scatters, model).and_then(|scatter| {
            let band = row.band().map(|band| band / validation::COVERAGE);
            let sides = (numerical(reduced, &row.quantity), band);
            Assessment::of(row.difference?, sides, scatter.quantities.get(&*row.quantity)?)
        });
        let would_decide = undecided::advice(&row, &self.reference.summary);
        Discrepancy { would_decide, validation, ..row }
    }
}

/// Fail if any of the checks fails.
fn soundness(checks: &[Check]) -> Verdict {
    Verdict::of_soundness(checks.iter().map(|check| check.verdict))
}
