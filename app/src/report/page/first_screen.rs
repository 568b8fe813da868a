//! The first screen of a scene's page: the scene, how far each model can be trusted in it, and the results in short.

use crate::comparison::{ModelComparison, SceneComparison};
use crate::report::conclusion::conclusion;
use crate::report::page::html::{model_badge, named_as, scrolled};
use crate::report::page::prose::prose;
use crate::report::summary_column::SummaryColumn;
use crate::report::trust::{LARGE, SMALL, accuracy, predicted, size_class, validity};
use crate::report::{SceneReport, kinds};
use crate::result::Summary;
use maud::{Markup, html};

pub(crate) fn first_screen(report: &SceneReport) -> Markup {
    let shown = kinds::of(report.scene);
    let (comparison, columns) = (&report.comparison, shown.columns());
    // one model leaves room below its table
    let below = comparison.models.len() == 1;
    let measures = html! {
        dl.measures { @for (what, measures) in shown.measures(report.scene) { div { dt { (what) } dd { (measures) } } } }
    };
    html! {
        div.first {
            div.answer {
                p.conclusion { strong { (conclusion(columns, comparison)) } }
                (scrolled("Results in short", &in_short(columns, comparison)))
                p.soft.note {
                    "Verdict: against the tolerances. Colours show the size of the difference, whatever the verdict: "
                    span.off.small { "up to " (percent(SMALL)) } " " span.off.medium { "up to " (percent(LARGE)) } " "
                    span.off.large { "beyond" } "."
                }
                details { summary { "How far each model can be trusted here" } (trust(columns, report)) }
                @if below { (measures) }
            }
            figure.scene { (shown.scene_drawing(report)) @if !below { (measures) } }
        }
    }
}

fn percent(share: f64) -> String {
    format!("{:.0} %", 100.0 * share)
}

/// A sentence per model; what holds of all of them is said once.
fn trust(columns: &[SummaryColumn], report: &SceneReport) -> Markup {
    let comparison = &report.comparison;
    let models = &comparison.models;
    let of = |model: &ModelComparison| validity(report.scene, &model.summary);
    let common = models.first().map(of).unwrap_or_default();
    let is_common = models.len() > 1 && models.iter().all(|model| of(model) == common);
    let sentence = |model: &ModelComparison| {
        let own = if is_common { Vec::new() } else { of(model) };
        let elsewhere = predicted(report.scene, comparison, model);
        std::iter::once(accuracy(columns, model)).chain(elsewhere).chain(own).collect::<Vec<_>>().join("; ")
    };
    html! {
        ul.trust {
            @for model in models {
                li data-model=(model.model) {
                    strong { (model.model) } ": " (sentence(model))
                    @if !model.summary.warnings.is_empty() { "; " a href=(format!("#model-{}", model.model)) { (warnings(&model.summary)) } }
                    "."
                }
            }
            @if is_common && !common.is_empty() { li { "All: " (common.join("; ")) "." } }
            @for warning in &comparison.reference.warnings { li { strong { "Warning, reference: " } (prose(warning)) } }
        }
    }
}

fn warnings(summary: &Summary) -> String {
    match summary.warnings.len() {
        1 => "1 warning".into(),
        several => format!("{several} warnings"),
    }
}

/// The table that the terminal prints.
fn in_short(columns: &[SummaryColumn], comparison: &SceneComparison) -> Markup {
    let reference = &comparison.reference;
    html! { table.short {
        thead { tr {
            th scope="col" { "source" }
            @for column in columns { th scope="col" { (named_as(&column.label(), column.quantity)) } }
            th.left scope="col" { "verdict" }
        } }
        tbody {
            tr { th scope="row" { "reference" } @for column in columns { (cell(column, reference, None)) } td.left {} }
            @for model in &comparison.models {
                tr data-model=(model.model) {
                    th scope="row" { (model.model) }
                    @for column in columns { (cell(column, &model.summary, Some(reference))) }
                    td.left { (model_badge(model)) }
                }
            }
        }
    } }
}

fn cell(column: &SummaryColumn, summary: &Summary, reference: Option<&Summary>) -> Markup {
    let Some(cell) = column.cell(summary, reference) else { return html! { td { "–" } } };
    html! {
        td data-field=(column.quantity) data-off=[cell.off] {
            span.value { (cell.value) }
            @if let Some((off, in_words)) = cell.off.zip(cell.off_in_words) {
                " " span class=(format!("off {}", size_class(off))) { (in_words) }
            }
        }
    }
}
