//! Discrepancies, curve metrics and checks of one reduced model as tables of the page.

use crate::comparison::{BandVerdict, Check, Discrepancy, ModelComparison, Verdict};
use crate::curves::CurveMetrics;
use crate::format::{percent, prefixed, significant, with_unit, words};
use crate::report::page::html::{badge, named, number, scrolled};
use crate::report::page::prose::prose;
use crate::result::{ContactPatch, ContactPressure};
use maud::{Markup, html};

/// What there is to say of one model; its tables fold.
pub(crate) fn model_section(model: &ModelComparison) -> Markup {
    let common_mesh = model.is_on_common_mesh();
    html! {
        @for warning in &model.summary.warnings { p { strong { "Warning: " } (prose(warning)) } }
        (contradictions(&model.model, &model.integrity))
        (undecided(&model.discrepancies))
        @if let Some(pressure) = &model.summary.contact_pressure { (pressures("Model", pressure)) }
        details { summary { "All " (model.discrepancies.len()) " quantities" }
        (scrolled(&format!("Discrepancies of model {}", model.model), &html! { table.discrepancies data-model=(model.model) {
            thead { tr {
                th scope="col" { "quantity" } th.left scope="col" { "verdict" }
                @for heading in ["relative", "tolerance", "bias", "reduced", "reference", "difference", "uncertainty (95 %)"] {
                    th scope="col" { (heading) }
                }
                @if common_mesh { th scope="col" { "of the difference" } }
                th scope="col" { "|E| against u" }
            } }
            tbody { @for row in &model.discrepancies { (discrepancy_row(row, common_mesh)) } }
        } }))
        p.soft { "Difference is reduced minus reference. A row without tolerance is not gated. Bias is the declared "
            "error of the model; the tolerance applies to the difference from it. A distance of curves is relative to the reference's peak. "
            "|E| against u (ASME V&V 20): a difference within the uncertainty of the reference shows no error of the model."
            @if common_mesh {
                " Model and reference are solutions on the same mesh and have its error in common: verdicts and u are of the "
                "uncertainty of the difference: three times the change from a mesh with elements 1.5 times as large (Roache's grid convergence index)."
            }
        }
        }
        details { summary { "Curve metrics (" (model.curves.len()) ")" }
        (scrolled(&format!("Curve metrics of model {}", model.model), &html! { table.curves data-model=(model.model) {
            thead { tr {
                @for heading in ["curve", "Sprague-Geers C", "M", "P", "Russell C", "M", "P", "ISO/TS 18571 R", "Z", "EP", "EM", "ES"] {
                    th scope="col" { (heading) }
                }
                th.left scope="col" { "grade" } th scope="col" { "window" } th scope="col" { "samples" }
            } }
            tbody { @for curve in &model.curves { (curve_row(curve)) } }
        } }))
        p.soft { "Sprague-Geers and Russell: comprehensive, magnitude and phase error, 0 is best. ISO/TS 18571: rating, "
            "corridor, phase, magnitude and slope score, 1 is best. Reported, not gated." }
        }
        details {
            summary { "Internal consistency checks (" (model.integrity.len()) ")" }
            (checks(&model.integrity))
        }
    }
}

/// What would decide the rows that are undecided.
fn undecided(rows: &[Discrepancy]) -> Markup {
    let open = || rows.iter().filter_map(|row| Some((row, row.would_decide.as_ref()?)));
    html! {
        @if open().next().is_some() {
            p { (badge(Verdict::Undecided)) " What would decide these quantities:" }
            ul { @for (row, how) in open() { li { (words(&row.quantity)) ": " (prose(how)) } } }
        }
    }
}

/// Contact patches at the force peaks, in a sentence.
pub(crate) fn pressures(source: &str, pressure: &ContactPressure) -> Markup {
    let patch = |of: &ContactPatch| {
        let [radius, highest] = [("m", of.contact_radius), ("Pa", of.maximum_pressure)]
            .map(|(unit, value)| with_unit(value, prefixed(unit, value), 3));
        format!("{highest} at the centre of a patch of radius {radius}")
    };
    html! {
        p { (source) ": contact pressure at the force peaks (Hertz, elastic): outer body " (patch(&pressure.outer)) "; inner body "
            (patch(&pressure.inner)) "." }
    }
}

fn discrepancy_row(row: &Discrepancy, common_mesh: bool) -> Markup {
    let to = prefixed(&row.unit, row.size());
    html! {
        tr data-quantity=(row.quantity) {
            th scope="row" { (named(&row.quantity)) }
            td.left {
                @if row.verdict == Verdict::NotGated { span.soft { (row.verdict) } } @else { (badge(row.verdict)) }
            }
            td data-field="relative" data-si=(row.relative.map_or(String::new(), |r| r.to_string())) {
                (percent(row.relative))
            }
            (number("tolerance", row.tolerance, to, 3))
            (number("bias", row.bias, to, 3))
            (number("reduced", row.reduced, to, 5))
            (number("reference", row.reference, to, 5))
            (number("difference", row.difference, to, 3))
            (number("uncertainty", row.uncertainty, to, 2))
            @if common_mesh { (number("difference_uncertainty", row.difference_uncertainty, to, 2)) }
            td.left data-field="band_verdict" { (row.band_verdict.map_or("–", BandVerdict::words)) }
        }
    }
}

fn curve_row(curve: &CurveMetrics) -> Markup {
    let scores = [
        ("sprague_geers", curve.sprague_geers),
        ("sprague_geers_magnitude", curve.sprague_geers_magnitude),
        ("sprague_geers_phase", curve.sprague_geers_phase),
        ("russell", curve.russell),
        ("russell_magnitude", curve.russell_magnitude),
        ("russell_phase", curve.russell_phase),
        ("iso18571", curve.iso18571),
        ("iso18571_corridor", curve.iso18571_corridor),
        ("iso18571_phase", curve.iso18571_phase),
        ("iso18571_magnitude", curve.iso18571_magnitude),
        ("iso18571_slope", curve.iso18571_slope),
    ];
    let time = prefixed("s", curve.window[1]);
    html! {
        tr data-quantity=(curve.quantity) {
            th scope="row" { (words(&curve.quantity)) }
            @for (field, value) in scores { (number(field, value, prefixed("1", 1.0), 3)) }
            td.left { (curve.grade.map_or("–".into(), |g| g.to_string())) }
            td { (significant(curve.window[0] * time.factor, 4)) " to " (with_unit(curve.window[1], time, 4)) }
            td { (curve.samples) }
        }
    }
}

/// What a result contradicts itself in, in plain sight.
pub(crate) fn contradictions(source: &str, checks: &[Check]) -> Markup {
    let failed: Vec<_> = checks.iter().filter(|c| c.verdict.failed()).collect();
    html! {
        @if !failed.is_empty() {
            p { (badge(Verdict::Fail)) " The result of " (source) " contradicts itself or its scene:" }
            ul { @for check in failed { li { (prose(&check.to_string())) } } }
        }
    }
}

/// The checks of a result against itself.
pub(crate) fn checks(checks: &[Check]) -> Markup {
    html! {
        (scrolled("Checks", &html! { table.checks {
            thead { tr {
                @for heading in ["check", "found", "expected", "bound"] { th scope="col" { (heading) } }
                th.left scope="col" { "verdict" }
            } }
            tbody { @for check in checks {
                @let to = prefixed(&check.unit, check.expected.abs().max(check.found.abs()));
                tr data-check=(check.check) {
                    th scope="row" { (words(&check.check)) }
                    (number("found", Some(check.found), to, 5))
                    (number("expected", Some(check.expected), to, 5))
                    (number("bound", Some(check.bound), to, 3))
                    td.left { (badge(check.verdict)) }
                }
            } }
        } }))
    }
}
