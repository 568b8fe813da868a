//! How the results of a kind of scene are shown, where that differs from kind to kind.

mod general_impact;
mod plate_impact;
mod seal_seat;

pub use seal_seat::{Arrow, seat_picture};

use crate::kinds::{self, KINDS};
use crate::reference::Stored;
use crate::report::figure::geometry::PanelOf;
use crate::report::page::section::Section;
use crate::report::summary_column::SummaryColumn;
use crate::report::{Attachments, SceneReport, Theme, figure};
use crate::result::Summary;
use crate::scene::Scene;
use maud::{Markup, html};

/// A drawing of a scene, a file of its own.
pub(super) struct Drawing {
    /// What its name adds to that of the scene.
    pub(super) ending: &'static str,
    /// What it shows, in words, if it stands at the head of the scene in Markdown.
    pub(super) caption: Option<&'static str>,
    /// The drawing as a stand-alone SVG.
    pub(super) svg: String,
}

impl Drawing {
    /// The curves of model and reference.
    pub(super) fn curves(report: &SceneReport) -> Self {
        let caption = Some("Displacement, velocity and contact force");
        Drawing { ending: "", caption, svg: figure(report, Theme::Standalone) }
    }
}

/// What a kind of scene shows.
pub(super) trait Presentation: Sync {
    /// The quantities that tell a result in short.
    fn columns(&self) -> &'static [SummaryColumn];

    /// The curves, panel by panel.
    fn panels(&self) -> &'static [PanelOf];

    /// What the curves are, in a sentence.
    fn curves_caption(&self) -> &'static str;

    /// What a stored solution has to be drawn.
    fn attachments(&self, _: &Stored) -> Attachments {
        Attachments::default()
    }

    /// The drawings beside the page.
    fn drawings(&self, report: &SceneReport) -> Vec<Drawing> {
        vec![Drawing::curves(report)]
    }

    /// The scene drawn to scale, and what there is to say of the drawing.
    fn scene_drawing(&self, _: &SceneReport) -> Markup {
        html! {}
    }

    /// The scene in numbers: what, and what it measures.
    fn measures(&self, _: &Scene) -> Vec<(String, String)> {
        Vec::new()
    }

    /// A body from a mesh in 3D, with the stress under the force peak of a result; nothing of other scenes.
    fn body(&self, _: &Scene, _summary: Option<&Summary>) -> Markup {
        html! {}
    }

    /// What only this kind shows, behind the models' sections.
    fn sections(&self, _: &SceneReport) -> Vec<Section> {
        Vec::new()
    }

    /// Pictures of mesh and stress of the reference; empty if there are none.
    fn mesh(&self, _: &SceneReport) -> Markup {
        html! {}
    }
}

/// How results of each of [`KINDS`] are shown.
const SHOWN: [&dyn Presentation; KINDS.len()] =
    [&plate_impact::Plate, &seal_seat::Seat, &general_impact::Direct];

/// How results of `scene` are shown.
pub(super) fn of(scene: &Scene) -> &'static dyn Presentation {
    SHOWN[kinds::index(scene)]
}
