//! The page of one scene: verdict, interactive panels, discrepancies, budget, mesh and stress, provenance.

use super::discrepancy_section::{checks, contradictions, model_section};
use super::facts::facts;
use super::format::{prefixed, with_unit};
use super::html::{badge, model_line, page};
use super::page_data::{curves, embedded};
use super::{SceneReport, Theme, figure};
use maud::{Markup, PreEscaped, html};

/// uPlot by Leon Sorokin, MIT.
const PLOTTING: &str = include_str!("assets/uPlot.iife.min.js");
const PLOTTING_STYLE: &str = include_str!("assets/uPlot.min.css");
const PLOTTING_LICENCE: &str = include_str!("assets/LICENSE.uPlot");
const PANELS: &str = include_str!("assets/panels.js");

/// The page of one scene.
pub fn scene_page(report: &SceneReport) -> String {
    let comparison = &report.comparison;
    let body = html! {
        nav { a href="index.html" { "all scenes" } }
        h1 { (comparison.scene) " " (badge(comparison.verdict)) }
        p.soft { (report.scene.description) }
        ul.models { @for model in &comparison.models { li { (model_line(model)) } } }
        (contradictions("reference", &comparison.integrity))
        (panels(report))
        @for model in &comparison.models { (model_section(model)) }
        (super::budget_section::budget_html(&comparison.budget))
        (super::measured_section::measured_html(report))
        h2 { "Mesh and solver" }
        @match super::mesh_section::mesh_html(report) {
            Ok(pictures) => (pictures),
            Err(error) => p { (error) },
        }
        details {
            summary { "Mesh and solver in numbers (SI units)" }
            (facts(&[
                ("mesh", comparison.reference.mesh.as_ref()),
                ("solver", comparison.reference.solver.as_ref()),
            ]))
        }
        p { "Samples of the reference's history: " (comparison.reference.samples.map_or("–".into(), |n| n.to_string()))
            ", every " (with_unit(
                comparison.reference.sample_interval.unwrap_or(f64::NAN),
                prefixed("s", comparison.reference.sample_interval.unwrap_or(1.0)), 4)) "." }
        details {
            summary { "Checks of the reference against itself (" (comparison.integrity.len()) ")" }
            (checks(&comparison.integrity))
        }
        (super::trend_section::trends_html(&report.attachments))
        (super::acceptance_section::acceptances_html(&report.attachments))
        h2 { "Provenance" }
        p { "Scene hash " code { (comparison.reference.scene_hash) } }
        details {
            summary { "How the reference was made" }
            (facts(&[("", Some(&report.provenance))]))
        }
        h2 { "Make it again" }
        pre tabindex="0" { (report.command) }
    };
    let scripts = html! {
        script type="application/json" id="comparison" { (PreEscaped(embedded(comparison))) }
        @if comparison.window.is_some() {
            script type="application/json" id="curves" { (PreEscaped(embedded(&curves(report)))) }
            script type="text/javascript" { (PreEscaped(script(PLOTTING, PLOTTING_LICENCE))) }
            script type="text/javascript" { (PreEscaped(PANELS)) }
        }
    };
    page(&format!("{} · impactcheck", comparison.scene), &[PLOTTING_STYLE], &body, &scripts)
}

/// A library with its licence in place of the line that names its address.
fn script(library: &str, licence: &str) -> String {
    let code = library.split_once('\n').map_or(library, |(_, code)| code);
    format!("/*! uPlot 1.6.32\n{licence}*/\n{code}")
}

/// The panels: drawn for print and without scripts, made interactive by the script.
fn panels(report: &SceneReport) -> Markup {
    let scene = &report.comparison.scene;
    html! {
        h2 { "Curves" }
        div.live {
            div #controls role="group" aria-label="Curves shown" {}
            div #panels {}
            div #time role="group" aria-label="Time axis of all panels" {}
            p.soft { "Drag across a panel to zoom all of them, double-click to see everything again." }
        }
        figure.drawn { (PreEscaped(figure(report, Theme::Inline))) }
        p.soft {
            "Displacement, velocity and contact force of outer body, plate and inner body, signed along z "
            "(from the inner to the outer side; forces positive in compression). Shaded: the 95 % band of the reference. "
            a href=(format!("{scene}.svg")) { "SVG" } " · "
            a href=(format!("{scene}.png")) { "PNG" } " · "
            a href=(format!("{scene}.csv")) { "curves as CSV" }
        }
    }
}
