//! The random impacts, by the kind of scene they are of.

mod plate_impact;

pub use plate_impact::{Case, DRY, Impact, MOVING, UnitPlates, WET};
