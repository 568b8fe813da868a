//! How the results of a kind of scene are shown, where that differs from kind to kind.

use super::{Attachments, SceneReport, scene_page as plate_impact, seal_seat};
use crate::reference::Stored;
use crate::scene::{Scene, Setup};

/// A column of the table for the terminal.
pub(super) struct Column {
    pub(super) heading: &'static str,
    pub(super) quantity: &'static str,
    /// Whether it is shown in degrees, with differences in degrees, rather than with its unit and differences in per cent.
    pub(super) is_angle: bool,
}

impl Column {
    pub(super) const fn new(heading: &'static str, quantity: &'static str) -> Self {
        Column { heading, quantity, is_angle: false }
    }
}

/// A drawing of a scene, a file of its own.
pub(super) struct Drawing {
    /// What its name adds to that of the scene.
    pub(super) ending: &'static str,
    /// What it shows, in words, if it stands at the head of the scene in Markdown.
    pub(super) caption: Option<&'static str>,
    /// The drawing as a stand-alone SVG.
    pub(super) svg: String,
}

/// What a kind of scene shows.
pub(super) trait Presentation: Sync {
    /// The quantities in the terminal's table.
    fn columns(&self) -> &'static [Column];

    /// What a stored solution has to be drawn.
    fn attachments(&self, stored: &Stored) -> Attachments;

    /// The drawings beside the page.
    fn drawings(&self, report: &SceneReport) -> Vec<Drawing>;

    /// The page.
    fn page(&self, report: &SceneReport) -> String;
}

/// How results of `scene` are shown.
pub(super) fn of(scene: &Scene) -> &'static dyn Presentation {
    match scene.setup {
        Setup::PlateImpact(_) => &plate_impact::Plate,
        Setup::SealSeat(_) => &seal_seat::Seat,
    }
}

/// The page of one scene.
pub fn scene_page(report: &SceneReport) -> String {
    of(report.scene).page(report)
}
