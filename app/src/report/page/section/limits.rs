//! How near models and reference come to the bounds of the theories behind them.

use crate::comparison::SceneComparison;
use crate::format::{prefixed, significant, with_unit, words};
use crate::report::page::html::scrolled;
use crate::report::page::section::discrepancy::pressures;
use crate::result::{Limit, Summary};
use maud::{Markup, html};

/// Section of a scene's page: a row per measure, a column per model.
pub(crate) fn limits_html(comparison: &SceneComparison) -> Markup {
    let models = || comparison.models.iter().map(|model| &model.summary);
    let summaries: Vec<&Summary> = std::iter::once(&comparison.reference).chain(models()).collect();
    let mut measures: Vec<&Limit> = Vec::new();
    for limit in summaries.iter().flat_map(|summary| &summary.limits) {
        if measures.iter().all(|known| known.measure != limit.measure) {
            measures.push(limit);
        }
    }
    html! {
        @if !measures.is_empty() {
            (scrolled("Assumptions", &html! { table.limits {
                thead { tr {
                    th scope="col" { "measure" } th scope="col" { "holds up to" } th scope="col" { "reference" }
                    @for model in models() { th scope="col" { (model.model.as_deref().unwrap_or_default()) } }
                } }
                tbody { @for limit in &measures { tr data-measure=(limit.measure) {
                    th scope="row" { (words(&limit.measure)) }
                    td { (significant(limit.bound, 2)) }
                    @for summary in &summaries { (value(summary, &limit.measure)) }
                } } }
            } }))
            @for model in models() { (elastic_limit(model)) }
            @if !measures.iter().any(|limit| limit.is_of_yield()) && models().all(|model| model.elastic_limit.is_none()) {
                p { "Elastic limit not checked: no yield strength is specified (" code { "yield_strength" } " of a material)." }
            }
            @if let Some(pressure) = &comparison.reference.contact_pressure { (pressures("Reference", pressure)) }
        }
    }
}

/// Up to which speed a model's contacts stay elastic, where it knows.
fn elastic_limit(model: &Summary) -> Markup {
    let Some(limit) = &model.elastic_limit else { return html! {} };
    let shown = |speed: Option<f64>| {
        speed.map_or("at no speed found".into(), |speed| {
            format!("up to {}", with_unit(speed, prefixed("m/s", speed), 3))
        })
    };
    html! {
        p { "Elastic limit, model " (model.model.as_deref().unwrap_or_default()) ": nothing yields in the outer contact "
            (shown(limit.outer)) ", in the inner one " (shown(limit.inner)) ", of the outer body's speed." }
    }
}

/// A cell; what is beyond its bound stands out.
fn value(summary: &Summary, measure: &str) -> Markup {
    let found = summary.limits.iter().find(|limit| limit.measure == measure);
    html! {
        td data-si=(found.map_or(String::new(), |limit| limit.value.to_string())) {
            @match found {
                Some(limit) if limit.is_exceeded() => span.verdict.fail { (significant(limit.value, 2)) },
                Some(limit) => (significant(limit.value, 2)),
                None => "–",
            }
        }
    }
}
