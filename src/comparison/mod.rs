//! Comparison: reduced models against the reference, quantity by quantity and curve by curve,
//! and the verdict.
//!
//! The verdict of a model is the worst of its rows': fail if a discrepancy exceeds its tolerance beyond
//! the reference's band or a value is not a number, undecided if the band leaves that open or another program's reference has no
//! value, not gated only if nothing is.
//! It is fail, too, if one of the two results contradicts itself ([`Check`]): a history that does not
//! belong to its summary proves nothing, whatever the summary says.

mod changed_tolerance;
mod common_mesh;
mod discrepancy;
mod impacts;
mod imported;
mod integrity;
mod kinds;
mod landing;
mod moved;
mod reference_check;
mod series;
mod undecided;
mod verdict;

pub use changed_tolerance::ChangedTolerance;
pub use common_mesh::difference_band;
pub use discrepancy::{BandVerdict, Discrepancy};
pub use impacts::value_in;
pub use imported::import;
pub use integrity::{Check, NO_RESULT, check as integrity};
pub use kinds::budget;
pub use moved::{ComparisonDocument, Moved, MovedVerdict, Moves, moved};
pub use reference_check::{ReferenceCheck, ReferenceRow};
pub use series::{ORDER, STANDARD_ERRORS};
pub use verdict::{GateRules, Undecided, Verdict};

use crate::curves::{AlignedCurve, CommonAxis, CurveMetrics, align, peak};
use crate::error::Result;
use crate::measured::Measured;
use crate::result::{Curve, FlightSummary, Outcome, Quantity, SCHEMA_VERSION, Source, Summary};
use crate::scene::{Model, Scene, Tolerances};
use crate::uncertainty::Scatter;
use crate::uncertainty::validation::{self, Assessment, numerical};
use budget::QuantityBudget;
use discrepancy::Scales;
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
    pub fn lacks_a_result(&self) -> bool {
        self.scenes.iter().flat_map(|scene| &scene.models).any(|model| model.summary.failure.is_some())
    }

    /// Whether another program's solution differs from the reference of a scene by more than both bands.
    pub fn references_disagree(&self) -> bool {
        let checks = self.scenes.iter().filter_map(|scene| scene.reference_check.as_ref());
        checks.into_iter().any(|check| check.verdict == BandVerdict::Beyond)
    }
}

/// One scene: its reference and the reduced models compared with it.
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
    /// What causes the difference between model B and the reference, one entry per quantity; empty unless
    /// [`SceneComparison::add_budget`] was called and found models B and C.
    pub budget: Vec<QuantityBudget>,
    /// Tolerances that are not those accepted last; told, not gated. Filled by whoever knows the scene file's record.
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
            let rows = model.discrepancies.iter().filter(|row| row.lacks_reference());
            rows.map(|row| format!("{}.{}", model.model, row.quantity)).collect::<Vec<_>>()
        };
        self.models.iter().flat_map(of).collect()
    }

    /// Adds checks of the reference; one that fails makes the scene and all its models fail.
    pub fn add_reference_checks(&mut self, checks: Vec<Check>) {
        let sound = Verdict::of_soundness(checks.iter().map(|check| check.verdict));
        self.verdict = self.verdict.max(sound);
        self.models.iter_mut().for_each(|model| model.verdict = model.verdict.max(sound));
        self.integrity.extend(checks);
    }

    /// The names of its models.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.models.iter().map(|model| &*model.model)
    }

    /// Verdicts of the rows of all models that have a tolerance.
    pub fn gated_verdicts(&self) -> impl Iterator<Item = Verdict> {
        self.models.iter().flat_map(ModelComparison::gated_verdicts)
    }

    /// Holds every difference against what uncertain inputs leave open (see [`validation`]); `scatters` are those of the models, by name. Another
    /// program's result scatters as model C's.
    pub fn add_validation(&mut self, scatters: &BTreeMap<String, Scatter>) {
        let of = |name: &str| scatters.get(name).or_else(|| scatters.get(&Model::C.to_string()));
        for model in &mut self.models {
            let Some(scatter) = of(&model.model) else { continue };
            for row in &mut model.discrepancies {
                let sides = (
                    numerical(&model.summary, &row.quantity),
                    row.band().map(|band| band / validation::COVERAGE),
                );
                row.validation = row
                    .difference
                    .zip(scatter.quantities.get(&*row.quantity))
                    .and_then(|(error, scatter)| Assessment::of(error, sides, scatter));
            }
        }
        if let Some(measured) = &mut self.measured {
            let summaries: BTreeMap<&str, &Summary> =
                self.models.iter().map(|m| (&*m.model, &m.summary)).collect();
            measured.add_validation(of, |partner| {
                numerical(summaries.get(partner).unwrap_or(&&self.reference), "efficiency")
            });
        }
    }

    /// What uncertain inputs leave open of model B's differences: 2 u_val by quantity; empty if they are certain.
    pub fn open(&self) -> BTreeMap<&str, f64> {
        let rows =
            self.models.iter().filter(|model| model.model == "B").flat_map(|model| &model.discrepancies);
        rows.filter_map(|row| Some((&*row.quantity, validation::COVERAGE * row.validation.as_ref()?.u_val)))
            .collect()
    }

    /// Adds the discrepancy budget (see [`mod@budget`]) if models B and C are both compared.
    ///
    /// # Errors
    /// As [`budget::budget`].
    pub fn add_budget(&mut self, scene: &Scene) -> Result<()> {
        let summary = |model: Model| {
            let name = model.to_string();
            self.models.iter().find(|m| m.model == name).map(|m| &m.summary)
        };
        if let (Some(b), Some(c)) = (summary(Model::B), summary(Model::C)) {
            self.budget = budget::budget(scene, &self.reference, b, c)?;
        }
        Ok(())
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
pub const AMONG: &str = "Largest discrepancy: the largest relative one among the single numbers of the summary (efficiency, velocities, \
    directions, force peaks, impulses, ends of contact, first frequency). Not among them are the numbers of contacts, of which \
    one is 100 %, the distances of curves, and the conservation residuals.";

impl ModelComparison {
    /// Of a program that has failed: nothing can be compared, and that is a fail.
    fn without_result(model: String, scene: &Scene, reduced: &Outcome) -> Self {
        ModelComparison {
            model,
            summary: reduced.summary.clone(),
            verdict: Verdict::Fail,
            discrepancies: Vec::new(),
            curves: Vec::new(),
            integrity: integrity::check(scene, reduced),
            aligned: Vec::new(),
        }
    }

    /// The worst of its rows' verdicts and of the soundness of both sides.
    fn judge(&mut self, reference_sound: Verdict) {
        let sound = Verdict::of_soundness(self.integrity.iter().map(|check| check.verdict));
        let rows = self.discrepancies.iter().map(|row| row.verdict);
        self.verdict = Verdict::worst(rows.chain([sound, reference_sound]));
    }

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

/// Compares the results of reduced models with the reference's of the same scene.
///
/// All curves are resampled on the window that the reference fixes (see [`CommonAxis::of_reference`]
/// and [`align`]), so that differently sampled histories don't differ for that reason.
pub fn compare_scene(scene: &Scene, reference: &Outcome, reduced: &[Outcome]) -> SceneComparison {
    let integrity = integrity::check(scene, reference);
    let sound = Verdict::of_soundness(integrity.iter().map(|c| c.verdict));
    let window = CommonAxis::of_reference(reference);
    let flight = landing::of_reference(scene, &reference.summary, reduced);
    let models: Vec<_> = reduced
        .iter()
        .map(|outcome| compare_model(scene, (reference, flight.as_ref()), outcome, window, sound))
        .collect();
    let verdict = Verdict::worst(models.iter().map(|m| m.verdict).chain([sound]));
    SceneComparison {
        scene: scene.name.clone(),
        verdict,
        reference: Summary { flight, ..reference.summary.clone() },
        integrity,
        window,
        models,
        budget: Vec::new(),
        changed_tolerances: Vec::new(),
        measured: None,
        reference_check: None,
    }
}

fn compare_model(
    scene: &Scene,
    (reference, flight): (&Outcome, Option<&FlightSummary>),
    reduced: &Outcome,
    window: Option<CommonAxis>,
    reference_sound: Verdict,
) -> ModelComparison {
    let name = reduced.summary.model.clone().unwrap_or_default();
    if reduced.summary.failure.is_some() {
        return ModelComparison::without_result(name, scene, reduced);
    }
    let none = Tolerances::new();
    let tolerances = scene.tolerances.get(&name).unwrap_or(&none);
    let aligned = window.map_or_else(Vec::new, |w| align(w, &reference.history, &reduced.history));

    let kind = crate::kinds::of(scene);
    let (m, c) = (&reference.summary, &reduced.summary);
    let mut discrepancies = quantities(kind, reference, c, tolerances);
    discrepancies.extend(impacts::rows(m, c, tolerances));
    discrepancies.extend(landing::row([flight, c.flight.as_ref()], tolerances));
    discrepancies.extend(curve_distances(kind.curves(), [reference, reduced], &aligned, tolerances));
    discrepancies.extend(residuals(m, c, tolerances));
    undecided::tell(&mut discrepancies, m);
    let mut integrity = integrity::check(scene, reduced);
    integrity.push(integrity::same_impact(m, c));
    integrity.push(integrity::tolerances_are_used(tolerances, &discrepancies));

    let mut model = ModelComparison {
        model: name,
        summary: reduced.summary.clone(),
        verdict: reference_sound,
        discrepancies,
        curves: aligned.iter().map(CurveMetrics::of).collect(),
        integrity,
        aligned,
    };
    model.judge(reference_sound);
    model
}

/// The rows of the summary's quantities.
fn quantities(
    kind: &dyn crate::kinds::Kind,
    reference: &Outcome,
    reduced: &Summary,
    tolerances: &Tolerances,
) -> Vec<Discrepancy> {
    let row = |&Quantity { name, unit, curve, .. }: &Quantity| {
        let value = reference.summary.value(name);
        let size = value.map_or(f64::NAN, f64::abs);
        // a quantity that belongs to no curve is its own peak
        let peak = curve.and_then(|curve| reference.history.curve(curve)).map_or(size, peak);
        // another program's result need not state it
        let is_open = value.is_none() && reference.summary.source == Source::External;
        let tolerance = tolerances.get(name);
        let row = Discrepancy::new(
            (name, unit),
            (reduced.value(name), value),
            Scales { value: size, peak },
            tolerance.filter(|_| !is_open),
            reference.summary.band(name),
        );
        if is_open && tolerance.is_some() { row.undecided() } else { row }
    };
    kind.quantities().iter().map(row).collect()
}

/// The rows of root mean square and largest distance of every curve; NaN where it can't be measured, undetermined where
/// another program does not give the curve.
fn curve_distances(
    curves: &[Curve],
    sides: [&Outcome; 2],
    aligned: &[AlignedCurve],
    tolerances: &Tolerances,
) -> Vec<Discrepancy> {
    let mut rows = Vec::new();
    for Curve { name, unit, .. } in curves {
        let found = aligned.iter().find(|a| a.quantity == *name);
        let peak = found.map_or(f64::NAN, AlignedCurve::peak);
        let lacks =
            |side: &Outcome| side.summary.source == Source::External && side.history.curve(name).is_none();
        let is_given = !sides.into_iter().any(lacks);
        let is_judged = !lacks(sides[0]);
        let distances = [
            ("rms", found.map_or(f64::NAN, AlignedCurve::rms)),
            ("max", found.map_or(f64::NAN, AlignedCurve::largest_difference)),
        ];
        for (kind, distance) in distances {
            let quantity = format!("{name}_{kind}");
            let tolerance = tolerances.get(&quantity);
            let row = Discrepancy::new(
                (&quantity, unit),
                (Some(distance).filter(|_| is_given), Some(0.0).filter(|_| is_judged)),
                Scales { value: peak, peak },
                tolerance.filter(|_| is_judged),
                sides[0].summary.band(&quantity),
            );
            rows.push(if !is_judged && tolerance.is_some() { row.undecided() } else { row });
        }
    }
    rows
}

/// The rows of the conservation residuals.
fn residuals(m: &Summary, c: &Summary, tolerances: &Tolerances) -> [Discrepancy; 2] {
    let row = |quantity, reduced, reference| {
        Discrepancy::of_residual(quantity, (reduced, reference), tolerances.get(quantity))
    };
    [
        row("energy_residual", c.energy_residual, m.energy_residual),
        row("momentum_residual", c.momentum_residual, m.momentum_residual),
    ]
}
