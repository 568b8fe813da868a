//! What the differences show when inputs are uncertain: a section of the page, of the Markdown report and lines for the terminal.

use crate::comparison::{Discrepancy, ModelComparison, SceneComparison};
use crate::format::{prefixed, with_unit, words};
use crate::report::page::html::{named, number, scrolled};
use crate::report::page::prose::prose;
use crate::uncertainty::DEFAULT_QUANTITIES;
use crate::uncertainty::validation::{Assessment, Shown, line};
use maud::{Markup, html};

const EXPLANATION: &str = "The scene specifies the uncertainty of its inputs. E = S - D is the difference of a model from the reference, u_val the standard \
    uncertainty with which a measurement of such bodies could be compared: u_val² = u_num² + u_input² + u_D² (ASME V&V 20-2009), of the truncated modes, the inputs and the reference. |E| beyond 2 u_val would be shown as an error of the model by one measurement, |E| within u_val would not. \
    Reference and model have the same nominal inputs, so that the gate does not ask for u_input. Reported, not gated.";

/// Rows of a model that have an assessment.
fn rows(model: &ModelComparison) -> impl Iterator<Item = (&Discrepancy, &Assessment)> {
    model.discrepancies.iter().filter_map(|row| Some((row, row.validation.as_ref()?)))
}

/// Those that are about what everybody wants to know.
fn default_rows(model: &ModelComparison) -> impl Iterator<Item = (&Discrepancy, &Assessment)> {
    rows(model).filter(|(row, _)| DEFAULT_QUANTITIES.contains(&&*row.quantity))
}

/// The inputs that make most of `u_input`, with what they make.
fn largest(row: &Discrepancy, assessment: &Assessment) -> String {
    let to = prefixed(&row.unit, row.size());
    let mut inputs: Vec<(&String, f64)> =
        assessment.parts.inputs.iter().map(|(name, u)| (name, *u)).collect();
    inputs.sort_by(|a, b| b.1.total_cmp(&a.1));
    let shown = inputs.iter().take(3).filter(|(_, u)| *u > 0.1 * assessment.parts.u_input);
    shown.map(|(name, u)| format!("{name} {}", with_unit(*u, to, 2))).collect::<Vec<_>>().join(", ")
}

/// The section of the page; nothing for a scene whose inputs are certain.
pub(crate) fn validation_html(comparison: &SceneComparison) -> Markup {
    if comparison.models.iter().all(|model| rows(model).next().is_none()) {
        return html! {};
    }
    html! {
        p.soft { (EXPLANATION) }
        @for model in &comparison.models {
            (scrolled(&format!("Model {} with uncertain inputs", model.model), &html! { table.validation data-model=(model.model) {
                thead { tr {
                    th scope="col" { "model " (model.model) }
                    @for heading in ["E", "u_val", "u_num", "u_input", "u_D"] { th scope="col" { (heading) } }
                    th.left scope="col" { "shows" } th.left scope="col" { "largest parts of u_input" }
                } }
                tbody { @for (row, of) in rows(model) {
                    @let to = prefixed(&row.unit, row.size());
                    tr data-quantity=(row.quantity) {
                        th scope="row" { (named(&row.quantity)) }
                        (number("error", Some(of.error), to, 3))
                        (number("u_val", Some(of.u_val), to, 2))
                        (number("u_num", of.parts.u_num, to, 2))
                        (number("u_input", Some(of.parts.u_input), to, 2))
                        (number("u_D", of.parts.u_d, to, 2))
                        td.left data-field="shown" { @if of.verdict == Shown::ModelError { strong { (of.verdict.words()) } } @else { (of.verdict.words()) } }
                        td.left { (largest(row, of)) }
                    }
                } }
            } }))
            ul.soft { @for (row, of) in default_rows(model) { li { (prose(&line(&row.quantity, of))) } } }
        }
    }
}

/// The same in Markdown.
pub(crate) fn validation_markdown(comparison: &SceneComparison) -> String {
    let mut text = String::new();
    for model in &comparison.models {
        for (row, of) in rows(model) {
            if text.is_empty() {
                text += &format!(
                    "\n### Uncertain inputs\n\n{EXPLANATION}\n\n| model | quantity | E | u_val | u_num | u_input | u_D | shows | largest parts of u_input |\n|---|---|--:|--:|--:|--:|--:|---|---|\n"
                );
            }
            let to = prefixed(&row.unit, row.size());
            let shown = |value: Option<f64>, digits| value.map_or("–".into(), |v| with_unit(v, to, digits));
            text += &format!(
                "| {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
                model.model,
                words(&row.quantity),
                shown(Some(of.error), 3),
                shown(Some(of.u_val), 2),
                shown(of.parts.u_num, 2),
                shown(Some(of.parts.u_input), 2),
                shown(of.parts.u_d, 2),
                of.verdict.words(),
                largest(row, of)
            );
        }
    }
    text
}

/// A line per model and quantity that everybody wants to know.
pub(crate) fn validation_text(comparison: &SceneComparison) -> String {
    let of_model = |model: &ModelComparison| {
        default_rows(model)
            .map(|(row, of)| format!("  {}: {}\n", model.model, line(&row.quantity, of)))
            .collect::<String>()
    };
    let measured = comparison.measured.iter();
    let comparators = measured.flat_map(|measured| measured.partners.iter().map(|one| (measured.key, one)));
    let of_comparators = comparators.filter_map(|(key, comparator)| {
        // without uncertain inputs the table of the measurement says all
        let of = comparator.validation.as_ref().filter(|of| !of.parts.inputs.is_empty())?;
        Some(format!("  {} against the measurement: {}\n", comparator.partner, line(key, of)))
    });
    comparison.models.iter().map(of_model).chain(of_comparators).collect()
}
