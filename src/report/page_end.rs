//! What the pages of all scenes share: their head, and checks, trends, provenance and the command that makes them again.

use super::Attachments;
use super::discrepancy_section::{checks, contradictions};
use super::facts::facts;
use super::html::{badge, model_line};
use crate::comparison::{AMONG, SceneComparison};
use crate::result::Quantities;
use crate::scene::Scene;
use maud::{Markup, html};

/// Name, verdict and what the reference contradicts itself in.
pub(super) fn head<Q: Quantities>(scene: &Scene, comparison: &SceneComparison<Q>) -> Markup {
    html! {
        nav { a href="index.html" { "all scenes" } }
        h1 { (comparison.scene) " " (badge(comparison.verdict)) }
        p.soft { (scene.description) }
        ul.models { @for model in &comparison.models { li { (model_line(model)) } } }
        p.soft { (AMONG) }
        (contradictions("reference", &comparison.integrity))
    }
}

/// Mesh and solver of the reference in numbers.
pub(super) fn numbers<Q: Quantities>(comparison: &SceneComparison<Q>) -> Markup {
    let reference = &comparison.reference;
    html! {
        details {
            summary { "Mesh and solver in numbers (SI units)" }
            (facts(&[("mesh", reference.mesh.as_ref()), ("solver", reference.solver.as_ref())]))
        }
    }
}

/// The end of the page.
pub(super) fn end<Q: Quantities>(
    comparison: &SceneComparison<Q>,
    attachments: &Attachments,
    provenance: &serde_json::Value,
    command: &str,
) -> Markup {
    html! {
        details {
            summary { "Checks of the reference against itself (" (comparison.integrity.len()) ")" }
            (checks(&comparison.integrity))
        }
        (super::trend_section::trends_html(attachments))
        (super::acceptance_section::acceptances_html(attachments, &comparison.changed_tolerances))
        h2 { "Provenance" }
        p { "Scene hash " code { (comparison.reference.scene_hash) } }
        details {
            summary { "How the reference was made" }
            (facts(&[("", Some(provenance))]))
        }
        h2 { "Make it again" }
        pre tabindex="0" { (command) }
    }
}
