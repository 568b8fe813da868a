//! What a report shows besides the comparison, where there is any of it.

use crate::ci::acceptance::Acceptance;
use crate::ci::trend::Trend;
use crate::reference::{CurveBands, FieldMesh, Stored};
use crate::result::Outcome;

/// Nothing of this changes a verdict; all of it may be missing.
#[derive(Debug, Clone, Default)]
pub struct Attachments {
    /// 95 % bands of the reference's curves.
    pub bands: Option<CurveBands>,
    /// Mesh of the reference.
    pub mesh: Option<FieldMesh>,
    /// Stress of the reference at the instant (s) nearest to the outer force's peak.
    pub stress: Option<(f64, FieldMesh)>,
    /// The gated numbers over the commits recorded.
    pub trends: Vec<Trend>,
    /// Changes of tolerances and reference accepted so far, oldest first.
    pub acceptances: Vec<Acceptance>,
}

impl Attachments {
    /// What the store has beside the solution's numbers. Meshes and fields that can't be drawn, those of solids for
    /// instance, are left out.
    pub fn of(stored: &Stored) -> Self {
        Attachments {
            bands: stored.bands.clone(),
            mesh: stored.mesh().ok(),
            stress: stored.stress_near(instant_of_peak(&stored.outcome)).ok().flatten(),
            ..Attachments::default()
        }
    }
}

/// When the outer contact force is largest, s.
fn instant_of_peak(outcome: &Outcome) -> f64 {
    let history = &outcome.history;
    let forces = history.time.iter().zip(&history.outer_force);
    forces.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0.0, |(time, _)| *time)
}
