//! The reference beside another program's solution: of a scene's page, of the Markdown report and for the terminal.

use crate::comparison::{BandVerdict, ReferenceCheck, ReferenceRow};
use crate::format::{percent, prefixed, significant, with_unit, words};
use crate::report::page::html::{named, number, scrolled};
use maud::{Markup, html};

/// The section of a scene's page; nothing if there is no other solution.
pub(crate) fn reference_check_html(check: Option<&ReferenceCheck>) -> Markup {
    let Some(check) = check else { return html! {} };
    html! {
        p.soft { (in_words(check)) }
        (scrolled("Reference and another program", &html! { table.reference-check {
            thead { tr {
                th scope="col" { "quantity" } th scope="col" { "reference" } th scope="col" { "± (95 %)" }
                th scope="col" { (check.program) } th scope="col" { "± (95 %)" }
                th scope="col" { "difference" } th scope="col" { "relative" } th scope="col" { "joint uncertainty" } th.left scope="col" {}
            } }
            tbody { @for row in &check.rows {
                @let to = prefixed(row.unit, row.reference.abs().max(row.other.abs()));
                tr data-quantity=(row.quantity) {
                    th scope="row" { (named(row.quantity)) }
                    (number("reference", Some(row.reference), to, 5)) (number("uncertainty", Some(row.uncertainty), to, 2))
                    (number("other", Some(row.other), to, 5)) (number("other_uncertainty", Some(row.other_uncertainty), to, 2))
                    (number("difference", Some(row.difference), to, 2)) td { (percent(row.relative)) }
                    (number("joint_band", Some(row.joint_band), to, 2))
                    td.left { span class=(class(row.verdict)) { (said(row.verdict)) } }
                }
            } }
        } }))
    }
}

fn class(verdict: BandVerdict) -> &'static str {
    match verdict {
        BandVerdict::Within => "verdict pass",
        BandVerdict::Beyond => "verdict fail",
    }
}

fn said(verdict: BandVerdict) -> &'static str {
    match verdict {
        BandVerdict::Within => "within",
        BandVerdict::Beyond => "beyond",
    }
}

fn in_words(check: &ReferenceCheck) -> String {
    format!(
        "The same scene solved by {}, with its own uncertainty (95 %). Two solutions agree if they differ by less than both uncertainties together (root of the sum of squares). Here: {}.",
        check.program,
        check.words()
    )
}

/// The same as Markdown; nothing if there is no other solution.
pub(crate) fn reference_check_markdown(check: Option<&ReferenceCheck>) -> String {
    let Some(check) = check else { return String::new() };
    let rows = check.rows.iter().map(|row| {
        let to = prefixed(row.unit, row.reference.abs().max(row.other.abs()));
        let value = |value: f64, band: f64| {
            format!("{} ± {}", with_unit(value, to, 5), significant(band * to.factor, 2))
        };
        let ReferenceRow { reference, uncertainty, other, other_uncertainty, joint_band, .. } = *row;
        format!(
            "| {} | {} | {} | {} | {} | {} |\n",
            words(row.quantity),
            value(reference, uncertainty),
            value(other, other_uncertainty),
            percent(row.relative),
            with_unit(joint_band, to, 2),
            said(row.verdict)
        )
    });
    format!(
        "\n### Reference and {}: {}\n\n| quantity | reference | {} | difference | joint uncertainty | |\n|---|--:|--:|--:|--:|---|\n{}",
        check.program,
        check.words(),
        check.program,
        rows.collect::<String>()
    )
}
