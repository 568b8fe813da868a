//! The report: one result type, [`Report`], and an exporter per format that reads it.
//!
//! Nothing here computes physics, and nothing depends on the time of day: the same results give
//! the same files.

mod attachments;
mod ci;
mod conclusion;
mod existing;
mod export;
mod figure;
mod kinds;
mod overview;
mod page;
mod run_times;
mod summary_column;
mod terminal;
mod trust;
mod write;

pub use attachments::{Attachments, Cost};
pub use ci::github;
pub(crate) use ci::junit::in_words as row_in_words;
pub use ci::junit::junit;
pub use ci::markdown::markdown;
pub use export::{Export, FigureFile, curves_csv, figure_format, history_format, json};
pub use figure::curves::curves_chart;
pub use figure::propagated::propagation_figure;
pub use figure::scene::{FIGURE_WIDTHS, figure, measured_figure, printed_figure};
pub use figure::sweep::{Drawn, sweep_figure};
pub use kinds::{Arrow, seat_picture};
pub use page::index::index_page;
pub use page::live::{LiveScene, embed_live, has_live, live_page};
pub use page::model::{body_page, model_page};
pub use page::moves::moves_page;
pub use page::scene::scene_page;
pub use page::section::measured::efficiency_figure;
pub use page::unit::unit_page;
pub use terminal::{Width, alone, measured_alone, terminal};
pub use write::{check_writable, write, write_measured};

pub use crate::plot::Theme;

use crate::comparison::{Comparison, GateRules, SceneComparison};
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

    /// Scenes in which models were compared with references, the same for all scenes of the report.
    pub(crate) fn validated(&self) -> &[Validation] {
        self.scenes.first().map_or(&[], |scene| &scene.attachments.validated)
    }

    /// Which features of scenes are compared with what, if that is known.
    fn coverage(&self) -> Option<&Coverage> {
        self.scenes.first().and_then(|scene| scene.attachments.coverage.as_deref())
    }
}
