//! How the results of a kind of scene are shown, where that differs from kind to kind.

mod general_impact;
mod plate_impact;
mod seal_seat;

pub use seal_seat::{Arrow, seat_picture};

use crate::error::Result;
use crate::kinds::{self, KINDS};
use crate::measured::Measured;
use crate::reference::Stored;
use crate::report::figure::geometry::PanelOf;
use crate::report::page::section::Section;
use crate::report::summary_column::SummaryColumn;
use crate::report::{Attachments, SceneReport, Theme, efficiency_figure, figure, measured_figure};
use crate::result::Summary;
use crate::scene::Scene;
use maud::{Markup, html};

/// Pixels of the PNG per unit of the drawing: 760 units are 2280 px, 300 dpi at a width of 19 cm.
const PNG_SCALE: f32 = 3.0;

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
    /// Its files, for the scene called `scene`: names and contents.
    ///
    /// # Errors
    /// Those of the picture.
    pub(super) fn files(self, scene: &str) -> Result<[(String, Vec<u8>); 2]> {
        let stem = format!("{scene}{}", self.ending);
        let png = crate::plot::png(&self.svg, PNG_SCALE)?;
        Ok([(format!("{stem}.png"), png), (format!("{stem}.svg"), self.svg.into_bytes())])
    }

    /// The curves of model and reference.
    pub(super) fn curves(report: &SceneReport) -> Self {
        let caption = Some("Displacement, velocity and contact force");
        Drawing { ending: "", caption, svg: figure(report, Theme::Standalone) }
    }

    /// The measured motion, and the efficiencies of repeated impacts, if there are records.
    pub(super) fn measured(report: &SceneReport) -> Vec<Self> {
        let measured = report.comparison.measured.as_ref();
        measured.map_or_else(Vec::new, |measured| Self::of_records(&report.comparison.scene, measured))
    }

    /// The same of the scene called `scene`.
    pub(super) fn of_records(scene: &str, measured: &Measured) -> Vec<Self> {
        let drawing = |ending, svg| Drawing { ending, caption: None, svg };
        let motion = drawing("-measured", measured_figure(scene, measured, Theme::Standalone));
        let efficiencies = efficiency_figure(scene, measured).map(|svg| drawing("-efficiencies", svg));
        std::iter::once(motion).chain(efficiencies).collect()
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
