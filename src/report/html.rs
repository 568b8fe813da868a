//! The pages: `index.html` with the verdicts, and one page per scene. Self-contained: style and
//! figure are inside, nothing is loaded. Every number carries its SI value in `data-si`.

use super::format::{Prefixed, model_name, percent, prefixed, significant, with_unit, words};
use super::{Report, SceneReport, Theme, figure};
use crate::comparison::{BandVerdict, Check, CurveMetrics, Discrepancy, ModelComparison, Verdict};
use crate::impact::Quantities;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::Value;

const STYLE: &str = include_str!("style.css");

pub(super) fn page(title: &str, body: &Markup) -> String {
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body { main { (body) } }
        }
    }
    .into_string()
}

pub(super) fn badge(verdict: Verdict) -> Markup {
    html! { span class=(format!("verdict {verdict}")) { (verdict) } }
}

/// A cell with a number: SI value in `data-si`, shown with its prefix. Empty `data-si` = not a number.
fn number(field: &str, value: Option<f64>, to: Prefixed, digits: usize) -> Markup {
    let finite = value.filter(|v| v.is_finite());
    html! {
        td data-field=(field) data-si=(finite.map_or(String::new(), |v| v.to_string())) {
            (finite.map_or("–".into(), |v| with_unit(v, to, digits)))
        }
    }
}

/// The page with the verdict of every scene and model.
pub fn index_page(report: &Report) -> String {
    let verdict = report.comparison().verdict;
    let body = html! {
        h1 { "impactcheck " (badge(verdict)) }
        p.soft { "Reduced models of an impact against explicit finite elements." }
        div.scroll { table {
            thead { tr {
                th scope="col" { "scene" } th.left scope="col" { "model" } th.left scope="col" { "verdict" }
                th scope="col" { "efficiency" } th scope="col" { "reference" }
                th.left scope="col" { "largest discrepancy" } th scope="col" { "95 % band" }
            } }
            tbody {
                @for scene in &report.scenes {
                    @for model in &scene.comparison.models { (index_row(scene, model)) }
                    @if scene.comparison.models.is_empty() {
                        tr {
                            td { (scene_link(scene)) } td.left { "–" }
                            td.left { (badge(scene.comparison.verdict)) }
                        }
                    }
                }
                @for seat in &report.seats { (super::seal_seat::index_rows(seat)) }
            }
        } }
        p { a href="comparison.json" { "JSON" } " · " a href="comparison.md" { "Markdown" } " · "
            a href="junit.xml" { "JUnit" } }
    };
    page("impactcheck", &body)
}

fn scene_link(scene: &SceneReport) -> Markup {
    html! { a href=(format!("{}.html", scene.comparison.scene)) { (scene.comparison.scene) } }
}

fn index_row(scene: &SceneReport, model: &ModelComparison) -> Markup {
    let plain = prefixed("1", 1.0);
    let largest = model.largest();
    html! {
        tr data-scene=(scene.comparison.scene) data-model=(model.model) {
            td { (scene_link(scene)) }
            td.left { (model_name(&model.model, model.summary.modes)) }
            td.left { (badge(model.verdict)) }
            (number("reduced", Some(model.summary.quantities.efficiency), plain, 4))
            (number("reference", Some(scene.comparison.reference.quantities.efficiency), plain, 4))
            td.left { @if let Some(d) = largest { (words(&d.quantity)) " " (percent(d.relative)) } @else { "–" } }
            @match largest.and_then(|d| d.uncertainty.map(|u| (d, u))) {
                Some((d, u)) => { (number("uncertainty", Some(u), prefixed(&d.unit, d.reference), 2)) }
                None => { td { "–" } }
            }
        }
    }
}

/// The page of one scene.
pub fn scene_page(report: &SceneReport) -> String {
    let comparison = &report.comparison;
    let body = html! {
        p { a href="index.html" { "all scenes" } }
        h1 { (comparison.scene) " " (badge(comparison.verdict)) }
        p.soft { (report.scene.description) }
        @for model in &comparison.models {
            p {
                (badge(model.verdict)) " model " (model_name(&model.model, model.summary.modes))
                @if let Some(d) = model.largest() {
                    ": largest discrepancy " strong { (percent(d.relative)) } " (" (words(&d.quantity)) ")"
                }
                "; " (model.gated()) " of " (model.discrepancies.len()) " rows gated"
            }
        }
        (contradictions("reference", &comparison.integrity))
        figure {
            (PreEscaped(figure(report, Theme::Inline)))
            figcaption {
                "Displacement, velocity and contact force of outer body, plate and inner body, signed along z "
                "(from the inner to the outer side; forces positive in compression). "
                a href=(format!("{}.svg", comparison.scene)) { "SVG" } " · "
                a href=(format!("{}.png", comparison.scene)) { "PNG" } " · "
                a href=(format!("{}.csv", comparison.scene)) { "curves as CSV" }
            }
        }
        (super::budget_section::budget_html(&comparison.budget))
        (super::measured_section::measured_html(report))
        @for model in &comparison.models { (model_section(model)) }
        h2 { "Mesh and solver" }
        (facts(&[
            ("mesh", comparison.reference.mesh.as_ref()),
            ("solver", comparison.reference.solver.as_ref()),
        ]))
        p { "Samples of the reference's history: " (comparison.reference.samples.map_or("–".into(), |n| n.to_string()))
            ", every " (with_unit(
                comparison.reference.sample_interval.unwrap_or(f64::NAN),
                prefixed("s", comparison.reference.sample_interval.unwrap_or(1.0)), 4)) "." }
        details {
            summary { "Checks of the reference against itself (" (comparison.integrity.len()) ")" }
            (checks(&comparison.integrity))
        }
        h2 { "Provenance" }
        p { "Scene hash " code { (comparison.reference.scene_hash) } }
        details {
            summary { "How the reference was made" }
            (facts(&[("", Some(&report.provenance))]))
        }
        h2 { "Make it again" }
        pre { (report.command) }
    };
    page(&format!("{} · impactcheck", comparison.scene), &body)
}

pub(super) fn model_section<Q: Quantities>(model: &ModelComparison<Q>) -> Markup {
    html! {
        h2 { "Model " (model_name(&model.model, model.summary.modes)) " " (badge(model.verdict)) }
        @for warning in &model.summary.warnings { p { strong { "Warning: " } (warning) } }
        (contradictions(&model.model, &model.integrity))
        h3 { "Discrepancies" }
        div.scroll { table.discrepancies data-model=(model.model) {
            thead { tr {
                th scope="col" { "quantity" } th.left scope="col" { "verdict" }
                @for heading in ["reduced", "reference", "difference", "relative", "95 % band", "|E| against u", "tolerance", "bias"] {
                    th scope="col" { (heading) }
                }
            } }
            tbody { @for row in &model.discrepancies { (discrepancy_row(row)) } }
        } }
        p.soft { "Difference is reduced minus reference. A row without tolerance is not gated. Bias is the known "
            "discrepancy about which the tolerance lies. A distance of curves is relative to the reference's peak. "
            "|E| against u (ASME V&V 20): a difference within the reference's 95 % band proves no error of the model." }
        h3 { "Curve metrics" }
        div.scroll { table.curves data-model=(model.model) {
            thead { tr {
                @for heading in ["curve", "Sprague-Geers C", "M", "P", "Russell C", "M", "P", "ISO/TS 18571 R", "Z", "EP", "EM", "ES"] {
                    th scope="col" { (heading) }
                }
                th.left scope="col" { "grade" } th scope="col" { "window" } th scope="col" { "samples" }
            } }
            tbody { @for curve in &model.curves { (curve_row(curve)) } }
        } }
        p.soft { "Sprague-Geers and Russell: comprehensive, magnitude and phase error, 0 is best. ISO/TS 18571: rating, "
            "corridor, phase, magnitude and slope score, 1 is best. Reported, not gated." }
        details {
            summary { "Checks of the result against itself (" (model.integrity.len()) ")" }
            (checks(&model.integrity))
        }
    }
}

fn discrepancy_row(row: &Discrepancy) -> Markup {
    let to = prefixed(&row.unit, row.reference.abs().max(row.reduced.abs()));
    html! {
        tr data-quantity=(row.quantity) {
            td { (words(&row.quantity)) }
            td.left {
                @if row.tolerance.is_none() && row.verdict.passed() { span.soft { "not gated" } }
                @else { (badge(row.verdict)) }
            }
            (number("reduced", Some(row.reduced), to, 5))
            (number("reference", Some(row.reference), to, 5))
            (number("difference", Some(row.difference), to, 3))
            td data-field="relative" data-si=(row.relative.map_or(String::new(), |r| r.to_string())) {
                (percent(row.relative))
            }
            (number("uncertainty", row.uncertainty, to, 2))
            td.left data-field="band_verdict" { (row.band_verdict.map_or("–", BandVerdict::words)) }
            (number("tolerance", row.tolerance, to, 3))
            (number("bias", row.bias, to, 3))
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
            td { (words(&curve.quantity)) }
            @for (field, value) in scores { (number(field, value, prefixed("1", 1.0), 3)) }
            td.left { (curve.grade.map_or("–".into(), |g| g.to_string())) }
            td { (significant(curve.window[0] * time.factor, 4)) " to " (with_unit(curve.window[1], time, 4)) }
            td { (curve.samples) }
        }
    }
}

/// What a result contradicts itself in, in plain sight.
pub(super) fn contradictions(source: &str, checks: &[Check]) -> Markup {
    let failed: Vec<_> = checks.iter().filter(|c| !c.verdict.passed()).collect();
    html! {
        @if !failed.is_empty() {
            p { (badge(Verdict::Fail)) " The result of " (source) " contradicts itself or its scene:" }
            ul { @for check in failed { li { (super::junit::integrity_failure(check)) } } }
        }
    }
}

pub(super) fn checks(checks: &[Check]) -> Markup {
    html! {
        div.scroll { table.checks {
            thead { tr {
                @for heading in ["check", "found", "expected", "bound"] { th scope="col" { (heading) } }
                th.left scope="col" { "verdict" }
            } }
            tbody { @for check in checks {
                @let to = prefixed(&check.unit, check.expected.abs().max(check.found.abs()));
                tr data-check=(check.check) {
                    td { (words(&check.check)) }
                    (number("found", Some(check.found), to, 5))
                    (number("expected", Some(check.expected), to, 5))
                    (number("bound", Some(check.bound), to, 3))
                    td.left { (badge(check.verdict)) }
                }
            } }
        } }
    }
}

/// A table of what nested JSON says, a row per leaf.
pub(super) fn facts(of: &[(&str, Option<&Value>)]) -> Markup {
    let mut rows = Vec::new();
    for (name, value) in of {
        if let Some(value) = value {
            flatten(name, value, &mut rows);
        }
    }
    html! {
        @if rows.is_empty() { p { "–" } } @else {
            div.scroll { table.facts { tbody {
                @for (name, value) in rows { tr { td { (name) } td { (value) } } }
            } } }
        }
    }
}

fn flatten(name: &str, value: &Value, rows: &mut Vec<(String, String)>) {
    match value {
        Value::Null => {}
        Value::Object(fields) => {
            for (key, value) in fields {
                let name = [name, key].into_iter().filter(|p| !p.is_empty()).collect::<Vec<_>>();
                flatten(&name.join(" · ").replace('_', " "), value, rows);
            }
        }
        Value::String(text) => rows.push((name.to_owned(), text.clone())),
        other => rows.push((name.to_owned(), other.to_string())),
    }
}
