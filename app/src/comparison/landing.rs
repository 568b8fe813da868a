//! Where the sphere lands after the reference's launch, beside the models'.
//!
//! A reference knows no flight. Its launch flies in the same chamber with the same restitution; what differs is the launch alone.

use super::discrepancy::{Discrepancy, Scales};
use crate::kinds::flight::{flight_summary, launch};
use crate::result::{FlightSummary, Outcome, Summary};
use crate::scene::{LANDING_SHARE, Scene, Tolerances};

/// The flight of the reference's launch; `None` if the scene asks for none, or no model has flown.
pub(super) fn of_reference(scene: &Scene, reference: &Summary, reduced: &[Outcome]) -> Option<FlightSummary> {
    let flown = reduced.iter().find_map(|outcome| outcome.summary.flight.as_ref())?;
    // in this chamber with this restitution a model has flown, so that nothing is left to fail
    flight_summary(scene, launch(scene, reference)?, flown.restitution).ok()
}

/// The row of the share of launches that end in the other seat, if both sides have flown.
pub(super) fn row(sides: [Option<&FlightSummary>; 2], tolerances: &Tolerances) -> Option<Discrepancy> {
    let [reference, reduced] = sides.map(|flight| flight.map(|flight| flight.share));
    let scale = reference?;
    reduced?;
    Some(Discrepancy::new(
        (LANDING_SHARE, "1"),
        (reduced, reference),
        Scales { value: scale, peak: scale },
        tolerances.get(LANDING_SHARE),
        None,
    ))
}
