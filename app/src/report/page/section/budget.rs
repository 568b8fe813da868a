//! The discrepancy budget of a scene as a section of its page and of the Markdown report.

use crate::comparison::SceneComparison;
use crate::comparison::budget::{Part, QuantityBudget};
use crate::format::{Prefixed, minus, prefixed, with_unit, words};
use crate::report::figure::budget::{budget_figure, cause_name};
use crate::report::page::html::{detailed, scrolled};
use crate::report::page::prose::prose;
use maud::{Markup, html};

const EXPLANATION: &str = "What each simplification of the model adds to its difference from the reference. The \
    simplifications are removed one after another, from top to bottom; another order gives other parts. Parts and \
    remainder add up to the difference. The remainder is the best model C, with most modes and the finest mesh, minus the \
    reference. It is explained if it lies within its bound: the uncertainty (95 %) of the reference and the uncertainty of \
    model C, added as independent. Reported, not gated.";

/// Section of the page; nothing if there is no budget.
pub(crate) fn budget_html(comparison: &SceneComparison) -> Markup {
    let rows = &comparison.budget;
    let Some(first) = rows.first() else { return html! {} };
    let open = comparison.open();
    html! {
        p.soft { (EXPLANATION) }
        figure.budget {
            (detailed("Error budget, drawn", &html! { (budget_figure(rows, &open)) }))
            figcaption { "Relative to the reference, one scale for all. Thin line: uncertainty of a part. "
                "Grey: bound of the remainder" @if !open.is_empty() { ", and 2 u_val with uncertain inputs" } "." }
        }
        (scrolled("Error budget", &html! { table.budget {
            thead { tr {
                th scope="col" { "cause" }
                @for row in rows { th scope="col" { (words(&row.quantity)) } }
            } }
            tbody {
                tr { th scope="row" { "model " (first.model) " − reference" } @for row in rows { (cell(row, "difference", row.difference, None)) } }
                @for (k, part) in first.parts.iter().enumerate() {
                    tr data-cause=(part.cause) {
                        th scope="row" title=(part.switch) { (cause_name(&part.cause)) }
                        @for row in rows {
                            @let Part { value, uncertainty, .. } = row.parts[k];
                            (cell(row, &part.cause, value, Some(uncertainty)))
                        }
                    }
                }
                tr { th scope="row" { "remainder" } @for row in rows { (cell(row, "remainder", row.remainder, None)) } }
                tr { th scope="row" { "uncertainty (95 %) of the reference" }
                    @for row in rows { (cell(row, "reference_uncertainty", row.reference_uncertainty.unwrap_or(f64::NAN), None)) } }
                tr { th scope="row" { "uncertainty of C" }
                    @for row in rows { (cell(row, "model_uncertainty", row.model_uncertainty, None)) } }
                tr { th scope="row" { "explained" }
                    @for row in rows { td { span class=(format!("verdict {}", row.explained)) { (explained(row)) } } } }
            }
        } }))
        ul.soft { @for part in &first.parts { li { (cause_name(&part.cause)) ": " (prose(&part.switch)) } } }
    }
}

fn explained(row: &QuantityBudget) -> &'static str {
    if row.explained.passed() { "yes" } else { "no" }
}

fn cell(row: &QuantityBudget, field: &str, value: f64, uncertainty: Option<f64>) -> Markup {
    let si = if value.is_finite() { value.to_string() } else { String::new() };
    html! { td data-quantity=(row.quantity) data-field=(field) data-si=(si) { (shown(row, value, uncertainty)) } }
}

fn scale(row: &QuantityBudget) -> Prefixed {
    prefixed(&row.unit, row.reference.abs().max(row.difference.abs()))
}

fn shown(row: &QuantityBudget, value: f64, uncertainty: Option<f64>) -> String {
    let to = scale(row);
    // numbers of one column have the same decimals: four digits of the reference
    let largest = row.reference.abs().max(row.difference.abs()) * to.factor;
    let decimals = if largest > 0.0 { (4 - largest.log10().floor() as i32).clamp(0, 9) as usize } else { 4 };
    if !value.is_finite() {
        return "–".into();
    }
    let fixed = |value: f64| {
        let text = format!("{:.decimals$}", value * to.factor);
        let zero = text.bytes().all(|b| matches!(b, b'-' | b'.' | b'0'));
        if zero { text.replace('-', "") } else { minus(&text) }
    };
    let unit = if to.unit.is_empty() { String::new() } else { format!(" {}", to.unit) };
    match uncertainty {
        Some(u) => format!("{} ± {}{unit}", fixed(value), fixed(u)),
        None => format!("{}{unit}", fixed(value)),
    }
}

/// Section of the Markdown report; nothing if there is no budget.
pub(crate) fn budget_markdown(rows: &[QuantityBudget]) -> String {
    let Some(first) = rows.first() else { return String::new() };
    let line = |name: &str, cell: &dyn Fn(&QuantityBudget) -> String| {
        let cells: String = rows.iter().map(|row| format!(" {} |", cell(row))).collect();
        format!("| {name} |{cells}\n")
    };
    let mut text = format!("\n### Error budget\n\n{EXPLANATION}\n\n");
    text += &line("cause", &|row| words(&row.quantity));
    text += &format!("|---|{}\n", "--:|".repeat(rows.len()));
    text += &line("reference", &|row| with_unit(row.reference, scale(row), 5));
    text += &line(&format!("model {} − reference", first.model), &|row| shown(row, row.difference, None));
    for (k, part) in first.parts.iter().enumerate() {
        let cell = |row: &QuantityBudget| shown(row, row.parts[k].value, Some(row.parts[k].uncertainty));
        text += &line(&cause_name(&part.cause), &cell);
    }
    text += &line("remainder", &|row| shown(row, row.remainder, Some(row.bound)));
    text += &line("explained", &|row| explained(row).to_owned());
    text += "\nThe uncertainty of the remainder is its bound.\n\n";
    for part in &first.parts {
        text += &format!("- {}: {}\n", cause_name(&part.cause), part.switch);
    }
    text
}
