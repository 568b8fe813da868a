//! What the pages of all scenes share: their head, and checks, trends, provenance and the command that makes them again.

use super::SceneReport;
use super::discrepancy_section::{checks, contradictions};
use super::facts::facts;
use super::html::{badge, model_line};
use super::overview::ModelOverview;
use crate::comparison::{AMONG, SceneComparison};
use maud::{Markup, html};

/// Name, verdict and what the reference contradicts itself in.
pub(super) fn head(report: &SceneReport) -> Markup {
    let comparison = &report.comparison;
    html! {
        nav { a href="index.html" { "all scenes" } }
        h1 { (comparison.scene) " " (badge(comparison.verdict)) }
        p.soft { (report.scene.description) }
        ul.models { @for model in &comparison.models { li { (model_line(&ModelOverview::of(comparison, model))) } } }
        p.soft { (AMONG) }
        @for warning in &comparison.reference.warnings { p { strong { "Warning, reference: " } (warning) } }
        (contradictions("reference", &comparison.integrity))
    }
}

/// Mesh and solver of the reference in numbers.
pub(super) fn numbers(comparison: &SceneComparison) -> Markup {
    let reference = &comparison.reference;
    html! {
        details {
            summary { "Mesh and solver in numbers (SI units)" }
            (facts(&[("mesh", reference.mesh.as_ref()), ("solver", reference.solver.as_ref())]))
        }
    }
}

/// The end of the page.
pub(super) fn end(report: &SceneReport) -> Markup {
    let (comparison, attachments) = (&report.comparison, &report.attachments);
    html! {
        details {
            summary { "Checks of the reference against itself (" (comparison.integrity.len()) ")" }
            (checks(&comparison.integrity))
        }
        (super::limits_section::limits_html(comparison))
        (super::trend_section::trends_html(attachments))
        (super::acceptance_section::acceptances_html(attachments, &comparison.changed_tolerances))
        h2 { "Provenance" }
        p { "Scene hash " code { (comparison.reference.scene_hash) } }
        details {
            summary { "How the reference was made" }
            (facts(&[("", Some(&report.provenance))]))
        }
        h2 { "Make it again" }
        pre tabindex="0" { (report.command) }
    }
}
