//! The random impacts, by the kind of scene they are of.

mod plate_impact;

pub use plate_impact::{DRY, MOVING, StressCase, StressImpact, UnitPlateModes, WET};
