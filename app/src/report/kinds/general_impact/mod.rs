//! How an impact on a wall, an elastic body or another body is shown.

mod body;
mod picture;

use super::{Drawing, Presentation};
use crate::reference::Stored;
use crate::report::SceneReport;
use crate::report::attachments::{Attachments, instant_of_peak};
use crate::report::figure::geometry::PanelOf;
use crate::report::figure::scene::MOTION;
use crate::report::page::section::{self, Section};
use crate::report::summary_column::SummaryColumn;
use crate::result::Summary;
use crate::scene::Scene;
use maud::{Markup, html};

pub(super) struct Direct;

impl Presentation for Direct {
    fn columns(&self) -> &'static [SummaryColumn] {
        const COLUMNS: [SummaryColumn; 6] = [
            SummaryColumn::new("efficiency", "", "efficiency", "efficiency"),
            SummaryColumn::new("restitution", "", "restitution", "outer_restitution"),
            SummaryColumn::new("peak force", "", "peak force", "outer_force_peak"),
            SummaryColumn::new("inner peak force", "", "inner peak force", "inner_force_peak"),
            SummaryColumn::new("contact ends", "", "end of the contact", "outer_contact_end"),
            SummaryColumn::new("impulse", "", "impulse of the contact force", "outer_impulse"),
        ];
        &COLUMNS
    }

    fn panels(&self) -> &'static [PanelOf] {
        const PANELS: [PanelOf; 3] = [
            MOTION[0],
            PanelOf { boxes: false, ..MOTION[1] },
            PanelOf {
                label: "Contact force in N",
                factor: 1.0,
                curves: &[("outer", "outer_force"), ("inner", "inner_force")],
                boxes: false,
            },
        ];
        &PANELS
    }

    fn curves_caption(&self) -> &'static str {
        "Displacement and velocity of the outer body and of the inner one, if there is one, signed along z (from the inner to the outer \
         side), and the contact forces, positive in compression."
    }

    fn attachments(&self, stored: &Stored) -> Attachments {
        let peak = instant_of_peak(&stored.outcome.history, "outer_force");
        Attachments { solid_stress: stored.solid_stress_near(peak).ok().flatten(), ..Attachments::default() }
    }

    fn drawings(&self, report: &SceneReport) -> Vec<Drawing> {
        std::iter::once(Drawing::curves(report)).chain(Drawing::measured(report)).collect()
    }

    fn scene_drawing(&self, report: &SceneReport) -> Markup {
        report.scene.general_impact().map_or_else(|_| html! {}, picture::picture)
    }

    fn measures(&self, scene: &Scene) -> Vec<(String, String)> {
        scene.general_impact().map_or_else(|_| Vec::new(), picture::measures)
    }

    fn body(&self, scene: &Scene, summary: Option<&Summary>) -> Markup {
        body::body_figure(scene, summary, None)
    }

    fn sections(&self, report: &SceneReport) -> Vec<Section> {
        let model = report.comparison.models.first().map(|model| &model.summary);
        let body = body::body_figure(report.scene, model, report.attachments.solid_stress.as_ref());
        vec![
            Section::new("body", "The body", body),
            Section::new("impacts", "Impacts in series", section::impacts::impacts_html(report)),
            Section::new("budget", "Error budget", section::budget::budget_html(&report.comparison)),
        ]
    }
}
