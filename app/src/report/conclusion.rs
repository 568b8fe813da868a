//! What a comparison comes to, in a sentence or two that a person can repeat: which model agrees with the reference, and how far the
//! others are from it.

use super::summary_column::{SummaryColumn, degrees};
use super::trust::SMALL;
use crate::comparison::{ModelComparison, SceneComparison};
use crate::format::{percent_above, significant};

/// The largest difference of a model among the columns.
struct Largest<'c> {
    column: &'c SummaryColumn,
    /// Relative, or in rad; with its sign.
    off: f64,
}

/// How much a model differs from the reference.
enum Finding<'c> {
    Agrees(Largest<'c>),
    Differs(Largest<'c>),
    /// The model has results, but the reference has none of the columns' values.
    NoReference,
    NoResult,
}

impl Finding<'_> {
    fn of<'c>(
        columns: &'c [SummaryColumn],
        comparison: &SceneComparison,
        model: &ModelComparison,
    ) -> Finding<'c> {
        let offs = columns.iter().filter_map(|column| {
            let off = column.cell(&model.summary, Some(&comparison.reference))?.off?;
            Some(Largest { column, off })
        });
        match offs.max_by(|a, b| a.off.abs().total_cmp(&b.off.abs())) {
            None if columns.iter().any(|column| model.summary.value(column.quantity).is_some()) => {
                Finding::NoReference
            }
            None => Finding::NoResult,
            Some(largest) if largest.off.abs() <= SMALL => Finding::Agrees(largest),
            Some(largest) => Finding::Differs(largest),
        }
    }

    /// Models that are nearer to the reference come first.
    fn order(&self) -> f64 {
        match self {
            Finding::Agrees(largest) | Finding::Differs(largest) => largest.off.abs(),
            Finding::NoReference | Finding::NoResult => f64::INFINITY,
        }
    }
}

/// The sentences on all models of `comparison`, the nearest to the reference first; empty if there is none.
pub(crate) fn conclusion(columns: &[SummaryColumn], comparison: &SceneComparison) -> String {
    let mut findings: Vec<_> = comparison
        .models
        .iter()
        .map(|model| (model.model.as_str(), Finding::of(columns, comparison, model)))
        .collect();
    findings.sort_by(|a, b| a.1.order().total_cmp(&b.1.order()));
    findings.iter().map(|(model, finding)| sentence(model, finding)).collect::<Vec<_>>().join(" ")
}

fn sentence(model: &str, finding: &Finding) -> String {
    match finding {
        Finding::NoReference => {
            format!("Model {model} is not compared: the reference has no value for its main quantities.")
        }
        Finding::NoResult => format!("Model {model} gave no result."),
        Finding::Agrees(Largest { column, off }) if column.is_angle => {
            format!(
                "Model {model} agrees with the reference; its {} differs by {}.",
                column.phrase,
                degrees(*off)
            )
        }
        Finding::Agrees(Largest { off, .. }) => {
            format!("Model {model} agrees with the reference within {}.", percent_above(*off))
        }
        Finding::Differs(Largest { column, off }) if column.is_angle => {
            format!("The {} of model {model} differs by {}.", column.phrase, degrees(*off))
        }
        Finding::Differs(Largest { column, off }) => {
            let estimates = if *off > 0.0 { "overestimates" } else { "underestimates" };
            format!(
                "Model {model} {estimates} the {} by {} %.",
                column.phrase,
                significant(100.0 * off.abs(), 2)
            )
        }
    }
}

/// That the assumptions hold.
pub(crate) const HOLD: &str = "assumptions hold";

/// Whether the assumptions of reference and models hold, as far as that was computed: the second part of a scene's verdict.
pub(crate) fn assumptions(comparison: &SceneComparison) -> Option<&'static str> {
    let mut limits = summaries(comparison).flat_map(|(_, summary)| &summary.limits).peekable();
    limits.peek()?;
    Some(if limits.any(|limit| limit.is_exceeded()) { "assumptions violated" } else { HOLD })
}

/// The results of a comparison with their names, the reference first.
pub(crate) fn summaries(
    comparison: &SceneComparison,
) -> impl Iterator<Item = (&str, &crate::result::Summary)> {
    let models = comparison.models.iter().map(|model| (model.model.as_str(), &model.summary));
    std::iter::once(("reference", &comparison.reference)).chain(models)
}
