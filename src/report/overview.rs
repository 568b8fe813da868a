//! What tables of several scenes show of each: data of its own, so that it can outlive the run that made it.

use super::SceneReport;
use super::thumbnail::thumbnail;
use crate::comparison::{Discrepancy, ModelComparison, Verdict};
use crate::format::model_name;
use crate::result::Outcome;
use serde::{Deserialize, Serialize};

/// A scene in short.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Overview {
    pub(super) scene: String,
    pub(super) description: String,
    /// Folder of its file, as far as it is known.
    #[serde(default)]
    pub(super) folder: String,
    pub(super) verdict: Verdict,
    /// When it was compared (UTC), and the command line that compares it again.
    pub(super) compared: Option<String>,
    pub(super) command: String,
    pub(super) models: Vec<ModelOverview>,
    /// Numbers that drift, and numbers recorded over commits.
    pub(super) drift: [usize; 2],
}

/// A model of a scene in short.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct ModelOverview {
    pub(super) model: String,
    /// With its number of modes.
    pub(super) name: String,
    pub(super) verdict: Verdict,
    pub(super) verdict_in_words: String,
    /// Efficiency of the model and of the reference.
    pub(super) efficiency: [Option<f64>; 2],
    /// See [`crate::comparison::AMONG`].
    pub(super) largest: Option<RowOverview>,
    /// The gated row nearest to its bound.
    pub(super) tightest: Option<RowOverview>,
    /// Paths of a curve of the reference and of the model.
    #[serde(default)]
    pub(super) thumbnail: [String; 2],
    /// Verdicts of the gated rows.
    pub(super) gated: Vec<Verdict>,
}

/// A row in short.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct RowOverview {
    pub(super) quantity: String,
    pub(super) unit: String,
    pub(super) reference: Option<f64>,
    pub(super) relative: Option<f64>,
    pub(super) uncertainty: Option<f64>,
    /// Share of the tolerance.
    pub(super) used: Option<f64>,
}

impl Overview {
    pub(super) fn of(report: &SceneReport) -> Self {
        let (comparison, trends) = (&report.comparison, &report.attachments.trends);
        let models = comparison.models.iter().zip(report.reduced);
        Overview {
            scene: comparison.scene.clone(),
            description: report.scene.description.clone(),
            folder: report.attachments.folder.clone(),
            verdict: comparison.verdict,
            compared: report.attachments.compared.clone(),
            command: report.command.clone(),
            models: models.map(|(model, outcome)| ModelOverview::of(report, model, outcome)).collect(),
            drift: [trends.iter().filter(|trend| trend.drifts_since.is_some()).count(), trends.len()],
        }
    }
}

impl ModelOverview {
    fn of(report: &SceneReport, model: &ModelComparison, outcome: &Outcome) -> Self {
        let reference = &report.comparison.reference;
        ModelOverview {
            model: model.model.clone(),
            name: model_name(&model.model, model.summary.modes),
            verdict: model.verdict,
            verdict_in_words: model.verdict_in_words().to_owned(),
            efficiency: [&model.summary, reference].map(|summary| summary.value("efficiency")),
            largest: model.largest().map(RowOverview::of),
            tightest: model.tightest().map(RowOverview::of),
            thumbnail: thumbnail(report, outcome),
            gated: model.gated_verdicts().collect(),
        }
    }
}

impl RowOverview {
    fn of(row: &Discrepancy) -> Self {
        let finite = |value: Option<f64>| value.filter(|v| v.is_finite());
        RowOverview {
            quantity: row.quantity.clone(),
            unit: row.unit.clone(),
            reference: finite(row.reference),
            relative: finite(row.relative),
            uncertainty: finite(row.uncertainty),
            used: finite(row.used()),
        }
    }
}
