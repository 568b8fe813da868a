//! The curve metrics of one quantity, as they stand in the JSON document. Reported, never gated:
//! the thresholds of crash tests are far too loose between two computations.

use super::alignment::AlignedCurve;
use super::{Grade, iso18571, russell, sprague_geers};
use serde::Serialize;

/// Metrics of one curve; `None` where a measure is not defined (a curve that vanishes).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CurveMetrics {
    /// Name of the curve.
    pub quantity: String,
    /// Sprague and Geers' comprehensive error C.
    pub sprague_geers: Option<f64>,
    /// Its magnitude error M.
    pub sprague_geers_magnitude: Option<f64>,
    /// Its phase error P.
    pub sprague_geers_phase: Option<f64>,
    /// Russell's comprehensive error C.
    pub russell: Option<f64>,
    /// Its magnitude error M.
    pub russell_magnitude: Option<f64>,
    /// Its phase error P.
    pub russell_phase: Option<f64>,
    /// Overall rating R of ISO/TS 18571, 1 = best.
    pub iso18571: Option<f64>,
    /// Corridor score Z.
    pub iso18571_corridor: Option<f64>,
    /// Phase score EP.
    pub iso18571_phase: Option<f64>,
    /// Magnitude score EM.
    pub iso18571_magnitude: Option<f64>,
    /// Slope score ES.
    pub iso18571_slope: Option<f64>,
    /// Grade of the overall rating.
    pub grade: Option<Grade>,
    /// First and last instant compared, s.
    pub window: [f64; 2],
    /// Number of instants, equally spaced in the window, both ends included.
    pub samples: usize,
}

impl CurveMetrics {
    /// Metrics of an aligned curve.
    pub fn of(curve: &AlignedCurve) -> Self {
        let sg = sprague_geers(&curve.reference, &curve.reduced);
        let ru = russell(&curve.reference, &curve.reduced);
        let iso = iso18571(&curve.reference, &curve.reduced);
        CurveMetrics {
            quantity: curve.quantity.to_owned(),
            sprague_geers: sg.map(|m| m.comprehensive),
            sprague_geers_magnitude: sg.map(|m| m.magnitude),
            sprague_geers_phase: sg.map(|m| m.phase),
            russell: ru.map(|m| m.comprehensive),
            russell_magnitude: ru.map(|m| m.magnitude),
            russell_phase: ru.map(|m| m.phase),
            iso18571: iso.map(|m| m.overall),
            iso18571_corridor: iso.map(|m| m.corridor),
            iso18571_phase: iso.map(|m| m.phase),
            iso18571_magnitude: iso.map(|m| m.magnitude),
            iso18571_slope: iso.map(|m| m.slope),
            grade: iso.map(|m| m.grade()),
            window: [curve.axis.start, curve.axis.end],
            samples: curve.axis.samples,
        }
    }
}
