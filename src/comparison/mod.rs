//! Comparison: reduced models against the reference, quantity by quantity and curve by curve,
//! and the verdict.
//!
//! The verdict of a model is fail if a discrepancy exceeds its tolerance, if a value is not a
//! number, or if one of the two results contradicts itself ([`Check`]): a history that does not
//! belong to its summary proves nothing, whatever the summary says.

mod alignment;
mod balance;
pub mod budget;
mod curve_metrics;
mod discrepancy;
mod dynamic_time_warping;
mod inner_products;
mod integrity;
mod interpolation;
mod iso18571;
mod russell;
mod sprague_geers;
mod verdict;

pub use alignment::{AlignedCurve, CommonAxis, SampledCurve, align, sample};
pub use curve_metrics::CurveMetrics;
pub use discrepancy::{BandVerdict, Discrepancy};
pub use integrity::Check;
pub(crate) use interpolation::MonotoneCubic;
pub use iso18571::{Grade, Iso18571, iso18571};
pub use russell::{Russell, russell};
pub use sprague_geers::{SpragueGeers, sprague_geers};
pub use verdict::Verdict;

use crate::error::Result;
use crate::impact::{CURVES, Outcome, PLATE_QUANTITIES, SCHEMA_VERSION, Summary};
use crate::measured::Measured;
use crate::scene::{Model, Scene, Tolerances};
use budget::QuantityBudget;
use discrepancy::Scales;
use serde::Serialize;

/// The document of `compare` and `gate`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Fail if any scene fails.
    pub verdict: Verdict,
    /// One entry per scene.
    pub scenes: Vec<SceneComparison>,
}

impl Comparison {
    /// The document of these scenes.
    pub fn new(scenes: Vec<SceneComparison>) -> Self {
        let verdict = Verdict::all(scenes.iter().map(|s| s.verdict));
        Comparison { schema_version: SCHEMA_VERSION, verdict, scenes }
    }
}

/// One scene: its reference and the reduced models compared with it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneComparison {
    /// Name of the scene.
    pub scene: String,
    /// Fail if any model fails or the reference contradicts itself.
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
    /// Measured records beside reference and models, if there are any; reported, not gated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measured: Option<Measured>,
}

impl SceneComparison {
    /// Adds checks of the reference; one that fails makes the scene and all its models fail.
    pub fn add_reference_checks(&mut self, checks: Vec<Check>) {
        if checks.iter().any(|check| !check.verdict.passed()) {
            self.verdict = Verdict::Fail;
            self.models.iter_mut().for_each(|model| model.verdict = Verdict::Fail);
        }
        self.integrity.extend(checks);
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
    /// Fail if any row or check fails, those of the reference included.
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

impl ModelComparison {
    /// The row called `quantity`.
    pub fn discrepancy(&self, quantity: &str) -> Option<&Discrepancy> {
        self.discrepancies.iter().find(|d| d.quantity == quantity)
    }

    /// The quantity of the summary that lies furthest from the reference, relatively; numbers of
    /// contacts aside, of which one is 100 %.
    pub fn largest(&self) -> Option<&Discrepancy> {
        self.discrepancies
            .iter()
            .filter(|d| PLATE_QUANTITIES.iter().any(|(name, _)| *name == d.quantity))
            .filter(|d| d.relative.is_some() && !d.quantity.ends_with("_contacts"))
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

    /// Number of rows that have a tolerance.
    pub fn gated(&self) -> usize {
        self.discrepancies.iter().filter(|d| d.tolerance.is_some()).count()
    }
}

/// Compares the results of reduced models with the reference's of the same scene.
///
/// All curves are resampled on the window that the reference fixes (see [`CommonAxis::of_reference`]
/// and [`align`]), so that differently sampled histories don't differ for that reason.
pub fn compare_scene(scene: &Scene, reference: &Outcome, reduced: &[Outcome]) -> SceneComparison {
    let integrity = integrity::check(scene, reference);
    let sound = Verdict::all(integrity.iter().map(|c| c.verdict));
    let window = CommonAxis::of_reference(reference);
    let models: Vec<_> =
        reduced.iter().map(|outcome| compare_model(scene, reference, outcome, window, sound)).collect();
    let verdict = Verdict::all(models.iter().map(|m| m.verdict).chain([sound]));
    SceneComparison {
        scene: scene.name.clone(),
        verdict,
        reference: reference.summary.clone(),
        integrity,
        window,
        models,
        budget: Vec::new(),
        measured: None,
    }
}

fn compare_model(
    scene: &Scene,
    reference: &Outcome,
    reduced: &Outcome,
    window: Option<CommonAxis>,
    reference_sound: Verdict,
) -> ModelComparison {
    let name = reduced.summary.model.clone().unwrap_or_default();
    let none = Tolerances::new();
    let tolerances = name.parse::<Model>().ok().and_then(|m| scene.tolerances.get(&m)).unwrap_or(&none);
    let aligned = window.map_or_else(Vec::new, |w| align(w, &reference.history, &reduced.history));

    let mut discrepancies = quantities(reference, reduced, tolerances);
    discrepancies.extend(curve_distances(reference, &aligned, tolerances));
    discrepancies.extend(residuals(&reference.summary, &reduced.summary, tolerances));
    let mut integrity = integrity::check(scene, reduced);
    integrity.push(integrity::same_impact(&reference.summary, &reduced.summary));
    integrity.push(integrity::tolerances_are_used(tolerances, &discrepancies));

    let rows = discrepancies.iter().map(|d| d.verdict);
    let verdict = Verdict::all(rows.chain(integrity.iter().map(|c| c.verdict)).chain([reference_sound]));
    ModelComparison {
        model: name,
        summary: reduced.summary.clone(),
        verdict,
        discrepancies,
        curves: aligned.iter().map(CurveMetrics::of).collect(),
        integrity,
        aligned,
    }
}

/// The rows of the summary's quantities.
fn quantities(reference: &Outcome, reduced: &Outcome, tolerances: &Tolerances) -> Vec<Discrepancy> {
    let (m, c) = (&reference.summary, &reduced.summary);
    let row = |(quantity, unit): (&str, &str)| {
        let value = |s: &Summary| s.quantities.get(quantity).unwrap_or(f64::NAN);
        // `outer_force_peak` belongs to the curve `outer_force`, and so on; a quantity that
        // belongs to none is its own peak.
        let curve = CURVES.iter().find(|(curve, _)| quantity.starts_with(curve));
        let peak =
            curve.and_then(|(name, _)| reference.history.curve(name)).map_or(value(m).abs(), alignment::peak);
        Discrepancy::new(
            (quantity, unit),
            (value(c), value(m)),
            Scales { value: value(m).abs(), peak },
            tolerances.get(quantity),
            m.uncertainty.get(quantity).copied(),
        )
    };
    PLATE_QUANTITIES.into_iter().map(row).collect()
}

/// The rows of root mean square and largest distance of every curve; NaN where it can't be measured.
fn curve_distances(
    reference: &Outcome,
    aligned: &[AlignedCurve],
    tolerances: &Tolerances,
) -> Vec<Discrepancy> {
    let mut rows = Vec::with_capacity(2 * CURVES.len());
    for (curve, unit) in CURVES {
        let found = aligned.iter().find(|a| a.quantity == curve);
        let peak = found.map_or(f64::NAN, AlignedCurve::peak);
        let distances = [
            ("rms", found.map_or(f64::NAN, AlignedCurve::rms)),
            ("max", found.map_or(f64::NAN, AlignedCurve::largest_difference)),
        ];
        for (kind, distance) in distances {
            let quantity = format!("{curve}_{kind}");
            rows.push(Discrepancy::new(
                (&quantity, unit),
                (distance, 0.0),
                Scales { value: peak, peak },
                tolerances.get(&quantity),
                reference.summary.uncertainty.get(&quantity).copied(),
            ));
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
