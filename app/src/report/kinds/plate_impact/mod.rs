//! How a plate impact is shown.

mod picture;

use super::{Drawing, Presentation};
use crate::reference::Stored;
use crate::report::attachments::instant_of_peak;
use crate::report::figure::geometry::PanelOf;
use crate::report::page::section::{self, Section};
use crate::report::summary_column::SummaryColumn;
use crate::report::{Attachments, SceneReport};
use crate::scene::Scene;
use maud::{Markup, html};

pub(super) struct Plate;

const PANELS: [PanelOf; 3] = [
    PanelOf {
        label: "Displacement in µm",
        factor: 1e6,
        curves: &[
            ("outer", "outer_displacement"),
            ("plate", "plate_displacement"),
            ("inner", "inner_displacement"),
        ],
        boxes: false,
    },
    PanelOf {
        label: "Velocity in mm/s",
        factor: 1e3,
        curves: &[("outer", "outer_velocity"), ("plate", "plate_velocity"), ("inner", "inner_velocity")],
        boxes: true,
    },
    PanelOf {
        label: "Contact force in N",
        factor: 1.0,
        curves: &[("outer", "outer_force"), ("inner", "inner_force")],
        boxes: false,
    },
];

impl Presentation for Plate {
    fn columns(&self) -> &'static [SummaryColumn] {
        const COLUMNS: [SummaryColumn; 5] = [
            SummaryColumn::new("efficiency", "", "efficiency", "efficiency"),
            SummaryColumn::new("peak force", "outer", "peak force at the outer contact", "outer_force_peak"),
            SummaryColumn::new("peak force", "inner", "peak force at the inner contact", "inner_force_peak"),
            SummaryColumn::new("contact ends", "outer", "end of the outer contact", "outer_contact_end"),
            SummaryColumn::new("contact ends", "inner", "end of the inner contact", "inner_contact_end"),
        ];
        &COLUMNS
    }

    fn panels(&self) -> &'static [PanelOf] {
        &PANELS
    }

    fn curves_caption(&self) -> &'static str {
        "Displacement, velocity and contact force of outer body, plate and inner body, signed along z (from the inner to the \
         outer side; forces positive in compression)."
    }

    fn attachments(&self, stored: &Stored) -> Attachments {
        let peak = instant_of_peak(&stored.outcome.history, "outer_force");
        Attachments {
            mesh: stored.mesh().ok(),
            stress: stored.stress_near(peak).ok().flatten(),
            dents: stored.dents().unwrap_or_default(),
            ..Attachments::default()
        }
    }

    fn drawings(&self, report: &SceneReport) -> Vec<Drawing> {
        let drawing = |ending, caption, svg| Drawing { ending, caption, svg };
        let impacts = section::impacts::impacts_figure(report)
            .map(|svg| drawing("-impacts", Some("Efficiency over the number of the impact"), svg));
        let dents = section::dents::dents_figure(report).map(|svg| drawing("-dents", None, svg));
        let own = [Some(Drawing::curves(report)), impacts, dents].into_iter().flatten();
        own.chain(Drawing::measured(report)).collect()
    }

    fn scene_drawing(&self, report: &SceneReport) -> Markup {
        report.scene.plate_impact().map_or_else(|_| html! {}, picture::plate_picture)
    }

    fn measures(&self, scene: &Scene) -> Vec<(String, String)> {
        scene.plate_impact().map_or_else(|_| Vec::new(), picture::measures)
    }

    fn sections(&self, report: &SceneReport) -> Vec<Section> {
        let budget = section::budget::budget_html(&report.comparison);
        let dents = section::dents::dents_html(report).unwrap_or_else(|error| html! { p { (error) } });
        vec![
            Section::new("impacts", "Impacts in series", section::impacts::impacts_html(report)),
            Section::new("landing", "Landing", section::flight::flights_html(report)),
            Section::new("dents", "Dents", dents),
            Section::new("budget", "Error budget", budget),
        ]
    }

    fn mesh(&self, report: &SceneReport) -> Markup {
        section::mesh::mesh_html(report).unwrap_or_else(|error| html! { p { (error) } })
    }
}
