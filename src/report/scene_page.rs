//! The page of one plate impact: verdict, interactive panels, discrepancies, budget, mesh and stress, provenance.

use super::attachments::instant_of_peak;
use super::discrepancy_section::model_section;
use super::figure::phone_figure;
use super::format::{prefixed, with_unit};
use super::html::page;
use super::page_data::plate_panels;
use super::presentation::{Column, Drawing, Presentation};
use super::{Attachments, SceneReport, Theme, figure, interactive, page_end};
use crate::reference::Stored;
use maud::{Markup, html};

/// How a plate impact is shown.
pub(super) struct Plate;

impl Presentation for Plate {
    fn columns(&self) -> &'static [Column] {
        const COLUMNS: [Column; 5] = [
            Column::new("efficiency", "efficiency"),
            Column::new("outer peak", "outer_force_peak"),
            Column::new("inner peak", "inner_force_peak"),
            Column::new("outer end", "outer_contact_end"),
            Column::new("inner end", "inner_contact_end"),
        ];
        &COLUMNS
    }

    fn attachments(&self, stored: &Stored) -> Attachments {
        let peak = instant_of_peak(&stored.outcome.history, "outer_force");
        Attachments {
            mesh: stored.mesh().ok(),
            stress: stored.stress_near(peak).ok().flatten(),
            ..Attachments::default()
        }
    }

    fn drawings(&self, report: &SceneReport) -> Vec<Drawing> {
        let drawing = |ending, caption, svg| Drawing { ending, caption, svg };
        let curves = figure(report, Theme::Standalone);
        let measured = super::measured_figure(report, Theme::Standalone);
        let efficiencies = super::efficiency_figure(report);
        let curves = drawing("", Some("Displacement, velocity and contact force"), curves);
        let measured = measured.map(|svg| drawing("-measured", None, svg));
        let efficiencies = efficiencies.map(|svg| drawing("-efficiencies", None, svg));
        [Some(curves), measured, efficiencies].into_iter().flatten().collect()
    }

    fn page(&self, report: &SceneReport) -> String {
        page_of(report)
    }
}

fn page_of(report: &SceneReport) -> String {
    let comparison = &report.comparison;
    let reference = &comparison.reference;
    let body = html! {
        (page_end::head(report))
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
        (page_end::end(report))
    };
    let scripts = interactive::scripts(report, &plate_panels());
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
