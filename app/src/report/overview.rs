//! What tables of several scenes show of each: data of its own, so that it can outlive the run that made it.

use crate::comparison::{Discrepancy, ModelComparison, Verdict};
use crate::format::model_name;
use crate::report::conclusion::{assumptions, conclusion};
use crate::report::figure::course::course;
use crate::report::figure::thumbnail::thumbnail;
use crate::report::{SceneReport, kinds};
use crate::result::Outcome;
use serde::{Deserialize, Serialize};

/// A scene in short.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Overview {
    pub(crate) scene: String,
    pub(crate) description: String,
    /// Folder of its file, as far as it is known.
    #[serde(default)]
    pub(crate) folder: String,
    pub(crate) verdict: Verdict,
    /// What the comparison comes to, in words; and whether the assumptions hold.
    #[serde(default)]
    pub(crate) conclusion: String,
    #[serde(default)]
    pub(crate) assumptions: Option<String>,
    /// When it was compared (UTC), and the command line that compares it again.
    pub(crate) compared: Option<String>,
    pub(crate) command: String,
    pub(crate) models: Vec<ModelOverview>,
    /// Numbers that drift, and numbers recorded over commits.
    pub(crate) drift: [usize; 2],
    /// Path and name of the number that has come furthest.
    #[serde(default)]
    pub(crate) course: Option<[String; 2]>,
}

/// A model of a scene in short.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct ModelOverview {
    pub(crate) model: String,
    /// With its number of modes.
    pub(crate) name: String,
    pub(crate) verdict: Verdict,
    pub(crate) verdict_in_words: String,
    /// Efficiency of the model and of the reference.
    pub(crate) efficiency: [Option<f64>; 2],
    /// See [`crate::comparison::AMONG`].
    pub(crate) largest: Option<RowOverview>,
    /// The gated row nearest to its bound.
    pub(crate) tightest: Option<RowOverview>,
    /// Paths of a curve of the reference and of the model.
    #[serde(default)]
    pub(crate) thumbnail: [String; 2],
    /// Verdicts of the gated rows.
    pub(crate) gated: Vec<Verdict>,
}

/// A row in short.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct RowOverview {
    pub(crate) quantity: String,
    pub(crate) unit: String,
    pub(crate) reference: Option<f64>,
    pub(crate) relative: Option<f64>,
    pub(crate) uncertainty: Option<f64>,
    /// Share of the tolerance.
    pub(crate) used: Option<f64>,
}

impl Overview {
    pub(crate) fn of(report: &SceneReport) -> Self {
        let (comparison, trends) = (&report.comparison, &report.attachments.trends);
        let models = comparison.models.iter().zip(report.reduced);
        Overview {
            scene: comparison.scene.clone(),
            description: report.scene.description.clone(),
            folder: report.attachments.folder.clone(),
            verdict: comparison.verdict,
            conclusion: conclusion(kinds::of(report.scene).columns(), comparison),
            assumptions: assumptions(comparison).map(str::to_owned),
            compared: report.attachments.compared.clone(),
            command: report.command.clone(),
            models: models.map(|(model, outcome)| ModelOverview::of(report, model, outcome)).collect(),
            drift: [trends.iter().filter(|trend| trend.drifts_since.is_some()).count(), trends.len()],
            course: course(trends),
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
