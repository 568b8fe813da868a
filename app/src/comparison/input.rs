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
use crate::uncertainty::PropagatedUncertainty;
use crate::uncertainty::validation::{self, Assessment, numerical, propagated_of};
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
    pub propagations: BTreeMap<String, PropagatedUncertainty>,
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
            propagations: BTreeMap::new(),
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
        let reference = &self.reference.summary;
        let mut integrity = integrity::check(self.scene, self.reference);
        integrity.extend(self.accepted.iter().cloned());
        let (window, sound) = (CommonAxis::of_reference(self.reference), soundness(&integrity));
        let flight = landing::of_reference(self.scene, reference, self.reduced);
        let coarser = self.coarser.map(|(reference, reduced)| compare_scene(self.scene, reference, reduced));
        let comparator = Comparator { input: &self, flight: flight.as_ref(), window, sound, coarser };
        let models: Vec<_> = self.reduced.iter().map(|outcome| comparator.model(outcome)).collect();
        SceneComparison {
            scene: self.scene.name.clone(),
            verdict: Verdict::worst(models.iter().map(|model| model.verdict).chain([sound])),
            reference_check: self.other.map(|other| ReferenceCheck::of(reference, &other.summary)),
            reference: Summary { flight, ..reference.clone() },
            integrity,
            window,
            models,
            budget: self.budget,
            changed_tolerances: self.changed_tolerances,
            measured: self.measured,
        }
    }
}

/// What every model of a scene is compared with.
struct Comparator<'a> {
    input: &'a ComparisonInput<'a>,
    /// Where the reference's launch lands.
    flight: Option<&'a FlightSummary>,
    window: Option<CommonAxis>,
    /// Fail if the reference contradicts itself.
    sound: Verdict,
    coarser: Option<SceneComparison>,
}

impl Comparator<'_> {
    fn model(&self, reduced: &Outcome) -> ModelComparison {
        let ComparisonInput { scene, reference, .. } = self.input;
        let summary = reduced.summary.clone();
        let model = summary.model.clone().unwrap_or_default();
        let none = Tolerances::new();
        let tolerances = scene.tolerances.get(&model).unwrap_or(&none);
        let (mut aligned, mut discrepancies) = (Vec::new(), Vec::new());
        let mut integrity = integrity::check(scene, reduced);
        // of a program that has failed nothing can be compared, which its checks say
        if summary.failure.is_none() {
            aligned = self.window.map_or_else(Vec::new, |w| align(w, &reference.history, &reduced.history));
            let rows = rows(scene, (reference, self.flight), reduced, &aligned, tolerances).into_iter();
            discrepancies = rows.map(|row| self.judged(row, &summary)).collect();
            integrity.push(integrity::same_impact(&reference.summary, &summary));
            integrity.push(integrity::tolerances_are_used(tolerances, &discrepancies));
        }
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
        let before =
            self.coarser.as_ref().and_then(|coarser| coarser.model(model)?.discrepancy(&row.quantity));
        let row = row.on_common_mesh(before);
        let validation = propagated_of(&self.input.propagations, model).and_then(|propagated| {
            let sides =
                (numerical(reduced, &row.quantity), row.band().map(|band| band / validation::COVERAGE));
            Assessment::of(row.difference?, sides, propagated.quantities.get(&*row.quantity)?)
        });
        let would_decide = undecided::advice(&row, &self.input.reference.summary);
        Discrepancy { would_decide, validation, ..row }
    }
}

/// Fail if any of the checks fails.
fn soundness(checks: &[Check]) -> Verdict {
    Verdict::of_soundness(checks.iter().map(|check| check.verdict))
}
