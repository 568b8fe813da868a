//! The report: one result type, [`Report`], and an exporter per format that reads it.
//!
//! Nothing here computes physics, and nothing depends on the time of day: the same results give
//! the same files.

mod acceptance_section;
mod animation_section;
mod attachments;
mod budget_figure;
mod budget_section;
mod chart;
mod colour_map;
pub mod colours;
mod conclusion;
mod coverage_page;
mod curves_chart;
mod curves_csv;
mod dents_section;
mod discrepancy_picture;
mod discrepancy_section;
mod efficiency_boxes;
mod facts;
mod field_raster;
mod figure;
mod figure_file;
mod figure_geometry;
mod figure_lines;
mod figure_panel;
mod figure_residuals;
mod first_screen;
mod flight_section;
pub mod github;
mod history_file;
mod html;
mod impacts_section;
mod index_page;
mod interactive;
mod json;
mod junit;
mod kinds;
mod label_placement;
mod landing_map;
mod limits_section;
mod markdown;
mod measured_section;
mod mesh_section;
mod model_page;
mod moves_page;
mod overview;
mod page_data;
mod pdf;
mod pdf_text;
mod plot_axis;
mod png;
mod polyline;
mod prose;
mod reference_check_section;
mod run_times;
mod scatter_figure;
mod scene_drawing;
mod scene_page;
mod section;
mod section_frame;
mod standing;
mod summary_column;
mod sweep_figure;
mod symmetric_log;
mod terminal;
mod thumbnail;
mod ticks;
mod trend_section;
mod trust;
mod validated_map;
mod validation_section;
mod vibration_chart;
mod write;

pub use animation_section::fields_command;
pub use attachments::{Attachments, Cost};
pub use chart::{ChartPanel, Series, chart};
pub use colour_map::{ColourMap, colour_maps};
pub use curves_chart::curves_chart;
pub use curves_csv::curves_csv;
pub use figure::{FIGURE_WIDTHS, Theme, figure, measured_figure, printed_figure};
pub use figure_file::{FigureFile, FigureFormat, figure_file};
pub use history_file::history_file;
pub use index_page::index_page;
pub use json::json;
pub use junit::junit;
pub(crate) use junit::{integrity_failure as check_failure, told as row_told};
pub use kinds::{Animation, Arrow, film, seat_picture};
pub use markdown::markdown;
pub use measured_section::efficiency_figure;
pub use model_page::model_page;
pub use moves_page::moves_page;
pub use png::png;
pub use scatter_figure::scatter_figure;
pub use scene_page::scene_page;
pub use sweep_figure::{Drawn, sweep_figure};
pub use terminal::{Width, alone, terminal};
pub use write::{check_writable, write};

use crate::comparison::{ChangedTolerance, Comparison, GateRules, SceneComparison};
use crate::coverage::Coverage;
use crate::result::Outcome;
use crate::scene::Scene;
use crate::validated::Validation;

/// Everything the exporters need.
#[derive(Debug, Clone)]
pub struct Report<'a> {
    /// One entry per scene, in the order of the report.
    pub scenes: Vec<SceneReport<'a>>,
    /// What stops at the gate, for those who read the report by machine.
    pub rules: GateRules,
}

/// One scene of the report.
#[derive(Debug, Clone)]
pub struct SceneReport<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its comparison.
    pub comparison: SceneComparison,
    /// Result of the reference.
    pub reference: &'a Outcome,
    /// Results of the reduced models, in the order of `comparison.models`.
    pub reduced: &'a [Outcome],
    /// How the reference was made, as its store says.
    pub provenance: serde_json::Value,
    /// Command line that makes this comparison again.
    pub command: String,
    /// What else there is to show.
    pub attachments: Attachments,
}

impl Report<'_> {
    /// The comparison document of all scenes.
    pub fn comparison(&self) -> Comparison {
        Comparison::new(self.scenes.iter().map(|s| s.comparison.clone()).collect())
    }

    /// Scenes in which models were held against references, the same for all scenes of the report.
    pub(crate) fn validated(&self) -> &[Validation] {
        self.scenes.first().map_or(&[], |scene| &scene.attachments.validated)
    }

    /// Which features of scenes are held against what, if that is known.
    fn coverage(&self) -> Option<&Coverage> {
        self.scenes.first().and_then(|scene| scene.attachments.coverage.as_deref())
    }

    /// A sentence per tolerance that was changed since it was accepted.
    pub fn changed_tolerances(&self) -> impl Iterator<Item = String> {
        let sentences = |scene: &SceneReport| {
            let comparison = &scene.comparison;
            let sentence =
                |changed: &ChangedTolerance| format!("{}: {}", comparison.scene, changed.sentence());
            comparison.changed_tolerances.iter().map(sentence).collect::<Vec<_>>()
        };
        self.scenes.iter().flat_map(sentences)
    }
}
