//! What a comparison of some kinds of scene has besides discrepancies.

pub(super) mod general_impact;
pub mod plate_impact;
