//! Accepted changes of tolerances and references, with their reasons.

use crate::comparison::ChangedTolerance;
use crate::format::words;
use crate::report::Attachments;
use crate::report::page::html::scrolled;
use maud::{Markup, html};

/// Section of a scene's page; nothing if nothing was accepted.
pub(crate) fn acceptances_html(attachments: &Attachments, changed: &[ChangedTolerance]) -> Markup {
    let record = &attachments.acceptances;
    if record.is_empty() {
        return html! {};
    }
    html! {
        @if !changed.is_empty() {
            p { "Tolerances changed since, without a reason:" }
            ul { @for c in changed { li {
                "model " (c.model) ", " (words(&c.quantity)) ": accepted " code { (c.accepted) } ", now "
                @match &c.now { Some(now) => code { (now) }, None => "none" }
            } } }
        }
        (scrolled("Accepted changes", &html! { table.accepted {
            thead { tr {
                th scope="col" { "date" } th.left scope="col" { "reason" } th.left scope="col" { "tolerances changed" }
                th.left scope="col" { "reference" }
            } }
            tbody { @for change in record.iter().rev() { tr {
                th scope="row" { (change.date) }
                td.left { (change.reason) }
                td.left {
                    @if change.tolerances.is_empty() { "none" }
                    @else { ul.plain { @for t in &change.tolerances {
                        li { "model " (t.model) ", " (words(&t.quantity)) ": " code { (t.from) } " → " code { (t.to) } }
                    } } }
                }
                td.left { (change.reference.resolution) ", scene " code {
                    (change.reference.scene_hash.chars().take(9).collect::<String>())
                } }
            } } }
        } }))
    }
}
