//! The page of one plate impact: verdict, interactive panels, discrepancies, budget, mesh and stress, provenance.

use super::discrepancy_section::model_section;
use super::figure::phone_figure;
use super::format::{prefixed, with_unit};
use super::html::page;
use super::page_data::{Shown, plate_panels};
use super::{SceneReport, Theme, figure, interactive, page_end};
use maud::{Markup, html};

/// The page of one scene.
pub fn scene_page(report: &SceneReport) -> String {
    let comparison = &report.comparison;
    let reference = &comparison.reference;
    let body = html! {
        (page_end::head(report.scene, comparison))
        (curves(report))
        @for model in &comparison.models { (model_section(model)) }
        (super::budget_section::budget_html(&comparison.budget))
        (super::measured_section::measured_html(report))
        h2 { "Mesh and solver" }
        @match super::mesh_section::mesh_html(report) {
            Ok(pictures) => (pictures),
            Err(error) => p { (error) },
        }
        (page_end::numbers(comparison))
        p { "Samples of the reference's history: " (reference.samples.map_or("–".into(), |n| n.to_string())) ", every "
            (with_unit(
                reference.sample_interval.unwrap_or(f64::NAN),
                prefixed("s", reference.sample_interval.unwrap_or(1.0)), 4)) "." }
        (page_end::end(comparison, &report.attachments, &report.provenance, &report.command))
    };
    let shown = Shown {
        window: comparison.window,
        reference: report.reference,
        reduced: report.reduced,
        bands: report.attachments.bands.as_ref(),
    };
    let scripts = interactive::scripts(comparison, &shown, &plate_panels());
    page(&format!("{} · impactcheck", comparison.scene), &[interactive::STYLE], &body, &scripts)
}

fn curves(report: &SceneReport) -> Markup {
    let scene = &report.comparison.scene;
    html! {
        h2 { "Curves" }
        (interactive::panels(&figure(report, Theme::Inline), &phone_figure(report)))
        p.soft {
            "Displacement, velocity and contact force of outer body, plate and inner body, signed along z "
            "(from the inner to the outer side; forces positive in compression). Shaded: the 95 % band of the reference. "
            a href=(format!("{scene}.svg")) { "SVG" } " · "
            a href=(format!("{scene}.png")) { "PNG" } " · "
            a href=(format!("{scene}.csv")) { "curves as CSV" }
        }
    }
}
